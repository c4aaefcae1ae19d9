//! Quantization grids: the LSB of a sensor, or the last digit of a log.

use rins_frames::Increments;

use rins_motion::Recording;

/// Readings are equal if they differ by no more than this fraction of the largest.
const ROUNDING: f64 = 1e-9;

/// The number of samples in which a grid is searched for: later ones have the same grid.
const ENOUGH: usize = 100_000;

/// The number of table angle readings for this search: a table may be static for long before it rotates.
pub const ENOUGH_ANGLES: usize = 1_000_000;

/// The smallest number of readings that differ from the previous one.
const FEWEST: usize = 6;

/// The number of smallest differences that may be no multiple of the grid step.
const ODD: usize = 5;

/// The largest distance of a difference from a multiple of the step, in steps, and the largest fraction of exceptions.
const OFF: f64 = 0.05;
const MOST_OFF: f64 = 0.02;

/// The smallest fraction of changes of the reading whose size in steps differs from that of the previous one.
const UNEVEN: f64 = 0.2;

/// The step is estimated from differences of at most these numbers of steps, in succession: with an inaccurate step, large
/// differences are miscounted.
const TEETH: [f64; 4] = [2.0, 10.0, 100.0, 1e4];

/// The smallest relative uncertainty of the step: the digits of a log.
const DIGITS: f64 = 1e-9;

/// The quantization grid of readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantizationGrid {
    /// The distance between adjacent values.
    pub step: f64,
    /// Its 1σ.
    pub sigma: f64,
    /// The logarithm of the p-value: the probability of such readings without a grid.
    pub ln_p: f64,
}

/// The quantization grids of a sensor, if there are any: if the sample intervals are equal, increments and rates both have
/// one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QuantizationGrids {
    /// The grid of the increments \[rad or m/s\].
    pub increments: Option<QuantizationGrid>,
    /// The grid of the mean rates or forces \[rad/s or m/s²\].
    pub rates: Option<QuantizationGrid>,
}

impl QuantizationGrids {
    /// The grids of the three gyros and the three accelerometers.
    pub fn of(recording: &Recording) -> [Self; 6] {
        let samples = &recording.increments[..recording.len().min(ENOUGH)];
        std::array::from_fn(|channel| {
            let reading = |sample: &Increments| {
                let triad = if channel < 3 { &sample.angle } else { &sample.velocity };
                triad.components()[channel % 3]
            };
            let increments: Vec<f64> = samples.iter().map(reading).collect();
            let rates: Vec<f64> =
                samples.iter().map(|sample| reading(sample) / sample.interval).collect();
            Self { increments: comb(&increments), rates: comb(&rates) }
        })
    }
}

impl QuantizationGrid {
    /// The grid of the measured table angle, if there is one.
    ///
    /// A table with a constant rate changes by nearly the same number of steps in every sample: adjacent grid values occur
    /// among these numbers of steps.
    pub fn of_table_angle(recording: &Recording) -> Option<Self> {
        let angles = recording.table_angle.as_deref()?;
        let angles = &angles[..angles.len().min(ENOUGH_ANGLES)];
        let turned: Vec<f64> = angles.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let alike = alike(angles);
        let [turned, apart] = [distances(&turned, alike), distances(angles, alike)];
        let fine = gaps(&turned, alike).into_iter().find_map(|gap| fitted(&turned, gap));
        fine.and_then(|fine| fitted(&apart, fine.step))
            .or_else(|| gaps(&apart, alike).into_iter().find_map(|gap| fitted(&apart, gap)))
    }
}

/// The grid of all but a few of `readings`, with any origin.
pub(crate) fn comb(readings: &[f64]) -> Option<QuantizationGrid> {
    let mut apart = distances(readings, alike(readings));
    if apart.len() < FEWEST {
        return None;
    }
    let odd = ODD.min(apart.len() / 100);
    apart.select_nth_unstable_by(odd, f64::total_cmp);
    let mut smallest = apart[..=odd].to_vec();
    smallest.sort_by(f64::total_cmp);
    let on_it = |comb: &QuantizationGrid| goes_unevenly(readings, comb.step);
    smallest.into_iter().find_map(|first| fitted(&apart, first)).filter(on_it)
}

/// Whether the changes vary in steps like those of rounded readings. Changes of a constant number of steps are a grid too
/// fine to be proven, as those of a gyro during an acceleration of the table.
fn goes_unevenly(readings: &[f64], step: f64) -> bool {
    let teeth: Vec<f64> =
        readings.windows(2).map(|pair| ((pair[1] - pair[0]) / step).round()).collect();
    let moved = teeth.iter().filter(|teeth| teeth.abs() > 0.5).count();
    let uneven = teeth.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > 0.5).count();
    uneven as f64 > UNEVEN * moved as f64
}

