//! What a schedule is to be optimized for.

use nalgebra::DVector;
use rins_design::{Effect, LinearFunction, Objective, Pair, Service, information};
use rins_estimation::Unknown;
use rins_frames::SignedAxes;
use rins_imu::ImuSpec;
use rins_io::MissionFile;
use rins_io::quantity::kinds;
use rins_motion::{Segment, Station};
use rins_terms::{FreeParameter, Model, Owner, Surroundings};

use crate::observe::chosen;
use crate::observe::schedule::Schedule;

/// What a schedule is to be optimized for.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignGoal {
    /// The standard deviation of one parameter, by its id: c-optimal.
    Parameter(String),
    /// The radial position error after this time in service \[s\].
    Position(f64),
    /// The determinant of the covariance of these parameters, or of all of the IMU if none is named: D-optimal.
    Determinant(Vec<String>),
    /// The mean square of the standard deviations of these parameters relative to their priors, or of all of the IMU: A-optimal.
    MeanSquare(Vec<String>),
    /// The smallest separation of two effects.
    Separation([String; 2]),
}

impl DesignGoal {
    /// The goal as it is typed: the id of a parameter, `position@24h`, `D`, `A`, either with `:ID,ID`, or two effects `A/B`.
    ///
    /// # Errors
    /// A sentence if it is none of these.
    ///
    /// ```
    /// use rins::design::DesignGoal;
    /// assert_eq!(DesignGoal::parse("position@24h"), Ok(DesignGoal::Position(86400.0)));
    /// assert_eq!(DesignGoal::parse("D"), Ok(DesignGoal::Determinant(vec![])));
    /// assert!(DesignGoal::parse("position@24deg").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if let Some(after) = text.strip_prefix("position@") {
            let time = kinds::DURATION.parse(after).map_err(|error| error.to_string())?;
            return Ok(Self::Position(time));
        }
        let (head, ids) =
            text.split_once(':').map_or((text, None), |(head, ids)| (head, Some(ids)));
        if matches!(head, "D" | "A") {
            let ids: Vec<String> = match ids {
                None => Vec::new(),
                Some(ids) => ids.split(',').map(|id| id.trim().to_owned()).collect(),
            };
            if ids.iter().any(String::is_empty) {
                return Err(
                    "expected ids after the colon, such as D:gyro.scale.x,gyro.scale.y".into()
                );
            }
            return Ok(if head == "D" { Self::Determinant(ids) } else { Self::MeanSquare(ids) });
        }
        if let Some((first, second)) = text.split_once('/') {
            if first.is_empty() || second.is_empty() {
                return Err(
                    "expected two ids, such as gyro_g_sensitivity/encoder_eccentricity".into()
                );
            }
            return Ok(Self::Separation([first.into(), second.into()]));
        }
        if text.is_empty() {
            return Err(
                "expected the id of a parameter, position@24h, D, A, or two effects A/B".into()
            );
        }
        Ok(Self::Parameter(text.into()))
    }
}

/// A system in service after the calibration: its site, the attitude of its axis, and the cycle of its table.
#[derive(Clone, Debug)]
pub(super) struct InService {
    pub(super) words: String,
    pub(super) station: Station,
    pub(super) nav_from_table: rins_frames::Dcm<rins_frames::Nav, rins_frames::Table>,
    /// The axes of the run, whose z is the spin axis, relative to the sensors' own.
    pub(super) axes: SignedAxes,
    pub(super) cycle: Vec<Segment>,
}

impl InService {
    /// The first scheme of a mission file.
    pub(super) fn of(file: &MissionFile) -> Self {
        let scheme = &file.schemes[0];
        Self {
            words: format!("{} of {}", scheme.name, rins_io::shown(&file.path)),
            station: file.station,
            nav_from_table: file.nav_from_table,
            axes: SignedAxes::IDENTITY,
            cycle: scheme.cycle.clone(),
        }
    }

    /// The position error east and north \[m\] after a time \[s\] as linear functions of the sensor errors, of a system that has aligned itself.
    fn position(
        &self,
        model: &Model,
        imu: &ImuSpec,
        time: f64,
    ) -> anyhow::Result<Vec<LinearFunction>> {
        let model = model.carried(&self.axes);
        let mut free = model.free_along(&self.axes, imu);
        free.retain(|(free, _)| free.owner != Owner::Placement);
        let places: Vec<(usize, usize)> =
            free.iter().map(|(free, _)| (free.term, free.parameter)).collect();
        let service = Service {
            surroundings: Surroundings::new(self.station, self.nav_from_table),
            cycle: &self.cycle,
            model: &model,
            parameters: &places,
            noise: [0.0; 2],
        };
        let position = service.position_after_alignment(time)?;
        let row = |row: usize| -> LinearFunction {
            let of = |(column, (free, sign)): (usize, &(FreeParameter, f64))| {
                (free.id.clone(), sign * position[(row, column)])
            };
            free.iter().enumerate().map(of).collect()
        };
        Ok(vec![row(0), row(1)])
    }
}

