//! Where the parameters of several runs stand among all.

use rins_terms::{Free, Owner};

use crate::run::Run;

/// All parameters of some runs of one IMU: those of the sensors are shared, and by runs that were not switched off in
/// between the turn-on biases too; the others are each run's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Which parameter of the model each one is, and of which run, the first of those that share it; of none if all share
    /// it, or there is one run only.
    pub all: Vec<(usize, Option<usize>)>,
    /// For each run the place among all of each parameter of the model.
    pub places: Vec<Vec<usize>>,
}

impl Layout {
    /// Of these runs. One run has its parameters in the model's order; of several, those of the sensors come first.
    pub fn of(free: &[Free], runs: &[Run]) -> Self {
        if runs.len() == 1 {
            let all = (0..free.len()).map(|index| (index, None)).collect();
            return Self { all, places: vec![(0..free.len()).collect()] };
        }
        let never_off = runs.iter().all(|run| run.shares_turn_on(&runs[0]));
        let mut all = Vec::new();
        let mut places = vec![vec![0; free.len()]; runs.len()];
        for (index, _) in free.iter().enumerate().filter(|(_, p)| p.owner == Owner::Sensor) {
            for of_run in &mut places {
                of_run[index] = all.len();
            }
            all.push((index, None));
        }
        for (place, run) in runs.iter().enumerate() {
            let before = runs[..place].iter().position(|other| other.shares_turn_on(run));
            for (index, parameter) in free.iter().enumerate() {
                places[place][index] = match (parameter.owner, before) {
                    (Owner::Sensor, _) => continue,
                    (Owner::Run, Some(before)) => places[before][index],
                    (owner, _) => {
                        let shared = owner == Owner::Run && never_off;
                        all.push((index, (!shared).then_some(place)));
                        all.len() - 1
                    }
                };
            }
        }
        Self { all, places }
    }
}
