//! The ways in which a parameter varies between runs, and what each is worth in every run.

use nalgebra::DMatrix;

use crate::conditions::{Conditions, Conduct, range};

/// A way in which a parameter varies between runs (IEEE Std 528: repeatability, drift, sensitivity).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Variation {
    /// It is linear in the date: long-term drift.
    Drift,
    /// It is linear in the time since power-on.
    DriftSincePowerOn,
    /// It approaches its final value exponentially after power-on.
    WarmUp {
        /// The time constant \[s\].
        time_constant: f64,
    },
    /// It is a polynomial of the temperature.
    Temperature {
        /// The degree, 1 to 3.
        degree: usize,
    },
    /// It differs between rising and falling temperature.
    Hysteresis,
    /// Each power-on has its own value: turn-on repeatability.
    TurnOn,
    /// Each run has its own value, whatever the power-on: more scatter than the estimates' uncertainty.
    Scatter,
    /// It is a random walk over the date, or over the order of the runs.
    Walk,
    /// It changes between two runs, and stays so: a shock, a repair.
    Change {
        /// The unit that changed.
        unit: usize,
        /// The instant of the change, in the middle between two runs: a date \[days\], or the order of runs without dates.
        instant: f64,
    },
    /// One unit differs from the other units.
    Unit {
        /// The unit.
        unit: usize,
    },
    /// One run differs from all others.
    Run {
        /// The run.
        run: usize,
    },
}

/// A kind of variation: all that differ in a setting only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// [`Variation::Drift`].
    Drift,
    /// [`Variation::DriftSincePowerOn`].
    DriftSincePowerOn,
    /// [`Variation::WarmUp`].
    WarmUp,
    /// [`Variation::Temperature`] of degree 1.
    Linear,
    /// [`Variation::Temperature`] of degree 2.
    Quadratic,
    /// [`Variation::Temperature`] of degree 3.
    Cubic,
    /// [`Variation::Hysteresis`].
    Hysteresis,
    /// [`Variation::TurnOn`].
    TurnOn,
    /// [`Variation::Scatter`].
    Scatter,
    /// [`Variation::Walk`].
    Walk,
    /// [`Variation::Change`].
    Change,
    /// [`Variation::Unit`].
    Unit,
    /// [`Variation::Run`].
    Run,
}

impl Kind {
    /// The logarithm of its prior odds relative to the standard variations (drift, warm-up, linear temperature coefficient, turn-on
    /// repeatability: the error models of IEEE Std 952 and 1431). What needs an accident or a further coefficient is less probable by a
    /// factor of e for each, and what names no cause by a factor of e³, so that a cause is preferred to a description.
    pub const fn ln_odds(self) -> f64 {
        match self {
            Self::Drift | Self::DriftSincePowerOn | Self::WarmUp | Self::Linear | Self::TurnOn => {
                0.0
            }
            Self::Quadratic | Self::Hysteresis | Self::Walk | Self::Change | Self::Unit => -1.0,
            Self::Cubic => -2.0,
            Self::Scatter | Self::Run => -3.0,
        }
    }

    /// Whether several of one kind may be there at once: their settings tell them apart.
    pub(crate) const fn is_repeatable(self) -> bool {
        matches!(self, Self::Change | Self::Unit | Self::Run)
    }

    /// Its name in words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Drift => "linear drift over the date",
            Self::DriftSincePowerOn => "linear drift with the time since power-on",
            Self::WarmUp => "exponential warm-up after power-on",
            Self::Linear => "linear temperature dependence",
            Self::Quadratic => "quadratic temperature dependence",
            Self::Cubic => "cubic temperature dependence",
            Self::Hysteresis => "thermal hysteresis (rising against falling temperature)",
            Self::TurnOn => "turn-on repeatability (a value of its own after each power-on)",
            Self::Scatter => "run-to-run scatter beyond the uncertainty of the estimates",
            Self::Walk => "random walk between runs",
            Self::Change => "change at a date",
            Self::Unit => "one unit differs from the others",
            Self::Run => "one run differs from the others",
        }
    }

    /// Its id in results.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Drift => "drift",
            Self::DriftSincePowerOn => "drift_since_power_on",
            Self::WarmUp => "warm_up",
            Self::Linear => "temperature_linear",
            Self::Quadratic => "temperature_quadratic",
            Self::Cubic => "temperature_cubic",
            Self::Hysteresis => "thermal_hysteresis",
            Self::TurnOn => "turn_on",
            Self::Scatter => "scatter",
            Self::Walk => "random_walk",
            Self::Change => "change",
            Self::Unit => "unit",
            Self::Run => "run",
        }
    }
}

