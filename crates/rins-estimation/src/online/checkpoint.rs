//! The state of an online filter as text, to the last bit.

use nalgebra::Matrix3;
use rins_frames::{Dcm, InFrame, Increments, Site};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::Station;
use rins_terms::{Model, Role, TermInstance, catalogue};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::filter::{OnlineFilter, Totals};
use super::linearized::Linearized;
use super::setup::{OnlineError, OnlineSetup};
use super::window::{EpochSamples, Held};
use crate::noise_parameters::{NoiseParameters, TriadStrengths};
use crate::rounding::AngleSteps;
use crate::run::{Reference, Rig};

/// The version of the format.
const VERSION: u32 = 1;

/// Numbers that are serialized as the hexadecimal digits of their bits, sixteen for each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bits(pub Vec<f64>);

impl Serialize for Bits {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let words: Vec<String> =
            self.0.iter().map(|number| format!("{:016x}", number.to_bits())).collect();
        serializer.serialize_str(&words.concat())
    }
}

impl<'de> Deserialize<'de> for Bits {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let digits = text.as_bytes();
        if !digits.len().is_multiple_of(16) || !digits.iter().all(u8::is_ascii_hexdigit) {
            return Err(D::Error::custom("expected sixteen hexadecimal digits for each number"));
        }
        let number = |word: &[u8]| {
            let word = std::str::from_utf8(word).map_err(D::Error::custom)?;
            u64::from_str_radix(word, 16).map(f64::from_bits).map_err(D::Error::custom)
        };
        digits.chunks_exact(16).map(number).collect::<Result<_, _>>().map(Self)
    }
}

/// A term of the model of a checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct TermState {
    id: String,
    settings: Bits,
    values: Bits,
    /// The sigma of each prior; not a number for a parameter that is not estimated.
    sigmas: Bits,
}

/// The state of the filter at a point of linearization.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct LinearizedState {
    /// The values of all terms of the model.
    values: Bits,
    /// The covariance of navigation and colored noise, and their derivatives by the parameters.
    covariance: Bits,
    columns: Bits,
    information: Bits,
    score: Bits,
    square: Bits,
    epochs: usize,
    angle: Bits,
}

/// The state of an [`OnlineFilter`] and of its setup. A filter that continues from it is the same to the last bit.
///
/// Its size grows with the run as long as all samples are kept: by 144 characters a sample in JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OnlineCheckpoint {
    version: u32,
    /// The time of the last sample \[s\]; empty before the first.
    time: Bits,
    setup: Bits,
    /// The model with the means of the priors.
    terms: Vec<TermState>,
    /// Time, interval, three angle and three velocity increments, and reading of each sample that is kept.
    kept: Bits,
    epochs: Vec<[usize; 4]>,
    is_complete: bool,
    start: usize,
    next: usize,
    main: LinearizedState,
    again: Option<LinearizedState>,
    linearized: usize,
    commanded: Bits,
    totals: [usize; 2],
}

impl OnlineCheckpoint {
    /// The time of the last sample, if there was one \[s\].
    pub fn time(&self) -> Option<f64> {
        self.time.0.first().copied()
    }
}

/// The numbers of a setup.
fn setup_numbers(setup: &OnlineSetup) -> Vec<f64> {
    let OnlineSetup { rig, noise, angle_steps, interval, epoch, duration, .. } = setup;
    let Site { latitude, longitude, height } = rig.station.site;
    let mut numbers = vec![latitude, longitude, height, rig.station.gravity];
    numbers.extend(rig.nav_from_table.matrix().iter());
    numbers.extend(match rig.reference {
        Reference::Encoder { noise } => [0.0, noise],
        Reference::Command { noise } => [1.0, noise],
        Reference::Gravity => [2.0, 0.0],
        Reference::Rest => [3.0, 0.0],
    });
    numbers.extend([rig.wobble, rig.velocity]);
    for triad in [&noise.gyro, &noise.accel] {
        numbers.extend([triad.white, triad.flicker, triad.walk]);
    }
    let steps = angle_steps.map_or([0.0, 0.0], |steps| [steps.step, steps.blur]);
    numbers.extend([noise.jitter, steps[0], steps[1], *interval, *epoch as f64, *duration]);
    numbers
}

fn invalid(what: &str) -> OnlineError {
    OnlineError::Checkpoint { what: what.into() }
}

/// A count that is stored as a number.
fn count(number: f64) -> Result<usize, OnlineError> {
    let is_count = (0.0..9e15).contains(&number) && number.fract().abs() < f64::EPSILON;
    if !is_count {
        return Err(invalid("a count is not a whole number"));
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number in the range"
    )]
    Ok(number as usize)
}

