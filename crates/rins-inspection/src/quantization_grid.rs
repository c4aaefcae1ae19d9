//! Readings that stand on a comb: the least bit of a sensor, or the last digit of a log.

use rins_frames::Increments;

use rins_motion::Recording;

/// Readings are the same if they differ by no more than this part of the largest.
const ROUNDING: f64 = 1e-9;

/// A comb is looked for in so many samples: those after them stand on the same.
const ENOUGH: usize = 100_000;

/// So many readings of a table angle tell how it is read: a table may rest for long before it turns.
pub const ENOUGH_ANGLES: usize = 1_000_000;

/// The fewest readings that differ from the one before.
const FEWEST: usize = 6;

/// So many of the smallest differences may be no tooth of the comb.
const ODD: usize = 5;

/// How far a difference may be from a whole number of teeth, and how many may be further.
const OFF: f64 = 0.05;
const MOST_OFF: f64 = 0.02;

/// The least part of the readings that go on by another number of teeth than the one before, of those that go on at all.
const UNEVEN: f64 = 0.2;

/// The distance of the teeth is found from differences of no more than so many, one after the other: a wrong distance
/// miscounts the many.
const TEETH: [f64; 4] = [2.0, 10.0, 100.0, 1e4];

/// The distance of the teeth is known no better than this part of it: to the digits of a log.
const DIGITS: f64 = 1e-9;

/// How far the teeth of a comb are apart on which readings stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantizationGrid {
    /// The distance.
    pub step: f64,
    /// Its 1σ.
    pub sigma: f64,
    /// The logarithm of the probability that readings off any comb lie as they do.
    pub ln_p: f64,
}

/// On which comb the readings of a sensor stand, if on any: where samples are even, its increments and its rates do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QuantizationGrids {
    /// That of its increments \[rad or m/s\].
    pub increments: Option<QuantizationGrid>,
    /// That of its mean rates or forces \[rad/s or m/s²\].
    pub rates: Option<QuantizationGrid>,
}

impl QuantizationGrids {
    /// The combs of the three gyros and the three accelerometers.
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
    /// The comb of the table angle, if there is one that is read.
    ///
    /// A table that turns evenly goes on by about as many teeth every time: what is next to each other on the comb are the
    /// numbers of teeth.
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

/// The comb on which all but a few of `readings` stand, wherever its first tooth is.
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

/// Whether readings go from tooth to tooth as what is rounded does: now by one more, now by one less. What goes on by as
/// many every time is as fine as it may be, but changes evenly: a gyro while a table speeds up.
fn goes_unevenly(readings: &[f64], step: f64) -> bool {
    let teeth: Vec<f64> =
        readings.windows(2).map(|pair| ((pair[1] - pair[0]) / step).round()).collect();
    let moved = teeth.iter().filter(|teeth| teeth.abs() > 0.5).count();
    let uneven = teeth.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > 0.5).count();
    uneven as f64 > UNEVEN * moved as f64
}

/// The smallest gaps between these distances, from none on, but for those between distances that are alike: a tooth, if the
/// distances are whole numbers of it that are next to each other somewhere.
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

/// How far readings are apart at most that are the same.
pub(crate) fn alike(readings: &[f64]) -> f64 {
    ROUNDING * readings.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// How far neighbouring readings are apart, of those that are not alike.
fn distances(readings: &[f64], alike: f64) -> Vec<f64> {
    let apart = readings.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    apart.filter(|apart| *apart > alike).collect()
}

/// The comb whose teeth are about so far apart, if these differences are between its teeth.
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
    // Of differences off any comb a share of 2 OFF is as near to a tooth: Chernoff's bound.
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

    /// Readings that no comb holds: an irrational number times squares, without its whole part.
    fn readings() -> Vec<f64> {
        let of = |k: u32| 40.0 + 3.0 * (f64::from(k * k) * 0.618_033_988_749_895).fract();
        (0..5000).map(of).collect()
    }

    #[test]
    fn distance_of_the_teeth_is_found_to_the_digits_of_the_log() {
        for step in [0.3, 1.7] {
            let on_comb = readings().into_iter().map(|x| 0.11 + step * (x / step).round());
            // As a log of ten digits has them.
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

    /// An even table goes on by 279 or 280 teeth a sample, here of a second of arc; log and angle have their last digits.
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
        // A table that speeds up and slows down all the time, seen by a gyro with little noise.
        let ramps = (0..5000).map(|k| 0.5 * f64::from((k % 800 - 400_i32).abs()));
        let noisy = |(ramp, noise): (f64, f64)| ramp + 0.004 * noise;
        assert_eq!(comb(&ramps.zip(readings()).map(noisy).collect::<Vec<_>>()), None);
        assert_eq!(comb(&[]), None);
    }
}
