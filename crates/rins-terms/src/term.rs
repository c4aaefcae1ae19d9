//! A term: one physical effect, with its equation, parameters and texts.

use nalgebra::Complex;
use num_dual::Dual64;
use rins_imu::{ImuNoise, ImuSpec, Seed};
use rins_motion::Recording;

use crate::following::settled;
use crate::grade::Grade;
use crate::kinematic_state::KinematicState;
use crate::setting::{Setting, SettingKind};
use crate::signals::{DualVector, Signals};
use crate::unit::Unit;

/// One physical effect: equation, parameters, typical ranges and texts.
///
/// Simulator, estimator, diagnosis and report all use this one item. A new effect is a new constant
/// of this type in one file of the catalogue, and its name in the list there.
#[derive(Clone, Copy, Debug)]
pub struct Term {
    /// The name in files and results, such as `accel_lever_arm`.
    pub id: &'static str,
    /// Other ids of the entry: effects that no schedule distinguishes from it.
    pub also: &'static [&'static str],
    /// The name in words, such as "lever arm of the accelerometers".
    pub name: &'static str,
    /// Physical cause, in one sentence.
    pub cause: &'static str,
    /// Equation of its error, in the notation of the book.
    pub equation: &'static str,
    /// Source of the equation: a key of the references of the book, or a derivation.
    pub source: &'static str,
    /// Its parameters; each is one number.
    pub parameters: &'static [Parameter],
    /// Numbers that select the shape of the effect, such as an order or a time.
    pub settings: &'static [Setting],
    /// Requirements on a run for the effect to be defined.
    pub needs: &'static [Need],
    /// Ids of terms with similar signatures.
    pub partners: &'static [&'static str],
    /// Discriminating test: the measurement that distinguishes it from them.
    pub told_apart_by: &'static str,
    /// Whom its parameters belong to.
    pub owner: Owner,
    /// How common it is.
    pub prevalence: Prevalence,
    /// How its parameters change where the sensors' axes are named and directed otherwise.
    pub parity: Parity,
    /// What it does.
    pub action: Action,
}

/// One number of a term.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name within the term, such as `r_x`.
    pub name: &'static str,
    /// The unit in which it is shown and written.
    pub unit: Unit,
    /// Its typical range.
    pub prior: Prior,
}

/// Typical range of a parameter.
#[derive(Clone, Copy)]
pub enum Prior {
    /// The 1σ that a data sheet gives, in SI units.
    Sheet(fn(&ImuSpec) -> f64),
    /// The smallest and largest typical magnitude, in the unit of the parameter, for navigation-grade fiber-optic
    /// gyros, laser gyros, and MEMS, in this order; of accelerometers: pendulous, vibrating beam, MEMS.
    Usual([(f64, f64); 3]),
    /// The same range for a table or a place, whatever the IMU, in the parameter's unit.
    Anywhere(f64, f64),
}

impl std::fmt::Debug for Prior {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Sheet(_) => f.write_str("Sheet"),
            Self::Usual(ranges) => f.debug_tuple("Usual").field(ranges).finish(),
            Self::Anywhere(low, high) => f.debug_tuple("Anywhere").field(low).field(high).finish(),
        }
    }
}

impl Parameter {
    /// The 1σ that is expected of an IMU with this data sheet, in SI units.
    ///
    /// For a typical range it is the largest magnitude: the range is that of good sensors.
    pub fn sigma(&self, imu: &ImuSpec) -> f64 {
        match self.prior {
            Prior::Sheet(sigma) => sigma(imu),
            Prior::Usual(_) | Prior::Anywhere(..) => self.range(imu).1,
        }
    }

    /// The smallest and largest typical magnitude for an IMU with this data sheet, in SI units.
    pub fn range(&self, imu: &ImuSpec) -> (f64, f64) {
        let (low, high) = match self.prior {
            Prior::Sheet(sigma) => {
                let sigma = sigma(imu);
                return (0.01 * sigma, 3.0 * sigma);
            }
            Prior::Usual(ranges) => ranges[Grade::of(imu) as usize],
            Prior::Anywhere(low, high) => (low, high),
        };
        (low * self.unit.factor, high * self.unit.factor)
    }
}

/// Requirement on a run for a term to be defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// A temperature channel.
    Temperature,
    /// A temperature that changes by tens of kelvins: over less, a curve is a line, and hysteresis a drift.
    TemperatureRange,
    /// An encoder.
    TableAngle,
    /// A table that turns at rates of more than one magnitude.
    SeveralRates,
    /// A table that turns both ways.
    Reversal,
    /// An axis that is not vertical.
    Tilt,
    /// More than one direction of the axis.
    SeveralTilts,
    /// A known magnetic field.
    MagneticField,
}

/// How common an effect is among sensors and rigs: its prior odds relative to those of other terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prevalence {
    /// It belongs to the error model of the instruments (IEEE 952, 1293, 1431), or to every rig, run or log.
    Standard,
    /// It needs a particular principle of the sensor, construction, or accident.
    Particular,
    /// A structure without a physical cause.
    Unknown,
}

impl Prevalence {
    /// The logarithm of the prior odds relative to a standard effect: a particular one is less probable by a factor of e, one without a
    /// physical cause by a factor of 1,100, so that two or three physical effects are preferred to one that explains as much.
    pub const fn ln_odds(self) -> f64 {
        match self {
            Self::Standard => 0.0,
            Self::Particular => -1.0,
            Self::Unknown => -7.0,
        }
    }
}

