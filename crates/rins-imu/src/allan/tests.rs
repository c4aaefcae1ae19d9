//! Published deviations, and recovery of known noise parameters.

use rins_testing::assert_close;

use super::curve::allan_variance;
use super::*;
use crate::{Axis, NoiseModel, Quantisation, Seed, Sensor, Span, Triad, TriadNoise};

const INTERVAL: f64 = 0.02;
const N_SAMPLES: usize = 6000;

/// The noise found in each of three axes of `n_runs` runs with this noise.
fn seen(model: &NoiseModel, n_runs: u64) -> Vec<NoiseSeen> {
    let plan = AllanPlan::new(N_SAMPLES, INTERVAL).unwrap();
    let span = Span { interval: INTERVAL, duration: INTERVAL * N_SAMPLES as f64 };
    let rate = rins_frames::InFrame::new(0.3, 0.2, 0.1) * INTERVAL;
    let of_run = |run| {
        let mut noise = TriadNoise::new(model, &span, Triad::Gyro, Seed { seed: 5, run }).unwrap();
        let samples: Vec<_> =
            (0..N_SAMPLES).map(|_| *noise.corrupt(&rate, INTERVAL).components()).collect();
        [0, 1, 2].map(|axis| {
            let series: Vec<f64> = samples.iter().map(|sample| sample[axis]).collect();
            plan.noise(&series).unwrap()
        })
    };
    (0..n_runs).flat_map(of_run).collect()
}

/// The errors of the significant noise parameters, in sigmas.
fn scores(seen: &[NoiseSeen], law: NoiseLaw, truth: f64) -> Vec<f64> {
    let score = |seen: &NoiseSeen| match &seen.strengths[law as usize] {
        NoiseTerm::Seen { value, sigma, .. } => Some((value - truth) / sigma),
        NoiseTerm::NotSeen { .. } => None,
    };
    seen.iter().filter_map(score).collect()
}

fn mean_square(scores: &[f64]) -> f64 {
    scores.iter().map(|score| score * score).sum::<f64>() / scores.len() as f64
}

fn deviation(rates: &[f64], cluster: usize) -> f64 {
    let mut integral = vec![0.0];
    for rate in rates {
        integral.push(integral[integral.len() - 1] + rate);
    }
    allan_variance(&integral, cluster).sqrt()
}

#[test]
fn nine_rates_have_their_published_deviation() {
    // NBS monograph 140, annex 8.E, as in ‹riley2008›, chapter 12.
    let rates = [892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0];
    assert_close!(deviation(&rates, 1), 91.22945, 5e-6);
    assert_close!(deviation(&rates, 2), 85.95287, 5e-6);
}

#[test]
fn thousand_rates_have_their_published_deviation() {
    // ‹riley2008›, chapter 12: the numbers of a congruential generator.
    let modulus = 2_147_483_647_u64;
    let numbers = std::iter::successors(Some(1_234_567_890), |n| Some(16_807 * n % modulus));
    let rates: Vec<f64> = numbers.take(1000).map(|n| n as f64 / modulus as f64).collect();
    for (cluster, published) in [(1, 2.922319e-1), (10, 9.159953e-2), (100, 3.241343e-2)] {
        assert_close!(deviation(&rates, cluster), published, 5e-7 * published.max(0.1));
    }
}

#[test]
fn white_noise_is_found_within_its_sigma_and_nothing_beside() {
    let seen = seen(&NoiseModel::white(0.5), 100);
    let scores = scores(&seen, NoiseLaw::White, 0.5);
    assert_eq!(scores.len(), 300);
    // χ² over 300: four sigma of its mean are 0.33.
    assert_close!(mean_square(&scores), 1.0, 4.0 * (2.0 / 300.0_f64).sqrt());
    let others = [NoiseLaw::Quantisation, NoiseLaw::Flicker, NoiseLaw::RandomWalk];
    let false_alarms: usize = others.iter().map(|law| self::scores(&seen, *law, 0.0).len()).sum();
    assert!(false_alarms <= 3, "{false_alarms} of 900");
    assert!(seen.iter().all(|seen| seen.disagreement == 0.0));
}

#[test]
fn bounds_hold_the_true_deviation_as_often_as_they_say() {
    let seen = seen(&NoiseModel::white(0.5), 100);
    for place in 0..seen[0].points.len() {
        let held = seen.iter().filter(|seen| {
            let AllanPoint { time, bounds: (low, high), .. } = seen.points[place];
            (low..high).contains(&(0.5 / time.sqrt()))
        });
        // Four sigma of 300 trials are 15.
        let held = held.count();
        assert!((270..=299).contains(&held), "{held} of 300 at point {place}");
    }
}