/// The model with what the goal asks for, and the effects of the goal.
pub(super) fn model_for(goal: &DesignGoal, name: &str) -> anyhow::Result<(Model, Vec<Effect>)> {
    let mut model = chosen::model(name)?;
    let effects: Vec<Effect> = match goal {
        DesignGoal::Parameter(id) => {
            let effect = chosen::effect(id)?;
            anyhow::ensure!(
                effect.ids.len() == 1,
                "{} has several parameters, of which one is meant: {}; or D:{}",
                effect.term.id,
                effect.ids.join(", "),
                effect.ids.join(",")
            );
            vec![effect]
        }
        DesignGoal::Separation(pair) => {
            let pair = [chosen::effect(&pair[0])?, chosen::effect(&pair[1])?];
            if let Some(shared) = pair[0].ids.iter().find(|id| pair[1].ids.contains(id)) {
                anyhow::bail!(
                    "{} and {} cannot be separated: both hold {shared}",
                    pair[0].name,
                    pair[1].name
                );
            }
            pair.into()
        }
        DesignGoal::Determinant(ids) | DesignGoal::MeanSquare(ids) => {
            ids.iter().map(|id| chosen::effect(id)).collect::<anyhow::Result<_>>()?
        }
        DesignGoal::Position(_) => Vec::new(),
    };
    for effect in &effects {
        anyhow::ensure!(
            effect.term.owner != Owner::Placement,
            "{} belongs to one orientation of the axis, not to the IMU: a schedule of several orientations cannot be optimized for it",
            effect.name
        );
        model = chosen::with(model, effect);
    }
    Ok((model, effects))
}

/// The objective of a goal, for this model and the given schedule.
pub(super) fn objective<'e>(
    goal: &DesignGoal,
    (model, effects): (&Model, &'e [Effect]),
    schedule: &Schedule,
    service: &InService,
) -> anyhow::Result<Objective<'e>> {
    let free = model.free(&schedule.runs[0].imu);
    let of_imu: Vec<&FreeParameter> =
        free.iter().filter(|free| free.owner != Owner::Placement).collect();
    let ids = || -> Vec<String> {
        if effects.is_empty() {
            of_imu.iter().map(|free| free.id.clone()).collect()
        } else {
            effects.iter().flat_map(|effect| effect.ids.clone()).collect()
        }
    };
    let find = |id: &String| of_imu.iter().find(|free| free.id == *id);
    Ok(match goal {
        DesignGoal::Parameter(_) => {
            let function = |id: &String| {
                let factor = find(id).map_or(1.0, |free| free.unit.factor);
                vec![(id.clone(), 1.0 / factor)]
            };
            Objective::Variance(ids().iter().map(function).collect())
        }
        DesignGoal::Position(time) => {
            Objective::Variance(service.position(model, &schedule.runs[0].imu, *time)?)
        }
        DesignGoal::Determinant(_) => Objective::Determinant(ids()),
        DesignGoal::MeanSquare(_) => {
            let ids = ids();
            let part = (1.0 / ids.len() as f64).sqrt();
            let function = |id: &String| {
                let sigma = find(id).map_or(1.0, |free| free.sigma);
                vec![(id.clone(), part / sigma)]
            };
            Objective::Variance(ids.iter().map(function).collect())
        }
        DesignGoal::Separation(_) => {
            let [first, second] = effects else { anyhow::bail!("two effects are separated") };
            let pair: [Effect; 2] = [first.clone(), second.clone()];
            let joint = information(&schedule.runs, model)?;
            let given = Pair::of(&joint, &pair);
            let along = [0, 1].map(|place: usize| {
                let directions = &given.separations[place].directions;
                if directions.is_empty() {
                    // What the given schedule does not show at all: each parameter by itself.
                    let count = pair[place].ids.len();
                    (0..count).map(|one| unit(count, one)).collect()
                } else {
                    directions.iter().map(|direction| direction.along.clone()).collect()
                }
            });
            let effects: &'e [Effect; 2] = effects.try_into()?;
            Objective::Separation { effects, along }
        }
    })
}

fn unit(count: usize, place: usize) -> DVector<f64> {
    DVector::from_fn(count, |row, _| f64::from(u8::from(row == place)))
}

/// The figure that a reader sees of a value, and its unit.
pub(super) fn figure_of(
    goal: &DesignGoal,
    unknowns: &[Unknown],
    value: f64,
) -> (f64, &'static str) {
    match goal {
        DesignGoal::Parameter(id) => {
            let unit = unknowns.iter().find(|unknown| unknown.id == *id).map(|one| one.unit.symbol);
            (value.sqrt(), unit.unwrap_or(""))
        }
        DesignGoal::Position(_) => (value.sqrt() / crate::mission::NAUTICAL_MILE, "nmi"),
        DesignGoal::Determinant(_) => ((0.5 * value).exp(), ""),
        DesignGoal::MeanSquare(_) => (value.sqrt(), ""),
        DesignGoal::Separation(_) => ((-0.5 * value).exp(), "sigma"),
    }
}

/// What the figure is.
pub(super) fn meaning(goal: &DesignGoal, service: &InService) -> String {
    let of = |ids: &[String]| {
        if ids.is_empty() { "all sensor parameters".into() } else { ids.join(", ") }
    };
    match goal {
        DesignGoal::Parameter(id) => format!("σ of {id}"),
        DesignGoal::Position(time) => {
            format!(
                "radial position error (1σ) after {} h in service ({})",
                time / 3600.0,
                service.words
            )
        }
        DesignGoal::Determinant(ids) => {
            format!("D-criterion of {}: geometric mean of σ relative to the prior", of(ids))
        }
        DesignGoal::MeanSquare(ids) => {
            format!("A-criterion of {}: root mean square of σ relative to the prior", of(ids))
        }
        DesignGoal::Separation([first, second]) => {
            format!("smallest separation of {first} and {second}")
        }
    }
}