/// The ratio of neighboring time constants of the warm-ups that are tried: an exponential hardly differs from one of a time constant
/// that is larger by half.
const RATIO: f64 = 1.5;

/// The highest degree of a polynomial of temperature.
const MOST_DEGREE: usize = 3;

impl Variation {
    /// Its kind.
    pub const fn kind(self) -> Kind {
        match self {
            Self::Drift => Kind::Drift,
            Self::DriftSincePowerOn => Kind::DriftSincePowerOn,
            Self::WarmUp { .. } => Kind::WarmUp,
            Self::Temperature { degree: 1 } => Kind::Linear,
            Self::Temperature { degree: 2 } => Kind::Quadratic,
            Self::Temperature { .. } => Kind::Cubic,
            Self::Hysteresis => Kind::Hysteresis,
            Self::TurnOn => Kind::TurnOn,
            Self::Scatter => Kind::Scatter,
            Self::Walk => Kind::Walk,
            Self::Change { .. } => Kind::Change,
            Self::Unit { .. } => Kind::Unit,
            Self::Run { .. } => Kind::Run,
        }
    }

    /// Whether its amplitudes are random, one for each group of runs.
    pub const fn is_random(self) -> bool {
        matches!(self, Self::TurnOn | Self::Scatter | Self::Walk)
    }

    /// All variations that the conditions of these runs can show.
    pub(crate) fn all(conduct: &Conduct) -> Vec<Self> {
        let mut all = vec![Self::Drift, Self::DriftSincePowerOn];
        all.extend(time_constants(conduct).map(|time_constant| Self::WarmUp { time_constant }));
        all.extend((1..=MOST_DEGREE).map(|degree| Self::Temperature { degree }));
        all.extend([Self::Hysteresis, Self::TurnOn, Self::Scatter, Self::Walk]);
        let instants = conduct.instants();
        for (unit, runs) in conduct.by_unit() {
            let measured: Vec<usize> =
                runs.into_iter().filter(|run| *run < conduct.measured).collect();
            let between = measured.windows(2).map(|pair| [instants[pair[0]], instants[pair[1]]]);
            let apart = between.filter(|[before, after]| after > before);
            all.extend(
                apart.map(|[before, after]| Self::Change { unit, instant: 0.5 * (before + after) }),
            );
            all.push(Self::Unit { unit });
        }
        all.extend((0..conduct.measured).map(|run| Self::Run { run }));
        all.retain(|one| one.columns(conduct).is_some());
        all
    }

    /// What one of each of its amplitudes adds to the parameter in every run, a column for each amplitude; `None` if the measured runs
    /// cannot show it.
    ///
    /// The amplitude of what is not random is the change over all measured runs; that of a warm-up is its value at power-on.
    pub(crate) fn columns(self, conduct: &Conduct) -> Option<DMatrix<f64>> {
        let of = |figures: Vec<f64>| Some(regressor(&figures, conduct.measured));
        match self {
            Self::Drift => of(conduct.varying(|one| one.date)?),
            Self::DriftSincePowerOn => of(conduct.varying(|one| one.since_power_on)?),
            Self::WarmUp { time_constant } => {
                let since = conduct.varying(|one| one.since_power_on)?;
                // Not in units of the change over the runs: of what had died away before the first run, nothing is known.
                Some(DMatrix::from_fn(since.len(), 1, |run, _| (-since[run] / time_constant).exp()))
            }
            Self::Temperature { degree } => polynomial(conduct, degree),
            Self::Hysteresis => of(conduct.varying(|one| one.warming)?),
            Self::TurnOn => indicators(conduct, &conduct.groups(|_, one| (one.unit, one.power_on))),
            Self::Scatter => {
                let power_ons = conduct.groups(|_, one| (one.unit, one.power_on));
                let shared = number(&power_ons[..conduct.measured]) < conduct.measured;
                let runs: Vec<usize> = (0..conduct.all.len()).collect();
                shared.then(|| indicators(conduct, &runs)).flatten()
            }
            Self::Walk => walk(conduct),
            Self::Change { unit, instant } => {
                let instants = conduct.instants();
                indicator(conduct, |run, one| one.unit == unit && instants[run] > instant)
            }
            Self::Unit { unit } => indicator(conduct, |_, one| one.unit == unit),
            Self::Run { run } => indicator(conduct, |other, _| other == run),
        }
    }
}

