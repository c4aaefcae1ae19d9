//! Where the parameters of several runs stand among all.

use rins_terms::{Free, Owner};

/// All parameters of some runs of one IMU: those of the sensors are shared, the others each run's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Which parameter of the model each one is, and of which run; of none if it is shared, or there is one run only.
    pub all: Vec<(usize, Option<usize>)>,
    /// For each run the place among all of each parameter of the model.
    pub places: Vec<Vec<usize>>,
}

impl Layout {
    /// Of so many runs. One run has its parameters in the model's order; of several, those that are shared come first.
    pub fn of(free: &[Free], n_runs: usize) -> Self {
        if n_runs == 1 {
            let all = (0..free.len()).map(|index| (index, None)).collect();
            return Self { all, places: vec![(0..free.len()).collect()] };
        }
        let mut all = Vec::new();
        let mut places = vec![vec![0; free.len()]; n_runs];
        for (index, _) in free.iter().enumerate().filter(|(_, p)| p.owner == Owner::Sensor) {
            for of_run in &mut places {
                of_run[index] = all.len();
            }
            all.push((index, None));
        }
        for (run, of_run) in places.iter_mut().enumerate() {
            for (index, _) in free.iter().enumerate().filter(|(_, p)| p.owner == Owner::Run) {
                of_run[index] = all.len();
                all.push((index, Some(run)));
            }
        }
        Self { all, places }
    }
}
