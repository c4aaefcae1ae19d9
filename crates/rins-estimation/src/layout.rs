//! The places of the parameters of several runs in the joint parameter vector.

use rins_frames::SignedAxes;
use rins_imu::ImuSpec;
use rins_terms::{FreeParameter, Model, Owner, TermInstance, catalogue};

use crate::fit_error::FitError;
use crate::run::Run;

/// The largest number of parameters of a model: the time increases with their square and cube, and this number takes about
/// ten seconds.
pub(crate) const MOST_PARAMETERS: usize = 256;

/// The joint parameter vector of several runs of one IMU. Parameters of the sensors are shared; turn-on biases are shared
/// by runs without a power cycle in between, other parameters of a run only if the IMU was not remounted either; the
/// attitude of the axis belongs to single runs.
///
/// Runs with different spin axes in the IMU share the parameters that are the same along the sensors' own axes. All ids are
/// along the axes of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Each parameter as in the first run that has it, and the run that it belongs to: the first of those that share it, or
    /// `None` if all runs share it or there is only one run.
    pub all: Vec<(FreeParameter, Option<usize>)>,
    /// For each run, the place in `all` of each parameter of its model.
    pub places: Vec<Vec<usize>>,
    /// For each run, the factor that converts each of its parameters to the one in `all`: 1 or -1.
    pub signs: Vec<Vec<f64>>,
}

impl Layout {
    /// The layout of these runs, each of which has the parameters `free`. The parameters of one run are in the model's
    /// order; for several runs, those of the sensors come first.
    ///
    /// # Panics
    /// If the runs have different axes.
    pub fn of(free: &[FreeParameter], runs: &[Run]) -> Self {
        assert!(runs.iter().all(|run| run.axes == runs[0].axes), "runs about one axis");
        let signed = free.iter().map(|parameter| (parameter.clone(), 1.0)).collect();
        Self::joined(&vec![signed; runs.len()], runs)
    }

    /// The layout of these runs. The parameters of each run are given with their ids along the model's axes and with
    /// the factor that converts each value to these axes.
    fn joined(free: &[Vec<(FreeParameter, f64)>], runs: &[Run]) -> Self {
        let signs =
            free.iter().map(|of_run| of_run.iter().map(|(_, sign)| *sign).collect()).collect();
        if let [only] = free {
            let all = only.iter().map(|(parameter, _)| (parameter.clone(), None)).collect();
            return Self { all, places: vec![(0..only.len()).collect()], signs };
        }
        let shares = |owner: Owner, run: &Run, other: &Run| match owner {
            Owner::PowerOn => run.shares_power(other),
            Owner::Run => run.shares_turn_on(other),
            Owner::Sensor | Owner::Placement => false,
        };
        let mut all: Vec<(FreeParameter, Option<usize>)> = Vec::new();
        let mut places: Vec<Vec<usize>> = free.iter().map(|of_run| vec![0; of_run.len()]).collect();
        let of_sensors = |parameter: &FreeParameter| parameter.owner == Owner::Sensor;
        for (of_run, places) in free.iter().zip(&mut places) {
            let here =
                of_run.iter().zip(places).filter(|((parameter, _), _)| of_sensors(parameter));
            for ((parameter, _), place) in here {
                let known = all.iter().position(|(other, _)| other.id == parameter.id);
                *place = known.unwrap_or(all.len());
                if known.is_none() {
                    all.push((parameter.clone(), None));
                }
            }
        }
        for (number, run) in runs.iter().enumerate() {
            for (index, (parameter, _)) in free[number].iter().enumerate() {
                if of_sensors(parameter) {
                    continue;
                }
                let owner = parameter.owner;
                let known = (0..number).find_map(|before| {
                    let same = |(other, _): &(FreeParameter, f64)| other.id == parameter.id;
                    let at = free[before].iter().position(same)?;
                    shares(owner, run, &runs[before]).then_some(places[before][at])
                });
                places[number][index] = known.unwrap_or_else(|| {
                    let by_all = runs.iter().all(|other| shares(owner, other, &runs[0]));
                    all.push((parameter.clone(), (!by_all).then_some(number)));
                    all.len() - 1
                });
            }
        }
        Self { all, places, signs }
    }
}

/// Runs, a model for each, and the layout of their parameters.
pub(crate) struct Joined {
    /// The model of each run, along its own axes.
    pub(crate) models: Vec<Model>,
    /// For each run, the free parameters of its model: term and place within the term.
    pub(crate) free: Vec<Vec<(usize, usize)>>,
    /// Their places in the joint parameter vector.
    pub(crate) layout: Layout,
}

impl Joined {
    /// Joins these runs of one IMU; the model is along these axes, relative to the sensors' own.
    pub(crate) fn of(model: &Model, along: &SignedAxes, imu: &ImuSpec, runs: &[Run]) -> Self {
        let axes = |run: &Run| run.axes.after(&along.inverse());
        let models: Vec<Model> = runs.iter().map(|run| model.carried(&axes(run))).collect();
        let signed = |(run, model): (&Run, &Model)| model.free_along(&axes(run), imu);
        let free: Vec<Vec<(FreeParameter, f64)>> = runs.iter().zip(&models).map(signed).collect();
        let layout = Layout::joined(&free, runs);
        let place = |(parameter, _): &(FreeParameter, f64)| (parameter.term, parameter.parameter);
        let free = free.iter().map(|of_run| of_run.iter().map(place).collect()).collect();
        Self { models, free, layout }
    }
    /// Refuses a model without free parameters, or with more than can be estimated in reasonable time.
    pub(crate) fn refuse_number(&self) -> Result<(), FitError> {
        let parameters = self.free.iter().map(Vec::len).max().unwrap_or_default();
        match parameters {
            0 => Err(FitError::NothingFree),
            1..=MOST_PARAMETERS => Ok(()),
            _ => Err(FitError::ManyParameters { parameters, most: MOST_PARAMETERS }),
        }
    }
}

/// The places of the three attitude angles of a run's spin axis in the joint parameter vector, if all three are free.
pub(crate) fn attitude_of(
    model: &Model,
    free: &[(usize, usize)],
    places: &[usize],
) -> Option<[usize; 3]> {
    let is_attitude = |chosen: &TermInstance| chosen.term.is(&catalogue::AXIS_ATTITUDE);
    let term = model.terms.iter().position(is_attitude)?;
    let [x, y, z] = [0, 1, 2].map(|angle| free.iter().position(|at| *at == (term, angle)));
    Some([places[x?], places[y?], places[z?]])
}
