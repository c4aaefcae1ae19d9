//! A setting of a term: a number that selects the effect's shape, and how its value is estimated.

use std::f64::consts::LN_10;

use crate::unit::Unit;

/// A derivative by a setting is taken over this part of a time constant or an exponent, and over so many periods of the
/// lowest frequency that a run shows: far above the rounding of the likelihood, far below its curvature.
const DERIVATIVE_PART: f64 = 0.02;

/// The prior 1σ of a frequency about its estimate, in units of a run's resolution `1/duration`: a line that is further off is
/// another line.
const FREQUENCY_SIGMA: f64 = 0.5;

/// The prior 1σ of an event's time about its estimate, as a part of the run: an event that is further off is another event.
const TIME_SIGMA: f64 = 0.1;

/// The time constants of the search grid, as parts of the run: a factor of three apart, which a fit bridges.
const TIME_CONSTANTS: [f64; 4] = [0.02, 0.06, 0.18, 0.5];

/// The exponents of the rate in the search grid.
const EXPONENTS: [f64; 4] = [0.5, 1.0, 2.0, 3.0];

/// The harmonic orders of the search grid, signed where a term takes both signs. Order 1 is an effect of its own or a choice
/// of the frame.
const ORDERS: [f64; 20] = [
    -6.0, -5.0, -4.0, -3.0, -2.0, -1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0,
    16.0, 18.0, 24.0,
];

/// A number that selects a term's shape.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// What it is.
    pub kind: SettingKind,
    /// Its key in files, such as `order`. Programs tell settings by their kind.
    pub name: &'static str,
    /// What it means, in words.
    pub meaning: &'static str,
    /// Its unit in files and reports.
    pub unit: Unit,
    /// Its value where nothing is said, in SI units.
    pub default: f64,
    /// The least and the largest value that is allowed, in SI units.
    pub within: (f64, f64),
}

/// What a setting is: how its value is searched for, and how well it is known beforehand.
///
/// A term of the catalogue has at most one setting of a kind.
///
/// | kind | SI unit | search grid | prior range | prior 1σ | step of a derivative |
/// | --- | --- | --- | --- | --- | --- |
/// | time | s | 16 times, evenly over the run | the run | 0.1 run | an epoch |
/// | time constant | s | 0.02, 0.06, 0.18, 0.5 of the run | a decade | its value | 0.02 of its value |
/// | exponent | 1 | 0.5, 1, 2, 3 | its value | its value | 0.02 of its value |
/// | frequency | Hz | none: taken from a spectrum | its value | 0.5/run | 0.02/run |
/// | order | 1 | -6 to -1, 2 to 12, 16, 18, 24 | | | |
/// | any other | | none: it is given | | | |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SettingKind {
    /// The time of an event since the start of the run \[s\].
    Time,
    /// How long an event takes \[s\].
    Duration,
    /// The time constant of an exponential transient or of a low-pass \[s\].
    TimeConstant,
    /// The frequency of a sinusoidal disturbance in time \[Hz\].
    Frequency,
    /// The harmonic order in the table angle, per revolution; negative against the direction of rotation.
    Order,
    /// The exponent of the table's rate.
    Exponent,
    /// The axis of the sensors: 1, 2, 3 for x, y, z.
    Axis,
    /// The temperature at which the effect is zero \[°C\].
    ReferenceTemperature,
    /// The rate below which a gyro shows nothing \[rad/s\].
    RateThreshold,
    /// A number of consecutive samples.
    SampleCount,
    /// The triads that are concerned: 0 for both, 1 for the gyros, 2 for the accelerometers.
    Triads,
    /// The axes about which a gyro's rate is taken: 0 for its own, 1 for the body's.
    RateAxes,
}

/// How well the value of a setting is known before the runs are seen, in the setting's SI unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettingPrior {
    /// The width of the range in which it may lie: what its estimate is compared with.
    pub range: f64,
    /// The 1σ about an estimate within which it describes the same effect.
    pub sigma: f64,
}

/// A value of a search grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridPoint {
    /// The value, in the setting's SI unit.
    pub value: f64,
    /// The prior weight of the value, relative to the other values of its grid.
    pub weight: f64,
    /// How far it is to the neighbors where the grid samples a continuum, in the setting's SI unit; `None` where the values
    /// are alternatives.
    pub spacing: Option<f64>,
}

impl GridPoint {
    const fn alternative(value: f64) -> Self {
        Self { value, weight: 1.0, spacing: None }
    }
}

impl Setting {
    /// Whether it may have this value, in SI units.
    pub fn allows(&self, value: f64) -> bool {
        (self.within.0..=self.within.1).contains(&value)
    }

    /// The values at which a search over runs of this duration \[s\] starts, of those that it may have; `None` if no search
    /// over a grid finds a setting of this kind.
    ///
    /// ```
    /// use rins_terms::{SettingKind, catalogue::GYRO_WARMUP};
    /// let grid = GYRO_WARMUP.settings[0].search_grid(1000.0).unwrap();
    /// assert_eq!(grid.map(|point| point.value).collect::<Vec<_>>(), [20.0, 60.0, 180.0, 500.0]);
    /// ```
    pub fn search_grid(&self, duration: f64) -> Option<impl Iterator<Item = GridPoint>> {
        let grid = self.kind.search_grid(duration)?;
        Some(grid.into_iter().filter(|point| self.allows(point.value)))
    }
}

impl SettingKind {
    /// How many times of an event the search grid has over a run.
    pub const EVENT_TIMES: u32 = 16;

