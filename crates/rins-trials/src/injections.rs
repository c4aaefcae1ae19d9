//! Known errors added to measured logs: what the diagnosis finds of them beyond what it finds without.
//!
//! The errors are written here by their equations, apart from the catalogue of `rins_terms`. The amplitude is set against the log's
//! own noise: the generalized least-squares sigma `σ⁻² = Σ |S(f)|² / P(f)` of the amplitude of a signal `s` in noise of the
//! spectral density `P`, which is estimated from the log by Welch's method.

use std::fs;
use std::path::Path;

use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rins_blind::{Random, random};
use rins_terms::catalogue;

use crate::answer::{Analyser, Named};
use crate::injected_log::{MeasuredLog, spectral_density, spectrum};
use crate::trouble::Trouble;

/// The amplitudes that are added, in sigmas; the smallest cannot be detected.
const STRENGTHS: [f64; 4] = [0.1, 3.0, 8.0, 20.0];

/// Two events are the same if they are closer than this part of the log.
const SAME_TIME: f64 = 0.1;

/// An estimate contains the truth if it is within so many sigmas.
const COVERED: f64 = 3.0;

/// An error of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Law {
    /// A bias that changes at once.
    Step,
    /// A bias that changes at a constant rate.
    Ramp,
    /// A bias that approaches its final value exponentially.
    Warmup,
    /// A gyro that reads a part of the specific force along the next axis.
    ForceSensitivity,
    /// An accelerometer that reads a part of the square of the specific force.
    Quadratic,
}

impl Law {
    /// The laws that a log can show.
    fn of(log: &MeasuredLog) -> &'static [Self] {
        const STATIC: [Law; 3] = [Law::Step, Law::Ramp, Law::Warmup];
        const ROTATING: [Law; 5] =
            [Law::Step, Law::Ramp, Law::Warmup, Law::ForceSensitivity, Law::Quadratic];
        if log.spin.is_some() { &ROTATING } else { &STATIC }
    }

    /// The id of the effect, for gyros or accelerometers, as the diagnosis names it.
    fn id(self, is_gyro: bool) -> &'static str {
        let [gyro, accel] = match self {
            Self::Step => [&catalogue::GYRO_BIAS_STEP, &catalogue::ACCEL_BIAS_STEP],
            Self::Ramp => [&catalogue::GYRO_BIAS_RAMP, &catalogue::ACCEL_BIAS_RAMP],
            Self::Warmup => [&catalogue::GYRO_WARMUP, &catalogue::ACCEL_WARMUP],
            Self::ForceSensitivity => [&catalogue::GYRO_G_SENSITIVITY; 2],
            Self::Quadratic => [&catalogue::ACCEL_QUADRATIC; 2],
        };
        if is_gyro { gyro.id } else { accel.id }
    }
}

/// An error that was added to a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Injection {
    /// The equation.
    law: Law,
    /// The effect's id.
    pub id: String,
    /// The channel: 0 to 2 are the gyros, 3 to 5 the accelerometers.
    pub channel: usize,
    /// The event's time or the time constant \[s\]; zero if there is none.
    pub time: f64,
    /// The amplitude in sigmas of the log's own noise.
    pub strength: f64,
    /// The amplitude in the SI unit of the effect's parameter.
    pub amplitude: f64,
}

/// What came of one log.
#[derive(Clone, Debug, PartialEq)]
pub struct InjectionTrial {
    /// The log's name.
    pub log: String,
    /// What was added.
    pub injection: Injection,
    /// Whether an effect that may be this one was found beyond those of the log itself.
    pub is_found: bool,
    /// The error of the amplitude in sigmas, where the effect is named alone.
    pub error: Option<f64>,
    /// Effects that are named in the log only with the injection, and are not it.
    pub false_names: Vec<String>,
    /// The effects that are named without the injection.
    pub before: Vec<String>,
    /// The time of the diagnosis \[s\].
    pub seconds: f64,
    /// The program's error.
    pub failure: Option<String>,
}