/// The setup of these numbers with this model.
fn setup_of(numbers: &[f64], model: Model) -> Result<OnlineSetup, OnlineError> {
    let numbers: &[f64; 29] =
        numbers.try_into().map_err(|_| invalid("the setup has not 29 numbers"))?;
    let at = |place: usize| numbers[place];
    let matrix = Matrix3::from_column_slice(&numbers[4..13]);
    let nav_from_table =
        Dcm::from_matrix(matrix).map_err(|_| invalid("the attitude is not a rotation"))?;
    let reference = match at(13).to_bits() {
        bits if bits == 0_f64.to_bits() => Reference::Encoder { noise: at(14) },
        bits if bits == 1_f64.to_bits() => Reference::Command { noise: at(14) },
        _ => return Err(invalid("the reference is unknown")),
    };
    let site = Site { latitude: at(0), longitude: at(1), height: at(2) };
    let triad =
        |place| TriadStrengths { white: at(place), flicker: at(place + 1), walk: at(place + 2) };
    // The sigmas of all priors are stated in the model.
    let none = TriadSpec::white(0.0, 0.0, 0.0, 0.0);
    Ok(OnlineSetup {
        rig: Rig {
            station: Station { site, gravity: at(3) },
            nav_from_table,
            reference,
            wobble: at(15),
            velocity: at(16),
        },
        model,
        imu: ImuSpec { gyro: none, accel: none },
        noise: NoiseParameters { gyro: triad(17), accel: triad(20), jitter: at(23) },
        angle_steps: (at(24) > 0.0).then(|| AngleSteps { step: at(24), blur: at(25) }),
        interval: at(26),
        epoch: count(at(27))?,
        duration: at(28),
    })
}

impl TermState {
    fn of(chosen: &TermInstance) -> Self {
        let sigma = |role: &Role| match role {
            Role::Within(sigma) => *sigma,
            Role::Held | Role::Free => f64::NAN,
        };
        Self {
            id: chosen.term.id.into(),
            settings: Bits(chosen.settings.clone()),
            values: Bits(chosen.values.clone()),
            sigmas: Bits(chosen.roles.iter().map(sigma).collect()),
        }
    }

    fn term(&self) -> Result<TermInstance, OnlineError> {
        let term = catalogue::term(&self.id).ok_or_else(|| invalid("a term is unknown"))?;
        let mut chosen = TermInstance::new(term);
        let (settings, values) = (&self.settings.0, &self.values.0);
        let is_complete = settings.len() == chosen.settings.len()
            && values.len() == chosen.values.len()
            && self.sigmas.0.len() == chosen.values.len();
        if !is_complete {
            return Err(invalid("a term has not the number of parameters of its kind"));
        }
        chosen.settings.clone_from(settings);
        chosen.values.clone_from(values);
        for (role, sigma) in chosen.roles.iter_mut().zip(&self.sigmas.0) {
            *role = if sigma.is_nan() { Role::Held } else { Role::Within(*sigma) };
        }
        Ok(chosen)
    }
}

/// The numbers, if there are as many as expected.
fn same(numbers: &Bits, length: usize) -> Result<&[f64], OnlineError> {
    let is_same = numbers.0.len() == length;
    is_same.then_some(&numbers.0[..]).ok_or_else(|| invalid("its lists are cut"))
}

fn sample_numbers(sample: &Held) -> [f64; 9] {
    let Held { time, increments, reading } = sample;
    let (angle, velocity) = (increments.angle.components(), increments.velocity.components());
    [
        *time,
        increments.interval,
        angle.x,
        angle.y,
        angle.z,
        velocity.x,
        velocity.y,
        velocity.z,
        *reading,
    ]
}

fn sample_of(numbers: &[f64]) -> Held {
    let vector = |place: usize| [numbers[place], numbers[place + 1], numbers[place + 2]].into();
    Held {
        time: numbers[0],
        increments: Increments {
            interval: numbers[1],
            angle: InFrame::from_components(vector(2)),
            velocity: InFrame::from_components(vector(5)),
        },
        reading: numbers[8],
    }
}

