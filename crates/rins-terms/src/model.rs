//! A list of terms: what a simulator makes, an estimator estimates, a calibration holds.

use num_dual::Dual64;
use rins_imu::{ImuError, ImuSpec, Seed};
use rins_motion::Recording;

use crate::catalogue;
use crate::kinematic_state::KinematicState;
use crate::setting::SettingKind;
use crate::signals::Signals;
use crate::term::{Action, Noises, Owner, Term};
use crate::unit::Unit;

/// A term in a model: its shape, its parameters, and which of them are estimated.
#[derive(Clone, Debug)]
pub struct TermInstance {
    /// The term.
    pub term: &'static Term,
    /// Its settings, in SI units.
    pub settings: Vec<f64>,
    /// Its parameters, in SI units: true ones, or the present estimate.
    pub values: Vec<f64>,
    /// Of each parameter, whether it is estimated.
    pub roles: Vec<Role>,
}

/// Whether a parameter is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// It stays as it is.
    Held,
    /// It is estimated, its prior the usual one for the IMU's grade.
    Free,
    /// It is estimated, and known beforehand to this 1σ, in SI units.
    Within(f64),
}

impl PartialEq for TermInstance {
    fn eq(&self, other: &Self) -> bool {
        self.term.is(other.term)
            && self.settings == other.settings
            && self.values == other.values
            && self.roles == other.roles
    }
}

impl TermInstance {
    /// A term with its default settings and parameters of zero, all held.
    pub fn new(term: &'static Term) -> Self {
        let n = term.parameters.len();
        Self {
            term,
            settings: term.default_settings(),
            values: vec![0.0; n],
            roles: vec![Role::Held; n],
        }
    }

    /// The same with another setting, in SI units; a kind that the term does not have changes nothing.
    #[must_use]
    pub fn with_setting(mut self, kind: SettingKind, value: f64) -> Self {
        for (setting, slot) in self.term.settings.iter().zip(&mut self.settings) {
            if setting.kind == kind {
                *slot = value;
            }
        }
        self
    }

    /// The value of its setting of this kind, in SI units, if it has one.
    pub fn setting(&self, kind: SettingKind) -> Option<f64> {
        self.term.setting(kind).map(|place| self.settings[place])
    }

    /// The temperature at which it is zero \[°C\], if it depends on temperature.
    pub fn reference_temperature(&self) -> Option<f64> {
        self.setting(SettingKind::ReferenceTemperature)
    }

    /// The same with these parameters, in SI units.
    ///
    /// # Panics
    /// If there are not as many as the term has.
    #[must_use]
    pub fn with_values(mut self, values: &[f64]) -> Self {
        assert_eq!(values.len(), self.values.len(), "as many values as {} has", self.term.id);
        self.values.copy_from_slice(values);
        self
    }

    /// The same with all its parameters to be estimated.
    #[must_use]
    pub fn estimated(mut self) -> Self {
        self.roles.fill(Role::Free);
        self
    }

    /// The same with those parameters to be estimated that are named.
    #[must_use]
    pub fn estimating(mut self, names: &[&str]) -> Self {
        for (parameter, role) in self.term.parameters.iter().zip(&mut self.roles) {
            if names.contains(&parameter.name) {
                *role = Role::Free;
            }
        }
        self
    }

    /// What it adds at `moment` to sensors whose axes are the body's, with the derivative by parameter `by`, if one is asked
    /// for.
    pub fn signals(&self, moment: &KinematicState, by: Option<usize>) -> Signals {
        let mut duals = [Dual64::from_re(0.0); catalogue::MOST_PARAMETERS];
        for (dual, &value) in duals.iter_mut().zip(&self.values) {
            *dual = Dual64::from_re(value);
        }
        if let Some(by) = by {
            duals[by].eps = 1.0;
        }
        let mut signals = Signals::default();
        self.term.act(&duals[..self.values.len()], &self.settings, moment, &mut signals);
        signals
    }
}

/// A parameter that a model estimates.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeParameter {
    /// Its full id, such as `gyro.misalignment.xz`; a second item of the same term has `#2` before the dot.
    pub id: String,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// Whom it belongs to.
    pub owner: Owner,
    /// Which of the model's terms it is of.
    pub term: usize,
    /// Which of that term's parameters it is.
    pub parameter: usize,
    /// The 1σ to which it is known beforehand, in SI units.
    pub sigma: f64,
}

/// The terms of a run: a list, in which extending is adding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The terms.
    pub terms: Vec<TermInstance>,
}

impl Model {
    /// The paper's: the gyro errors tied to the spin axis, `M_xz`, `M_yz` and `S_z`.
    pub fn paper12() -> Self {
        Self {
            terms: vec![
                TermInstance::new(&catalogue::GYRO_SCALE).estimating(&["z"]),
                TermInstance::new(&catalogue::GYRO_MISALIGNMENT).estimating(&["xz", "yz"]),
            ],
        }
    }