/// The smallest differences between sorted distances, including zero, that are not equal: the step, if the distances are
/// multiples of it and some of them differ by one step.
fn gaps(apart: &[f64], alike: f64) -> Vec<f64> {
    if apart.len() < FEWEST {
        return Vec::new();
    }
    let mut sorted = apart.to_vec();
    sorted.push(0.0);
    sorted.sort_by(f64::total_cmp);
    let between = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let mut gaps: Vec<f64> = between.filter(|gap| *gap > alike).collect();
    gaps.sort_by(f64::total_cmp);
    gaps.truncate(ODD + 1);
    gaps
}

/// The largest difference of equal readings.
pub(crate) fn alike(readings: &[f64]) -> f64 {
    ROUNDING * readings.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// The absolute differences of successive readings that are not equal.
fn distances(readings: &[f64], alike: f64) -> Vec<f64> {
    let apart = readings.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    apart.filter(|apart| *apart > alike).collect()
}

/// The grid with a step near `first`, if these differences are multiples of it.
fn fitted(apart: &[f64], first: f64) -> Option<QuantizationGrid> {
    let off = |apart: f64, step: f64| apart / step - (apart / step).round();
    let mut step = first;
    let mut sigma = f64::INFINITY;
    for most in TEETH {
        let counted = apart.iter().filter(|apart| {
            (0.5..most + 0.5).contains(&(*apart / step)) && off(**apart, step).abs() < 2.0 * OFF
        });
        let (mut squares, mut across, mut left, mut count) = (0.0, 0.0, 0.0, 0.0);
        for &apart in counted {
            let teeth = (apart / step).round();
            squares += teeth * teeth;
            across += teeth * apart;
            left += (step * off(apart, step)).powi(2);
            count += 1.0;
        }
        if count > 0.0 {
            step = across / squares;
            sigma = (left / count / squares).sqrt();
        }
    }
    if apart.is_empty() || sigma.is_infinite() {
        return None;
    }
    let stands = apart.iter().filter(|apart| off(**apart, step).abs() < OFF).count() as f64;
    let share = stands / apart.len() as f64;
    // Without a grid a fraction of 2 OFF of the differences is as close to a multiple: Chernoff's bound.
    let by_chance = 2.0 * OFF;
    let rest =
        if share < 1.0 { (1.0 - share) * ((1.0 - share) / (1.0 - by_chance)).ln() } else { 0.0 };
    let ln_p = -(apart.len() as f64) * (share * (share / by_chance).ln() + rest);
    (share >= 1.0 - MOST_OFF).then_some(QuantizationGrid {
        step,
        sigma: sigma.max(DIGITS * step),
        ln_p,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Readings without a grid: the fractional parts of an irrational number times squares.
    fn readings() -> Vec<f64> {
        let of = |k: u32| 40.0 + 3.0 * (f64::from(k * k) * 0.618_033_988_749_895).fract();
        (0..5000).map(of).collect()
    }

    #[test]
    fn distance_of_the_teeth_is_found_to_the_digits_of_the_log() {
        for step in [0.3, 1.7] {
            let on_comb = readings().into_iter().map(|x| 0.11 + step * (x / step).round());
            // As in a log of ten digits.
            let found = comb(&on_comb.map(|x| (x * 1e8).round() / 1e8).collect::<Vec<_>>());
            let QuantizationGrid { step: found, sigma, ln_p } = found.unwrap();
            assert!((found - step).abs() < 4.0 * sigma, "{found} {sigma}");
            assert!(sigma < 1e-6 && ln_p < -100.0, "{sigma} {ln_p}");
        }
    }

    #[test]
    fn a_few_readings_off_the_comb_do_not_hide_it() {
        let mut on_comb: Vec<f64> = readings().iter().map(|x| 0.5 * (x / 0.5).round()).collect();
        for k in 1..4 {
            on_comb[1000 * k] += 0.123;
        }
        assert!((comb(&on_comb).unwrap().step - 0.5).abs() < 1e-6);
    }

    /// A table with a constant rate changes by 279 or 280 steps per sample, here of one arcsecond; log and angle have their
    /// last digits.
    #[test]
    fn angles_that_go_on_by_many_teeth_stand_on_the_finest_comb() {
        let tooth = 4.848_137e-6;
        let turned = |k: u32| 279.72 * f64::from(k) + 3.0 * (0.01 * f64::from(k)).sin();
        let read = |k: u32| (1e10 * tooth * turned(k).round()).round() / 1e10;
        let table_angle = Some((0..20_000).map(read).collect());
        let recording = Recording { table_angle, ..Recording::default() };
        let found = QuantizationGrid::of_table_angle(&recording).unwrap();
        assert!((found.step / tooth - 1.0).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn what_is_fine_or_never_changes_stands_on_no_comb() {
        assert_eq!(comb(&readings()), None);
        assert_eq!(comb(&[1.0; 1000]), None);
        // A table that accelerates and decelerates continuously, measured by a gyro with little noise.
        let ramps = (0..5000).map(|k| 0.5 * f64::from((k % 800 - 400_i32).abs()));
        let noisy = |(ramp, noise): (f64, f64)| ramp + 0.004 * noise;
        assert_eq!(comb(&ramps.zip(readings()).map(noisy).collect::<Vec<_>>()), None);
        assert_eq!(comb(&[]), None);
    }
}