#[test]
fn flicker_alone_is_a_floor() {
    let seen = seen(&NoiseModel { flicker: Some(0.5), ..NoiseModel::default() }, 20);
    let scores = scores(&seen, NoiseLaw::Flicker, 0.5);
    assert_eq!(scores.len(), seen.len());
    // The simulated noise has up to 6 % less power than flicker noise at the highest frequencies.
    assert!((0.5..5.0).contains(&mean_square(&scores)), "{}", mean_square(&scores));
    assert!(self::scores(&seen, NoiseLaw::White, 0.0).is_empty());
}

#[test]
fn random_walk_is_found_within_its_sigma() {
    let model = NoiseModel { bias_random_walk: 2.0, ..NoiseModel::white(0.5) };
    let seen = seen(&model, 50);
    let scores = scores(&seen, NoiseLaw::RandomWalk, 2.0);
    assert_eq!(scores.len(), seen.len());
    assert_close!(mean_square(&scores), 1.0, 0.5);
}

#[test]
fn pulses_are_quantisation() {
    // A bit of twice the noise of a sample: the rounding error is then white.
    let bit = 0.04;
    let quantisation = Some(Quantisation::Increment(bit));
    let seen = seen(&NoiseModel { quantisation, ..NoiseModel::white(0.14) }, 20);
    let scores = scores(&seen, NoiseLaw::Quantisation, bit / 12.0_f64.sqrt());
    assert_eq!(scores.len(), seen.len());
    assert!((0.3..3.0).contains(&mean_square(&scores)), "{}", mean_square(&scores));
}

#[test]
fn weak_flicker_is_bounded_or_has_its_rival() {
    let seen = seen(&NoiseModel { flicker: Some(0.5), ..NoiseModel::white(1.0) }, 30);
    let (mut bounded, mut misnamed) = (0, 0);
    for seen in &seen {
        match &seen.strengths[NoiseLaw::Flicker as usize] {
            NoiseTerm::NotSeen { below } => bounded += usize::from(*below >= 0.5),
            NoiseTerm::Seen { .. } => bounded += 1,
        }
        if let NoiseTerm::Seen { rivals, .. } = &seen.strengths[NoiseLaw::RandomWalk as usize] {
            misnamed += usize::from(!rivals.contains(&NoiseLaw::Flicker));
        }
    }
    // 2 sigma are 97.5 % of a normal distribution; that of the bound itself is skewed.
    assert!(bounded >= 80, "{bounded} of 90");
    assert!(misnamed <= 2, "{misnamed} of 90");
}

#[test]
fn dither_hides_the_laws_at_its_own_times_only() {
    let plan = AllanPlan::new(N_SAMPLES, INTERVAL).unwrap();
    let mut noise = Seed::new(3).stream(Sensor::Inertial(Triad::Gyro, Axis::X));
    // Noise of one per second, and an angle that oscillates by twice that of a sample at 11 Hz.
    let angle = |k: usize| 1.4 * k as f64;
    let series: Vec<f64> = (0..N_SAMPLES)
        .map(|k| INTERVAL.sqrt() * (noise.sample() + 2.0 * (angle(k + 1).sin() - angle(k).sin())))
        .collect();
    let seen = plan.noise(&series).unwrap();
    assert!(seen.explained_from > 4.0 * INTERVAL, "{seen:?}");
    let scores = scores(&[seen], NoiseLaw::White, 1.0);
    assert!(scores.iter().all(|score| score.abs() < 4.0), "{scores:?}");
}

#[test]
fn series_that_tell_nothing_are_refused() {
    let short = AllanPlan::new(79, INTERVAL).unwrap_err();
    assert_eq!(short, AllanError::TooShort { n_samples: 79, needed: 80 });
    assert_eq!(AllanPlan::new(80, 0.0).unwrap_err(), AllanError::Interval { interval: 0.0 });
    let plan = AllanPlan::new(80, INTERVAL).unwrap();
    let length = AllanError::Length { n_samples: 81, planned: 80 };
    assert_eq!(plan.noise(&[0.0; 81]), Err(length));
    assert_eq!(plan.noise(&[0.1; 80]), Err(AllanError::Constant));
    let mut gap = [0.0; 80];
    gap[7] = f64::NAN;
    assert_eq!(plan.noise(&gap), Err(AllanError::NotFinite { sample: 7 }));
}

/// Increments of one axis over a static interval with this noise.
fn rest(model: &NoiseModel, run: u64, samples: usize) -> Vec<f64> {
    let span = Span { interval: INTERVAL, duration: INTERVAL * samples as f64 };
    let mut noise = TriadNoise::new(model, &span, Triad::Gyro, Seed { seed: 6, run }).unwrap();
    let still = rins_frames::InFrame::zeros();
    (0..samples).map(|_| noise.corrupt(&still, INTERVAL).components().x).collect()
}