    /// All of eq. (1) for both triads: biases, scale errors and misalignments, 24 numbers.
    pub fn sensors() -> Self {
        let none = Self::from(&ImuError::default());
        Self { terms: none.terms.into_iter().map(TermInstance::estimated).collect() }
    }

    /// The errors of the sensors, and the attitude of the axis: 27 numbers.
    pub fn full() -> Self {
        Self::sensors().with(TermInstance::new(&catalogue::AXIS_ATTITUDE).estimated())
    }

    /// The same with its coefficients of temperature about this temperature \[°C\].
    ///
    /// Biases and scale errors are then those at this temperature; values stay as they are.
    #[must_use]
    pub fn about_temperature(mut self, reference: f64) -> Self {
        for chosen in &mut self.terms {
            if let Some(place) = chosen.term.setting(SettingKind::ReferenceTemperature) {
                chosen.settings[place] = reference;
            }
        }
        self
    }

    /// The reference temperature of its first coefficient of temperature \[°C\], if it has one.
    pub fn reference_temperature(&self) -> Option<f64> {
        self.terms.iter().find_map(TermInstance::reference_temperature)
    }

    /// The same with one term more.
    #[must_use]
    pub fn with(mut self, chosen: TermInstance) -> Self {
        self.terms.push(chosen);
        self
    }

    /// The parameters that are estimated, in order.
    pub fn free(&self, imu: &ImuSpec) -> Vec<FreeParameter> {
        let mut free = Vec::new();
        for (index, chosen) in self.terms.iter().enumerate() {
            for (place, role) in chosen.roles.iter().enumerate() {
                let parameter = &chosen.term.parameters[place];
                let sigma = match role {
                    Role::Held => continue,
                    Role::Free => parameter.sigma(imu),
                    Role::Within(sigma) => *sigma,
                };
                free.push(FreeParameter {
                    id: self.id(index, place),
                    unit: parameter.unit,
                    owner: chosen.term.owner,
                    term: index,
                    parameter: place,
                    sigma,
                });
            }
        }
        free
    }

    /// The full id of a parameter.
    ///
    /// # Panics
    /// If there is no such term or parameter.
    pub fn id(&self, term: usize, parameter: usize) -> String {
        format!("{}.{}", self.term_id(term), self.terms[term].term.parameters[parameter].name)
    }

    /// The id of a term, with `#2` where the model has it for the second time.
    ///
    /// # Panics
    /// If there is no such term.
    pub(crate) fn term_id(&self, term: usize) -> String {
        let id = self.terms[term].term.id;
        let before = self.terms[..term].iter().filter(|other| other.term.id == id).count();
        let again = if before == 0 { String::new() } else { format!("#{}", before + 1) };
        format!("{id}{again}")
    }

    /// The full ids of all its parameters, in order.
    pub fn ids(&self) -> impl Iterator<Item = String> {
        self.places().map(|(term, parameter)| self.id(term, parameter))
    }

    /// The places of all its parameters: of its term in the model, and of it in its term.
    pub fn places(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let of = |(term, chosen): (usize, &TermInstance)| {
            (0..chosen.values.len()).map(move |parameter| (term, parameter))
        };
        self.terms.iter().enumerate().flat_map(of)
    }

    /// The parameter of this id: its term's place, and its own.
    pub fn find(&self, id: &str) -> Option<(usize, usize)> {
        self.places().find(|&(term, parameter)| self.id(term, parameter) == id)
    }

    /// The parameter of this id, in SI units, if the model has it.
    pub fn value(&self, id: &str) -> Option<f64> {
        self.find(id).map(|(term, parameter)| self.terms[term].values[parameter])
    }

    /// The same with another value of the parameter of this id, in SI units, if it has it.
    #[must_use]
    pub fn with_value(mut self, id: &str, value: f64) -> Self {
        if let Some((term, parameter)) = self.find(id) {
            self.terms[term].values[parameter] = value;
        }
        self
    }

    /// The same with the parameter of this id in another role, if it has it.
    #[must_use]
    pub fn with_role(mut self, id: &str, role: Role) -> Self {
        if let Some((term, parameter)) = self.find(id) {
            self.terms[term].roles[parameter] = role;
        }
        self
    }

    /// The noise that its terms make of `noises`.
    #[must_use]
    pub fn stirred(&self, mut noises: Noises) -> Noises {
        for chosen in &self.terms {
            if let Action::Noise(stir) = chosen.term.action {
                stir(&chosen.values, &chosen.settings, &mut noises);
            }
        }
        noises
    }

    /// Does to a finished recording what its terms do to a log, in their order.
    ///
    /// Their random numbers follow from `seed`, and are none of the noise's.
    pub fn distort(&self, seed: Seed, recording: &mut Recording) {
        for (place, chosen) in self.terms.iter().enumerate() {
            if let Action::Log(distort) = chosen.term.action {
                // The golden ratio in 64 bits: neighbouring places share no digits.
                let own = (place as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                let seed = Seed { seed: seed.seed ^ own, ..seed };
                distort(&chosen.values, &chosen.settings, seed, recording);
            }
        }
    }
}