/// How each unit differs from the mean of all, a column for each unit; `None` if there is only one.
pub(crate) fn of_units(conduct: &Conduct) -> Option<DMatrix<f64>> {
    indicators(conduct, &conduct.groups(|_, one| one.unit))
}

/// The time constants that are tried: from the shortest interval between runs to the whole range of times since power-on.
fn time_constants(conduct: &Conduct) -> impl Iterator<Item = f64> {
    let mut times = conduct.varying(|one| one.since_power_on).unwrap_or_default();
    times.truncate(conduct.measured);
    times.sort_by(f64::total_cmp);
    let apart = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|apart| *apart > 0.0);
    let (low, high) = range(&times);
    let shortest = apart.fold(high - low, f64::min).max((high - low) / SHORTEST);
    let next = move |at: &f64| Some(at * RATIO).filter(|next| *next < high - low);
    std::iter::successors((high > low).then_some(shortest), next)
}

/// A time constant of less than this part of all times is that of the first run alone.
const SHORTEST: f64 = 1e3;

/// Figures as a column whose range over the measured runs is one.
fn regressor(figures: &[f64], measured: usize) -> DMatrix<f64> {
    let (low, high) = range(&figures[..measured]);
    let of = |run: usize, _| (figures[run] - 0.5 * (low + high)) / (high - low);
    DMatrix::from_fn(figures.len(), 1, of)
}

/// Legendre polynomials of the temperature up to a degree, without the constant.
fn polynomial(conduct: &Conduct, degree: usize) -> Option<DMatrix<f64>> {
    let temperatures = conduct.varying(|one| one.temperature)?;
    let mut sorted = temperatures[..conduct.measured].to_vec();
    let (low, high) = range(&sorted);
    sorted.sort_by(f64::total_cmp);
    // Temperatures that differ by less than a part of what a polynomial bends over are one.
    let mut distinct: Vec<f64> = Vec::new();
    for temperature in sorted {
        if distinct.last().is_none_or(|last| temperature - last > DISTINCT * (high - low)) {
            distinct.push(temperature);
        }
    }
    let of = |run: usize, column: usize| {
        let x = (2.0 * temperatures[run] - low - high) / (high - low);
        match column {
            0 => 0.5 * x,
            1 => x * x - 1.0 / 3.0,
            _ => 0.5 * (2.5 * x * x * x - 1.5 * x),
        }
    };
    (distinct.len() > degree).then(|| DMatrix::from_fn(conduct.all.len(), degree, of))
}

/// Temperatures closer than this part of the whole range are one.
const DISTINCT: f64 = 0.1;

/// One in some runs and zero in the others; `None` if that does not tell measured runs apart.
fn indicator(
    conduct: &Conduct,
    holds: impl Fn(usize, &Conditions) -> bool,
) -> Option<DMatrix<f64>> {
    let of: Vec<bool> = conduct.all.iter().enumerate().map(|(run, one)| holds(run, one)).collect();
    let measured = of[..conduct.measured].iter().filter(|holds| **holds).count();
    let differs = measured > 0 && measured < conduct.measured;
    differs.then(|| DMatrix::from_fn(of.len(), 1, |run, _| f64::from(u8::from(of[run]))))
}

/// A column for each group of runs; `None` if all measured runs are in one.
fn indicators(conduct: &Conduct, groups: &[usize]) -> Option<DMatrix<f64>> {
    let of = |run: usize, group: usize| f64::from(u8::from(groups[run] == group));
    let several = number(&groups[..conduct.measured]) > 1;
    several.then(|| DMatrix::from_fn(groups.len(), number(groups), of))
}

/// How many groups there are.
fn number(groups: &[usize]) -> usize {
    let mut all = groups.to_vec();
    all.sort_unstable();
    all.dedup();
    all.len()
}

/// A column for each interval between a unit's runs: the steps of a random walk that spreads by one over all measured runs.
fn walk(conduct: &Conduct) -> Option<DMatrix<f64>> {
    let (instants, span) = (conduct.instants(), conduct.span());
    if span <= 0.0 {
        return None;
    }
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for (_, runs) in conduct.by_unit() {
        for place in 1..runs.len() {
            let interval = instants[runs[place]] - instants[runs[place - 1]];
            if interval > 0.0 {
                let mut column = vec![0.0; conduct.all.len()];
                runs[place..].iter().for_each(|&run| column[run] = (interval / span).sqrt());
                columns.push(column);
            }
        }
    }
    let of = |run: usize, column: usize| columns[column][run];
    (!columns.is_empty()).then(|| DMatrix::from_fn(conduct.all.len(), columns.len(), of))
}