#[test]
fn lines_are_found_with_their_frequency_and_amplitude_and_leave_the_noise() {
    let (mut frequency, mut amplitude, mut white, mut seen) = (0.0, 0.0, 0.0, 0.0);
    for run in 0..200 {
        // Spread over the possible range: 40 s to 4 min, 1 to 20 Hz, 1.5 to 150 times the detection limit of a line.
        let part = |step: f64| (0.5 + step * run as f64).fract();
        let samples = 2000 + 6180 * usize::try_from(run).unwrap() % 10_000;
        let (hertz, phase) = (1.0 + 19.0 * part(0.755), 6.0 * part(0.319));
        let size = 0.5 / (samples as f64 * INTERVAL).sqrt() * 15.0 * 100_f64.powf(part(0.570));
        let mut increments = rest(&NoiseModel::white(0.5), run, samples);
        for (sample, increment) in increments.iter_mut().enumerate() {
            let time = sample as f64 * INTERVAL;
            *increment += INTERVAL * size * (std::f64::consts::TAU * hertz * time + phase).sin();
        }
        let lines = take_out_lines(&mut increments, INTERVAL);
        let [line] = lines[..] else { panic!("{run}: {lines:?}") };
        assert!(line.width == 0.0, "{run}: {line:?}");
        frequency += ((line.frequency - hertz) / line.frequency_sigma).powi(2) / 200.0;
        amplitude += ((line.amplitude - size) / line.amplitude_sigma).powi(2) / 200.0;
        let plan = AllanPlan::new(samples, INTERVAL).unwrap();
        if let NoiseTerm::Seen { value, sigma, .. } = plan.noise(&increments).unwrap().strengths[1]
        {
            white += ((value - 0.5) / sigma).powi(2);
            seen += 1.0;
        }
    }
    let bound = 4.0 * (2.0 / 200.0_f64).sqrt();
    assert_close!(frequency, 1.0, bound);
    assert_close!(amplitude, 1.0, bound);
    assert!(seen > 195.0, "{seen}");
    assert_close!(white / seen, 1.0, bound);
}

#[test]
fn noise_of_any_colour_has_no_lines() {
    for run in 0..200 {
        let part = |step: f64| (0.5 + step * run as f64).fract();
        let model = NoiseModel {
            flicker: Some(0.2 * part(0.618)),
            bias_random_walk: 0.2 * part(0.755),
            quantisation: (run % 2 == 0).then_some(Quantisation::Increment(0.05)),
            ..NoiseModel::white(0.5)
        };
        let samples = 3000 + 5700 * usize::try_from(run).unwrap() % 9000;
        let before = rest(&model, run, samples);
        let mut after = before.clone();
        assert_eq!(take_out_lines(&mut after, INTERVAL), [], "{run}");
        assert_eq!(before, after);
    }
}

/// A line whose frequency varies by a hundredth, as of a motor or of a swaying base.
#[test]
fn line_that_wanders_is_found_with_its_band_and_is_no_quantisation() {
    let (mut noise, mut seen) = (Vec::new(), 0);
    for run in 0..200 {
        let samples = 12_000;
        let part = |step: f64| (0.5 + step * run as f64).fract();
        let hertz = 2.0 + 10.0 * part(0.618);
        // From a clearly detectable amplitude to ten times that.
        let size = 10_f64.powf(part(0.755));
        let mut increments = rest(&NoiseModel::white(0.5), run, samples);
        let wander = rest(&NoiseModel::white(0.03), run + 1000, samples);
        let mut phase = 0.0;
        let mut power = 0.0;
        for (increment, wander) in increments.iter_mut().zip(wander) {
            phase += std::f64::consts::TAU * (hertz * INTERVAL + wander);
            *increment += INTERVAL * size * phase.sin();
            power += (size * phase.sin()).powi(2) / samples as f64;
        }
        let lines = take_out_lines(&mut increments, INTERVAL);
        let line = lines[0];
        assert!((line.frequency - hertz).abs() < 0.05, "{run}: {line:?}, not {hertz}");
        let off = line.amplitude - (2.0 * power).sqrt();
        // Its skirts below the noise are not removed.
        assert!(off.abs() < 4.0 * line.amplitude_sigma + 0.05 * size, "{run}: {off} {line:?}");
        let plan = AllanPlan::new(samples, INTERVAL).unwrap();
        let strengths = plan.noise(&increments).unwrap().strengths;
        seen += usize::from(matches!(strengths[0], NoiseTerm::Seen { .. }));
        let NoiseTerm::Seen { value, .. } = strengths[1] else { panic!("{run}: {strengths:?}") };
        noise.push(value);
    }
    noise.sort_by(f64::total_cmp);
    assert!(noise[100] > 0.49 && noise[100] < 0.53 && noise[199] < 0.6, "{noise:?}");
    assert!(seen < 10, "{seen}");
}
