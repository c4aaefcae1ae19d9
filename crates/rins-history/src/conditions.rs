//! The conditions of a run: which unit, which power-on, when, and how warm.

/// The conditions of a run.
///
/// What is not known is `None`; a variation that depends on it is then no hypothesis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conditions {
    /// The unit, by a number that the caller chooses.
    pub unit: usize,
    /// The power-on, by a number that the caller chooses: runs without a power cycle in between have the same.
    pub power_on: usize,
    /// The date, since any epoch \[days\].
    pub date: Option<f64>,
    /// The time since power-on, at the middle of the run \[s\].
    pub since_power_on: Option<f64>,
    /// The mean temperature of the run \[°C\].
    pub temperature: Option<f64>,
    /// The direction in which the temperature was changing: 1 up, -1 down.
    pub warming: Option<f64>,
}

/// The conditions of several runs, of which the first `measured` have estimates.
#[derive(Clone, Debug)]
pub(crate) struct Conduct {
    pub(crate) all: Vec<Conditions>,
    pub(crate) measured: usize,
}

impl Conduct {
    /// The same with further runs that have no estimates.
    pub(crate) fn with(&self, further: &[Conditions]) -> Self {
        let all = self.all.iter().chain(further).copied().collect();
        Self { all, measured: self.measured }
    }

    /// A figure of every run, if all have it and it is not the same in all measured runs.
    pub(crate) fn varying(&self, of: impl Fn(&Conditions) -> Option<f64>) -> Option<Vec<f64>> {
        let all: Vec<f64> = self.all.iter().map(of).collect::<Option<_>>()?;
        let (low, high) = range(&all[..self.measured]);
        let size = low.abs().max(high.abs());
        (high - low > RESOLVED * size && high > low).then_some(all)
    }

    /// The instants by which the runs are in order: dates if all are known, and else the order of the list.
    pub(crate) fn instants(&self) -> Vec<f64> {
        let dates: Option<Vec<f64>> = self.all.iter().map(|one| one.date).collect();
        dates.unwrap_or_else(|| (0..self.all.len()).map(|place| place as f64).collect())
    }

    /// The range of the instants of the measured runs.
    pub(crate) fn span(&self) -> f64 {
        let (low, high) = range(&self.instants()[..self.measured]);
        high - low
    }

    /// The runs of each unit in order: the unit, and its runs.
    pub(crate) fn by_unit(&self) -> Vec<(usize, Vec<usize>)> {
        let instants = self.instants();
        let mut units: Vec<(usize, Vec<usize>)> = Vec::new();
        for (run, conditions) in self.all.iter().enumerate() {
            match units.iter_mut().find(|(unit, _)| *unit == conditions.unit) {
                Some((_, runs)) => runs.push(run),
                None => units.push((conditions.unit, vec![run])),
            }
        }
        for (_, runs) in &mut units {
            runs.sort_by(|&a, &b| instants[a].total_cmp(&instants[b]));
        }
        units
    }

    /// A group of each run, numbered from zero, by what is the same within a group.
    pub(crate) fn groups<K: PartialEq>(&self, of: impl Fn(usize, &Conditions) -> K) -> Vec<usize> {
        let mut keys: Vec<K> = Vec::new();
        let place = |(run, conditions): (usize, &Conditions)| {
            let key = of(run, conditions);
            keys.iter().position(|other| *other == key).unwrap_or_else(|| {
                keys.push(key);
                keys.len() - 1
            })
        };
        self.all.iter().enumerate().map(place).collect()
    }
}

/// Figures that differ by less than this part of their size are the same: the rounding of a sum.
const RESOLVED: f64 = 1e-9;

/// The least and the largest; zeros of none.
pub(crate) fn range(all: &[f64]) -> (f64, f64) {
    let widened = |(low, high): (f64, f64), &x: &f64| (low.min(x), high.max(x));
    let (low, high) = all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), widened);
    if low <= high { (low, high) } else { (0.0, 0.0) }
}