impl LinearizedState {
    fn of(linearized: &Linearized) -> Self {
        let Linearized { model, pass, normal, epochs, angle, .. } = linearized;
        let list = |numbers: &[f64]| Bits(numbers.to_vec());
        Self {
            values: Bits(model.terms.iter().flat_map(|chosen| chosen.values.clone()).collect()),
            covariance: list(pass.covariance.as_slice()),
            columns: list(pass.columns.as_slice()),
            information: list(normal.information.as_slice()),
            score: list(normal.score.as_slice()),
            square: Bits(vec![normal.square]),
            epochs: *epochs,
            angle: Bits(angle.iter().copied().collect()),
        }
    }

    /// The filter in this state.
    fn restore(&self, filter: &OnlineFilter) -> Result<Linearized, OnlineError> {
        let mut model = filter.model.clone();
        let places: Vec<_> = model.places().collect();
        for ((term, parameter), value) in
            places.iter().zip(same(&self.values, places.len())?.iter())
        {
            model.terms[*term].values[*parameter] = *value;
        }
        let mut linearized = Linearized::new(&filter.common, model);
        let Linearized { pass, normal, .. } = &mut linearized;
        for (to, from) in [
            (pass.covariance.as_mut_slice(), &self.covariance),
            (pass.columns.as_mut_slice(), &self.columns),
            (normal.information.as_mut_slice(), &self.information),
            (normal.score.as_mut_slice(), &self.score),
        ] {
            to.copy_from_slice(same(from, to.len())?);
        }
        linearized.normal.square = same(&self.square, 1)?[0];
        (linearized.epochs, linearized.angle) = (self.epochs, self.angle.0.first().copied());
        Ok(linearized)
    }
}

impl OnlineFilter {
    /// The complete state.
    pub fn checkpoint(&self) -> OnlineCheckpoint {
        let Totals { samples, epochs } = self.totals;
        let span = |of: &EpochSamples| [of.start, of.first, of.end, of.last];
        OnlineCheckpoint {
            version: VERSION,
            time: Bits(self.last.iter().copied().collect()),
            setup: Bits(setup_numbers(&self.common.setup)),
            terms: self.common.setup.model.terms.iter().map(TermState::of).collect(),
            kept: Bits(self.kept.iter().flat_map(sample_numbers).collect()),
            epochs: self.epochs.iter().map(span).collect(),
            is_complete: self.is_complete,
            start: self.start,
            next: self.next,
            main: LinearizedState::of(&self.main),
            again: self.again.as_ref().map(LinearizedState::of),
            linearized: self.linearized,
            commanded: Bits(vec![self.commanded]),
            totals: [samples, epochs],
        }
    }

    /// A filter that continues from a checkpoint.
    ///
    /// # Errors
    /// [`OnlineError::Checkpoint`] if the checkpoint is of another version or damaged.
    pub fn resume(checkpoint: &OnlineCheckpoint) -> Result<Self, OnlineError> {
        if checkpoint.version != VERSION {
            return Err(invalid("its format is that of another version"));
        }
        let terms = checkpoint.terms.iter().map(TermState::term);
        let model = Model { terms: terms.collect::<Result<Vec<_>, _>>()? };
        let mut filter = Self::new(setup_of(&checkpoint.setup.0, model)?)?;
        filter.main = checkpoint.main.restore(&filter)?;
        let again = checkpoint.again.as_ref().map(|again| again.restore(&filter));
        filter.again = again.transpose()?;
        let numbers = &checkpoint.kept.0;
        filter.kept = numbers.chunks_exact(9).map(sample_of).collect();
        let count_kept = filter.kept.len();
        let span = |&[start, first, end, last]: &[usize; 4]| {
            let is_valid = start <= first && first < end && end <= last && last <= count_kept;
            is_valid.then_some(EpochSamples { start, first, end, last })
        };
        let epochs: Option<Vec<_>> = checkpoint.epochs.iter().map(span).collect();
        filter.epochs = epochs.ok_or_else(|| invalid("an epoch has no samples"))?;
        let again = filter.again.as_ref().map_or(0, |again| again.epochs);
        if count_kept * 9 != numbers.len()
            || checkpoint.next > count_kept
            || checkpoint.start > count_kept
            || again > filter.epochs.len()
        {
            return Err(invalid("its lists are cut"));
        }
        (filter.start, filter.next) = (checkpoint.start, checkpoint.next);
        filter.is_complete = checkpoint.is_complete;
        filter.linearized = checkpoint.linearized;
        filter.commanded = same(&checkpoint.commanded, 1)?[0];
        filter.last = checkpoint.time();
        let [samples, epochs] = checkpoint.totals;
        filter.totals = Totals { samples, epochs };
        if epochs > 0 {
            filter.update()?;
        }
        Ok(filter)
    }
}