impl InjectionTrial {
    /// Whether the error is large enough to be detected in the noise of the log.
    pub(crate) fn is_detectable(&self) -> bool {
        self.injection.strength > 1.0
    }

    /// The channel's name.
    pub(crate) fn channel(&self) -> &'static str {
        ["gyro x", "gyro y", "gyro z", "accelerometer x", "accelerometer y", "accelerometer z"]
            [self.injection.channel]
    }

    /// Whether the amplitude's interval contains the truth, where there is one.
    pub(crate) fn is_covered(&self) -> Option<bool> {
        self.error.map(|error| error.abs() <= COVERED)
    }
}

/// A log, its diagnosis without an injection, and those with one of each strength.
///
/// # Errors
/// [`Trouble`] if the log cannot be read or written, or the program not be started.
pub(crate) fn injection_trials(
    rig: &Path,
    analyser: &Analyser,
    (seed, index): (u64, u64),
) -> Result<Vec<InjectionTrial>, Trouble> {
    let mut random = random(seed, index);
    let folder = tempfile::tempdir()?;
    let whole = MeasuredLog::read(&analyser.program, rig, folder.path())?;
    let log = whole.window(&mut random);
    let ask = |name: &str, log: &MeasuredLog| {
        let own = folder.path().join(name);
        fs::create_dir(&own)?;
        log.write(&own)?;
        analyser.ask(&own)
    };
    let before = ask("before", &log)?;
    let mut all = Vec::new();
    for (place, strength) in STRENGTHS.into_iter().enumerate() {
        let injection = drawn(&log, strength, &mut random);
        let mut own = log.clone();
        own.add(injection.channel, &unit_signal(&log, &injection), injection.amplitude);
        let answer = ask(&place.to_string(), &own)?;
        let duration = log.duration();
        let matches = |cause: &Named| {
            cause.may_be(&injection.id) && is_same_time(cause, &injection, duration)
        };
        let amplitude = |causes: &[Named]| {
            let cause =
                causes.iter().find(|cause| cause.effect == injection.id && matches(cause))?;
            let name = parameter(&injection);
            cause.parameters.iter().find(|one| one.0 == name).map(|one| (one.1, one.2))
        };
        let (base, found) = (amplitude(&before.causes), amplitude(&answer.causes));
        let is_new = |cause: &Named| !before.causes.iter().any(|own| own.may_be(&cause.effect));
        // What the log itself shows of the same effect is subtracted.
        let error = found.map(|(value, sigma)| {
            (value - base.map_or(0.0, |base| base.0) - injection.amplitude) / sigma
        });
        let had = before.causes.iter().any(matches);
        let changed = base
            .zip(found)
            .is_some_and(|(base, found)| (found.0 - base.0) / injection.amplitude > 0.5);
        let is_found = answer.causes.iter().any(matches) && (!had || changed);
        let is_false = |cause: &&Named| !cause.may_be(&injection.id) && is_new(cause);
        all.push(InjectionTrial {
            log: log.name.clone(),
            is_found,
            error: error.filter(|_| is_found),
            false_names: answer
                .causes
                .iter()
                .filter(is_false)
                .map(|one| one.effect.clone())
                .collect(),
            before: before.causes.iter().map(|one| one.effect.clone()).collect(),
            seconds: answer.seconds,
            failure: answer.failure,
            injection,
        });
    }
    Ok(all)
}