/// Whom a parameter belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The IMU: the same in all its runs.
    Sensor,
    /// The IMU from switching on to switching off, whatever it is mounted on: turn-on biases.
    PowerOn,
    /// One run, or several without a power cycle and without a change of the mounting: what the table and the base do.
    Run,
    /// One way of standing: the attitude of the axis, another one after the IMU was turned over, switched off or not.
    Placement,
}

/// How the parameters of a term change where the sensors' axes are named and directed otherwise, as by another spin axis.
///
/// Axes are the tokens of a parameter's name that consist of x, y and z only: `r_x` is along x, `x_yz` along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// Not at all: they have no axes, or those of the table, whose z is the axis of rotation.
    Unchanged,
    /// They follow their axes, and keep their signs where these are reversed: a scale error.
    Even,
    /// They follow their axes, and change their signs with each of these that is reversed: a bias, a misalignment.
    Tensor,
    /// The same, but only the last of the axes counts for the sign: accelerometer x, force along x times force along y.
    LastAxis,
    /// They change their signs with the axis that a setting of the term names.
    OfSetting,
}

/// What a term does, and to what.
#[derive(Clone, Copy)]
pub enum Action {
    /// It adds to what the sensors or the encoder read, or tilts the axis: parameters, settings, the
    /// moment, and what is added to.
    Signal(fn(&[Dual64], &[f64], &KinematicState, &mut Signals)),
    /// It does so by the rate about the gyros' own axes, which misalignments turn from the body's: parameters, settings,
    /// the moment, that rate \[rad/s\], and what is added to.
    Sensed(fn(&[Dual64], &[f64], &KinematicState, &DualVector, &mut Signals)),
    /// It follows the table's angle behind a low-pass, whose time constant is the first setting: parameters, what comes of
    /// `exp(iζ)`, and what is added to.
    Following(fn(&[Dual64], Complex<f64>, &mut Signals)),
    /// It follows the temperature behind a low-pass, whose time constant is the first setting: parameters, by how much what follows
    /// is above the temperature \[K\], and what is added to.
    Soaking(fn(&[Dual64], f64, &mut Signals)),
    /// It changes the random errors: parameters, settings, and the noise.
    Noise(fn(&[f64], &[f64], &mut Noises)),
    /// It changes the log: parameters, settings, random numbers, and the recording.
    Log(fn(&[f64], &[f64], Seed, &mut Recording)),
}

impl std::fmt::Debug for Action {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Signal(_) => "Signal",
            Self::Sensed(_) => "Sensed",
            Self::Following(_) => "Following",
            Self::Soaking(_) => "Soaking",
            Self::Noise(_) => "Noise",
            Self::Log(_) => "Log",
        })
    }
}

/// The random errors of an IMU and of its table's encoder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Noises {
    /// Of the IMU.
    pub imu: ImuNoise,
    /// The 1σ of one reading of the encoder \[rad\].
    pub encoder: f64,
}

impl Term {
    /// Whether it adds to signals, and so can be estimated.
    pub const fn is_signal(&self) -> bool {
        !matches!(self.action, Action::Noise(_) | Action::Log(_))
    }

    /// The full ids of its parameters, such as `accel_lever_arm.r_x`.
    pub fn parameter_ids(&self) -> impl Iterator<Item = String> {
        self.parameters.iter().map(|parameter| format!("{}.{}", self.id, parameter.name))
    }

    /// Whether it is the effect that `other` is: the same entry of the catalogue, or a form of it with its id.
    pub fn is(&self, other: &Self) -> bool {
        self.id == other.id
    }

    /// The place of a setting among all, if it has one of this kind.
    pub fn setting(&self, kind: SettingKind) -> Option<usize> {
        self.settings.iter().position(|setting| setting.kind == kind)
    }

    /// The settings where nothing is said of them.
    pub(crate) fn default_settings(&self) -> Vec<f64> {
        self.settings.iter().map(|setting| setting.default).collect()
    }

    /// What it adds at `moment` with these parameters, in SI units.
    ///
    /// A term that is no signal adds nothing; one that follows the table or its temperature is taken to have settled.
    pub fn signals(
        &self,
        parameters: &[f64],
        settings: &[f64],
        moment: &KinematicState,
    ) -> Signals {
        let duals: Vec<Dual64> = parameters.iter().map(|&value| Dual64::from_re(value)).collect();
        let mut signals = Signals::default();
        self.act(&duals, settings, moment, &mut signals);
        signals
    }

    /// Adds what it does at `moment`, with the derivative that the parameters carry, to gyros whose axes are the body's; if it
    /// follows the table or its temperature, then as settled.
    #[inline]
    pub fn act(
        &self,
        parameters: &[Dual64],
        settings: &[f64],
        moment: &KinematicState,
        signals: &mut Signals,
    ) {
        if let Action::Signal(act) = self.action {
            act(parameters, settings, moment, signals);
        } else {
            let aligned = [0, 1, 2].map(|axis| Dual64::from_re(moment.rate[axis]));
            self.act_on((parameters, settings), moment, &aligned, signals);
        }
    }

    /// The same to gyros that see the rate `sensed` about their own axes \[rad/s\].
    #[inline]
    pub fn act_on(
        &self,
        (parameters, settings): (&[Dual64], &[f64]),
        moment: &KinematicState,
        sensed: &DualVector,
        signals: &mut Signals,
    ) {
        match self.action {
            Action::Signal(act) => act(parameters, settings, moment, signals),
            Action::Sensed(act) => act(parameters, settings, moment, sensed, signals),
            Action::Following(act) => {
                let follows = settled(moment.mean.rate, settings[0]);
                act(parameters, moment.exp_angle() * follows, signals);
            }
            // What has settled is at the temperature.
            Action::Soaking(act) => act(parameters, 0.0, signals),
            Action::Noise(_) | Action::Log(_) => {}
        }
    }
}
