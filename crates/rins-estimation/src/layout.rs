//! Where the parameters of several runs stand among all.

use rins_imu::ImuSpec;
use rins_terms::{FreeParameter, Model, Owner, TermInstance, catalogue};

use crate::fit_error::FitError;
use crate::run::Run;

/// The most parameters of a model: time goes with their square and cube, and so many take some ten seconds.
const MOST_PARAMETERS: usize = 256;

/// All parameters of some runs of one IMU: those of the sensors are shared, and by runs that were not switched off in
/// between the turn-on biases too; the others are each run's own.
///
/// Runs about different axes of the IMU share what is the same along the sensors' own axes. All ids are along the axes of the
/// first run.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Each parameter, as the first run that has it has it, and of which run it is, the first of those that share it; of
    /// none if all share it, or there is one run only.
    pub all: Vec<(FreeParameter, Option<usize>)>,
    /// For each run the place among all of each parameter of its model.
    pub places: Vec<Vec<usize>>,
    /// For each run what each of its parameters is multiplied by to be that among all: 1 or -1.
    pub signs: Vec<Vec<f64>>,
}

impl Layout {
    /// Of these runs, each of which has the parameters `free`. One run has its parameters in the model's order; of several,
    /// those of the sensors come first.
    ///
    /// # Panics
    /// If the runs are about different axes.
    pub fn of(free: &[FreeParameter], runs: &[Run]) -> Self {
        assert!(runs.iter().all(|run| run.axes == runs[0].axes), "runs about one axis");
        let signed = free.iter().map(|parameter| (parameter.clone(), 1.0)).collect();
        Self::joined(&vec![signed; runs.len()], runs)
    }

    /// Of these runs, for each of which the parameters are given with their ids along the first run's axes, and what each is
    /// multiplied by to be along these.
    fn joined(free: &[Vec<(FreeParameter, f64)>], runs: &[Run]) -> Self {
        let signs =
            free.iter().map(|of_run| of_run.iter().map(|(_, sign)| *sign).collect()).collect();
        if let [only] = free {
            let all = only.iter().map(|(parameter, _)| (parameter.clone(), None)).collect();
            return Self { all, places: vec![(0..only.len()).collect()], signs };
        }
        let never_off = runs.iter().all(|run| run.shares_turn_on(&runs[0]));
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
            let before = runs[..number].iter().position(|other| other.shares_turn_on(run));
            for (index, (parameter, _)) in free[number].iter().enumerate() {
                places[number][index] = match (parameter.owner, before) {
                    (Owner::Sensor, _) => continue,
                    // Such runs are about one axis, and have the same parameters.
                    (Owner::Run, Some(before)) => places[before][index],
                    (owner, _) => {
                        let shared = owner == Owner::Run && never_off;
                        all.push((parameter.clone(), (!shared).then_some(number)));
                        all.len() - 1
                    }
                };
            }
        }
        Self { all, places, signs }
    }
}

/// Runs with a model for each, and where their parameters stand.
pub(crate) struct Joined {
    /// Each run's model, along its own axes.
    pub(crate) models: Vec<Model>,
    /// For each run, which of its model's parameters are free: their terms and their places there.
    pub(crate) free: Vec<Vec<(usize, usize)>>,
    /// Where they stand among all.
    pub(crate) layout: Layout,
}

impl Joined {
    /// Of these runs of one IMU, the model being along the axes of the first.
    pub(crate) fn of(model: &Model, imu: &ImuSpec, runs: &[Run]) -> Self {
        let models: Vec<Model> = runs
            .iter()
            .map(|run| model.carried(&run.axes.after(&runs[0].axes.inverse())))
            .collect();
        let signed = |(run, model): (&Run, &Model)| -> Vec<(FreeParameter, f64)> {
            let axes = run.axes.after(&runs[0].axes.inverse());
            let along_first = |free: FreeParameter| {
                let (_, sign) = model.terms[free.term].own(free.parameter, &axes);
                (FreeParameter { id: model.own_id(free.term, free.parameter, &axes), ..free }, sign)
            };
            model.free(imu).into_iter().map(along_first).collect()
        };
        let free: Vec<Vec<(FreeParameter, f64)>> = runs.iter().zip(&models).map(signed).collect();
        let layout = Layout::joined(&free, runs);
        let place = |(parameter, _): &(FreeParameter, f64)| (parameter.term, parameter.parameter);
        let free = free.iter().map(|of_run| of_run.iter().map(place).collect()).collect();
        Self { models, free, layout }
    }
    /// Refuses a model that estimates nothing, or more than can be done in reasonable time.
    pub(crate) fn refuse_number(&self) -> Result<(), FitError> {
        let parameters = self.free.iter().map(Vec::len).max().unwrap_or_default();
        match parameters {
            0 => Err(FitError::NothingFree),
            1..=MOST_PARAMETERS => Ok(()),
            _ => Err(FitError::ManyParameters { parameters, most: MOST_PARAMETERS }),
        }
    }
}

/// Where the attitude of a run's axis stands among all parameters, if all three of its angles are free.
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