/// An error of this strength in a channel of the log.
fn drawn(log: &MeasuredLog, strength: f64, random: &mut Random) -> Injection {
    let laws = Law::of(log);
    let law = laws[random.random_range(0..laws.len())];
    let is_gyro = match law {
        Law::ForceSensitivity => true,
        Law::Quadratic => false,
        _ => random.random(),
    };
    let mut axes: Vec<usize> = vec![0, 1, 2];
    // The rotation itself hides what is constant about the spin axis.
    axes.retain(|axis| Some(*axis) != log.spin);
    let axis = axes[random.random_range(0..axes.len())];
    let channel = if is_gyro { axis } else { 3 + axis };
    let part = match law {
        Law::Step => 0.2 + 0.6 * random.random::<f64>(),
        Law::Warmup => 0.05 * 6_f64.powf(random.random()),
        _ => 0.0,
    };
    let mut injection = Injection {
        law,
        id: law.id(is_gyro).into(),
        channel,
        time: part * log.duration(),
        strength,
        amplitude: 1.0,
    };
    let signal = unit_signal(log, &injection);
    let sign = if random.random() { 1.0 } else { -1.0 };
    injection.amplitude = sign * strength * sigma(log, channel, &signal);
    injection
}

/// The error of each sample's rate or specific force for an amplitude of one.
fn unit_signal(log: &MeasuredLog, injection: &Injection) -> Vec<f64> {
    let Injection { law, channel, time, .. } = injection;
    let start = log.times[0];
    let of = |sample: usize| {
        let t = log.times[sample] - start;
        match law {
            Law::Step => f64::from(u8::from(t >= *time)),
            Law::Ramp => t,
            Law::Warmup => (-t / time).exp(),
            Law::ForceSensitivity => log.channels[3 + (channel + 1) % 3][sample],
            Law::Quadratic => log.channels[*channel][sample].powi(2),
        }
    };
    (0..log.times.len()).map(of).collect()
}

/// The name of the parameter that the error changes.
fn parameter(injection: &Injection) -> String {
    let axis = |of: usize| ["x", "y", "z"][of % 3];
    if injection.law == Law::ForceSensitivity {
        format!("{}{}", axis(injection.channel), axis(injection.channel + 1))
    } else {
        axis(injection.channel).into()
    }
}

/// Whether an effect is at the time of the injection, if it is an event.
fn is_same_time(cause: &Named, injection: &Injection, duration: f64) -> bool {
    let is_event = injection.law == Law::Step;
    let time = ["time", "t0"].iter().find_map(|key| cause.settings[*key]["value"].as_f64());
    !is_event || time.is_none_or(|time| (time - injection.time).abs() < SAME_TIME * duration)
}

/// The generalized least-squares sigma of the amplitude of a signal in a channel's own noise.
///
/// Noise is what remains of the channel after a linear regression on a constant and on the other channels of its triad, which
/// bias, scale errors and misalignments change; the signal loses the same part.
fn sigma(log: &MeasuredLog, channel: usize, signal: &[f64]) -> f64 {
    let n = signal.len();
    let triad = channel / 3 * 3;
    let others: Vec<usize> = (triad..triad + 3).filter(|other| *other != channel).collect();
    let design = DMatrix::from_fn(n, 3, |row, column| match column {
        0 => 1.0,
        _ => log.channels[others[column - 1]][row],
    });
    let scale: Vec<f64> =
        design.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE)).collect();
    let design = DMatrix::from_fn(n, 3, |row, column| design[(row, column)] / scale[column]);
    let normal = (design.transpose() * &design + DMatrix::identity(3, 3) * 1e-12).cholesky();
    let remainder = |of: &[f64]| {
        let of = DVector::from_column_slice(of);
        let fitted =
            normal.as_ref().map(|normal| &design * normal.solve(&(design.transpose() * &of)));
        fitted.map_or_else(|| of.clone(), |fitted| &of - fitted)
    };
    let interval = log.duration() / n as f64;
    let noise = spectral_density(remainder(&log.channels[channel]).as_slice(), interval);
    let power = spectrum(remainder(signal).as_slice());
    let width = 1.0 / (n as f64 * interval);
    let information: f64 = power
        .iter()
        .enumerate()
        .skip(1)
        .map(|(bin, power)| 2.0 * power * interval * interval * width / noise(bin as f64 * width))
        .sum();
    1.0 / information.sqrt()
}