    fn search_grid(self, duration: f64) -> Option<Vec<GridPoint>> {
        match self {
            Self::Time => {
                let spacing = duration / f64::from(Self::EVENT_TIMES);
                let time = |event: u32| spacing * (f64::from(event) + 0.5);
                let point = |event| GridPoint {
                    spacing: Some(spacing),
                    ..GridPoint::alternative(time(event))
                };
                Some((0..Self::EVENT_TIMES).map(point).collect())
            }
            Self::TimeConstant => {
                let values = TIME_CONSTANTS.map(|part| part * duration);
                let point =
                    |value| GridPoint { spacing: Some(value), ..GridPoint::alternative(value) };
                Some(values.map(point).to_vec())
            }
            Self::Exponent => Some(EXPONENTS.map(GridPoint::alternative).to_vec()),
            Self::Order => {
                // Of a bearing or a disc the higher orders are the weaker ones.
                let point = |order: f64| GridPoint {
                    weight: 1.0 / order.abs(),
                    ..GridPoint::alternative(order)
                };
                Some(ORDERS.map(point).to_vec())
            }
            _ => None,
        }
    }

    /// How well a setting that is estimated from a continuum is known before runs of this duration \[s\] are seen; `None` of a
    /// kind that is not. `value` is its estimate, in SI units.
    pub fn prior(self, value: f64, duration: f64) -> Option<SettingPrior> {
        match self {
            Self::Time => Some(SettingPrior { range: duration, sigma: TIME_SIGMA * duration }),
            Self::TimeConstant => Some(SettingPrior { range: value * LN_10, sigma: value }),
            Self::Exponent => Some(SettingPrior { range: value, sigma: value }),
            Self::Frequency => {
                Some(SettingPrior { range: value, sigma: FREQUENCY_SIGMA / duration })
            }
            _ => None,
        }
    }

    /// How far to either side of `value` a numerical derivative by a setting is taken, in SI units; `None` of a kind that is
    /// not estimated from a continuum. `duration` and `epoch` are those of the runs and of their epochs \[s\].
    pub fn derivative_step(self, value: f64, duration: f64, epoch: f64) -> Option<f64> {
        match self {
            // Within an epoch an event may not move the statistics at all.
            Self::Time => Some(epoch),
            Self::TimeConstant | Self::Exponent => Some(DERIVATIVE_PART * value),
            Self::Frequency => Some(DERIVATIVE_PART / duration),
            _ => None,
        }
    }

    /// Whether the likelihood of runs is a smooth function of it; it is not of the time of an event, which happens in one
    /// sample or in the next.
    pub const fn is_smooth(self) -> bool {
        !matches!(self, Self::Time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{CATALOGUE, ENCODER_HARMONIC, GYRO_WARMUP, TABLE_WOBBLE};
    use crate::term::Term;

    #[test]
    fn a_term_has_one_setting_of_a_kind_and_one_search_grid_at_most() {
        for term in CATALOGUE {
            for (place, setting) in term.settings.iter().enumerate() {
                assert_eq!(term.setting(setting.kind), Some(place), "{}", term.id);
            }
            let searched = term.settings.iter().filter(|s| s.search_grid(1e3).is_some());
            assert!(searched.count() < 2, "{}", term.id);
        }
    }

    #[test]
    fn settings_of_one_kind_have_one_unit_and_one_key() {
        let all = || CATALOGUE.iter().flat_map(|term| term.settings);
        for one in all() {
            for other in all().filter(|other| other.kind == one.kind) {
                assert_eq!(one.unit, other.unit, "{}", one.name);
                assert_eq!(one.name, other.name, "{:?}", one.kind);
            }
        }
    }

    #[test]
    fn what_is_estimated_from_a_continuum_has_both_a_prior_and_a_derivative() {
        for setting in CATALOGUE.iter().flat_map(|term| term.settings) {
            let (kind, value) = (setting.kind, setting.default);
            let step = kind.derivative_step(value, 600.0, 1.0);
            let prior = kind.prior(value, 600.0);
            assert_eq!(step.is_some(), prior.is_some(), "{kind:?}");
            if let Some((step, prior)) = step.zip(prior) {
                assert!(0.0 < step && step < prior.sigma, "{kind:?}: {step} of {prior:?}");
                assert!(prior.sigma <= prior.range, "{kind:?}: {prior:?}");
            }
        }
    }

    #[test]
    fn a_grid_keeps_to_the_values_that_its_setting_may_have() {
        let [short] = GYRO_WARMUP.settings else { panic!("a warm-up has one setting") };
        let values: Vec<f64> = short.search_grid(10.0).unwrap().map(|p| p.value).collect();
        // 0.2 s and 0.6 s are less than the least.
        assert!(values.len() == 2 && values.iter().all(|value| *value > 1.0), "{values:?}");
        let negative = |term: &Term| {
            let grid = term.settings[0].search_grid(10.0).unwrap();
            grid.filter(|point| point.value < 0.0).count()
        };
        assert_eq!(negative(&TABLE_WOBBLE), 6);
        assert_eq!(negative(&ENCODER_HARMONIC), 0);
    }

    #[test]
    fn times_of_an_event_are_the_middles_of_equal_parts() {
        let grid = SettingKind::Time.search_grid(160.0).unwrap();
        assert_eq!((grid.len(), grid[0].value, grid[15].value), (16, 5.0, 155.0));
        assert!(grid.iter().all(|point| point.spacing == Some(10.0)));
    }
}
