//! Parameters along the sensors' own axes, whatever axis is the axis of rotation.
//!
//! Inside a run z is the axis of rotation, and x and y are whichever of the sensor's axes come then. A parameter's *own*
//! name and value are along the axes that the sensor itself has: in a run about the sensor's x, `gyro.scale.z` is its
//! `gyro.scale.x`. [`SignedAxes`] say how the two stand: axis `i` of the run is `sign[i]` times the sensor's axis
//! `source[i]`, and they are a proper rotation.

use rins_frames::SignedAxes;
use rins_imu::ImuSpec;

use crate::model::{FreeParameter, Model, TermInstance};
use crate::setting::SettingKind;
use crate::term::{Parity, Term};

const LETTERS: [&str; 3] = ["x", "y", "z"];

/// The axes that a token of a name stands for, if it stands for any.
fn axes_of(token: &str) -> Option<Vec<usize>> {
    let place = |letter: char| LETTERS.iter().position(|name| name.starts_with(letter));
    let axes: Vec<usize> = token.chars().map(place).collect::<Option<_>>()?;
    (!axes.is_empty()).then_some(axes)
}

/// A name along other axes, in which products of components stand in the order of the alphabet: `x_yz`, not `x_zy`.
fn renamed(name: &str, axes: &SignedAxes) -> String {
    let mut of_output = false;
    let tokens = name.split('_').map(|token| {
        let Some(places) = axes_of(token) else { return token.to_owned() };
        let mut sources: Vec<usize> = places.iter().map(|&place| axes.source[place]).collect();
        if of_output {
            sources.sort_unstable();
        }
        of_output = true;
        sources.into_iter().map(|source| LETTERS[source]).collect()
    });
    tokens.collect::<Vec<String>>().join("_")
}

/// The sign that a parameter's axes give it along other axes.
fn sign_of(name: &str, parity: Parity, axes: &SignedAxes) -> f64 {
    let mut signs = name.split('_').filter_map(axes_of).flatten().map(|place| axes.sign[place]);
    match parity {
        Parity::Tensor => signs.product(),
        Parity::LastAxis => signs.next_back().unwrap_or(1.0),
        Parity::Unchanged | Parity::Even | Parity::OfSetting => 1.0,
    }
}

/// The place of an axis that a setting names: 1, 2, 3 for x, y, z.
fn axis_of(setting: f64) -> usize {
    [1.5, 2.5].iter().filter(|&&edge| setting > edge).count()
}

/// A channel such as `gyro.x` of a run with these axes by its own name; what has no axis keeps its name.
///
/// ```
/// use rins_frames::SignedAxes;
/// let about_x = SignedAxes { source: [1, 2, 0], sign: [1.0; 3] };
/// assert_eq!(rins_terms::own_channel("gyro.z", &about_x), "gyro.x");
/// assert_eq!(rins_terms::own_channel("encoder", &about_x), "encoder");
/// ```
pub fn own_channel(channel: &str, axes: &SignedAxes) -> String {
    let tokens = channel.split('.').map(|token| match axes_of(token) {
        Some(_) => renamed(token, axes),
        None => token.to_owned(),
    });
    tokens.collect::<Vec<String>>().join(".")
}

impl Term {
    /// The own name of the parameter at place `parameter` in a run with these axes.
    ///
    /// # Panics
    /// If there is no such parameter.
    pub fn own_name(&self, parameter: usize, axes: &SignedAxes) -> String {
        let name = self.parameters[parameter].name;
        match self.parity {
            Parity::Unchanged | Parity::OfSetting => name.into(),
            Parity::Even | Parity::Tensor | Parity::LastAxis => renamed(name, axes),
        }
    }

    /// The own names of all its parameters in a run with these axes, in the order of the term's.
    pub fn own_names(&self, axes: &SignedAxes) -> Vec<String> {
        (0..self.parameters.len()).map(|place| self.own_name(place, axes)).collect()
    }

    /// The place of the parameter with this own name, if a run with these axes has it.
    pub fn find_own(&self, name: &str, axes: &SignedAxes) -> Option<usize> {
        (0..self.parameters.len()).find(|&place| self.own_name(place, axes) == name)
    }

    /// The places of its parameters, in the order in which their own names follow each other.
    pub fn own_order(&self, axes: &SignedAxes) -> Vec<usize> {
        let prefix = |name: &str| {
            let first = name.split('_').next().unwrap_or_default();
            if axes_of(first).is_some() { String::new() } else { first.to_owned() }
        };
        let prefixes: Vec<String> = self.parameters.iter().map(|p| prefix(p.name)).collect();
        let mut places: Vec<usize> = (0..self.parameters.len()).collect();
        if !matches!(self.parity, Parity::Unchanged | Parity::OfSetting) {
            let position = |place: usize| prefixes.iter().position(|p| *p == prefixes[place]);
            places.sort_by_cached_key(|&place| (position(place), self.own_name(place, axes)));
        }
        places
    }

    /// The own value of a parameter is this times its value in a run with these axes.
    ///
    /// `settings` are those of the run, or its own: both name the axis, if they name one, by the sign that it has here.
    fn own_sign(&self, parameter: usize, settings: &[f64], axes: &SignedAxes) -> f64 {
        if self.parity == Parity::OfSetting {
            let axis = self.setting(SettingKind::Axis).map(|place| axis_of(settings[place]));
            return axis.map_or(1.0, |axis| axes.sign[axis]);
        }
        sign_of(self.parameters[parameter].name, self.parity, axes)
    }

    /// Its own settings, where those of a run with these axes are `settings`.
    pub fn own_settings(&self, settings: &[f64], axes: &SignedAxes) -> Vec<f64> {
        let mut own = settings.to_vec();
        if let (Parity::OfSetting, Some(place)) = (self.parity, self.setting(SettingKind::Axis)) {
            let axis = axis_of(settings[place]);
            if axes.source[axis] != axis {
                own[place] = (axes.source[axis] + 1) as f64;
            }
        }
        own
    }
}

impl TermInstance {
    /// The own name of a parameter, and what its value in a run with these axes is multiplied by to be its own.
    ///
    /// # Panics
    /// If there is no such parameter.
    pub fn own(&self, parameter: usize, axes: &SignedAxes) -> (String, f64) {
        let sign = self.term.own_sign(parameter, &self.settings, axes);
        (self.term.own_name(parameter, axes), sign)
    }

    /// The same term in a run whose axis `i` is `sign[i]` times axis `source[i]` of this one's run.
    ///
    /// What that run has and this one has not, as the asymmetry of another gyro's scale, is zero, and in the role that it
    /// has here.
    #[must_use]
    pub fn carried(&self, axes: &SignedAxes) -> Self {
        let back = axes.inverse();
        let mut carried =
            Self { settings: self.term.own_settings(&self.settings, &back), ..self.clone() };
        for place in 0..self.values.len() {
            let (name, sign) = carried.own(place, axes);
            let from = self.term.parameters.iter().position(|parameter| parameter.name == name);
            carried.values[place] = from.map_or(0.0, |from| sign * self.values[from]);
            carried.roles[place] = self.roles[from.unwrap_or(place)];
        }
        carried
    }

    /// The names of the parameters that are zero in no run but such as this, and have no place in one with these axes.
    pub fn without_place(&self, axes: &SignedAxes) -> Vec<&'static str> {
        let names = self.term.own_names(axes);
        let parameters = self.term.parameters.iter().zip(&self.values);
        let lost = parameters.filter(|(parameter, value)| {
            **value != 0.0 && !names.iter().any(|n| n == parameter.name)
        });
        lost.map(|(parameter, _)| parameter.name).collect()
    }
}

impl Model {
    /// The own id of a parameter in a run with these axes.
    ///
    /// # Panics
    /// If there is no such term or parameter.
    pub fn own_id(&self, term: usize, parameter: usize, axes: &SignedAxes) -> String {
        format!("{}.{}", self.term_id(term), self.terms[term].term.own_name(parameter, axes))
    }

    /// The free parameters of this model of a run with these axes, each with its own id, and what its value in the run is multiplied by
    /// to be its own. Those of a term are in the order of their own names.
    pub fn free_along(&self, axes: &SignedAxes, imu: &ImuSpec) -> Vec<(FreeParameter, f64)> {
        let own = |free: FreeParameter| {
            let (_, sign) = self.terms[free.term].own(free.parameter, axes);
            (FreeParameter { id: self.own_id(free.term, free.parameter, axes), ..free }, sign)
        };
        let mut free = self.free(imu);
        free.sort_by_cached_key(|free| {
            let order = self.terms[free.term].term.own_order(axes);
            (free.term, order.iter().position(|&place| place == free.parameter))
        });
        free.into_iter().map(own).collect()
    }

    /// The parameter with this own id in a run with these axes: its term's place, and its own.
    pub fn find_own(&self, id: &str, axes: &SignedAxes) -> Option<(usize, usize)> {
        (0..self.terms.len()).find_map(|term| {
            let name = id.strip_prefix(&self.term_id(term))?.strip_prefix('.')?;
            Some((term, self.terms[term].term.find_own(name, axes)?))
        })
    }

    /// The same model in a run whose axis `i` is `sign[i]` times axis `source[i]` of this one's run.
    #[must_use]
    pub fn carried(&self, axes: &SignedAxes) -> Self {
        Self { terms: self.terms.iter().map(|chosen| chosen.carried(axes)).collect() }
    }
}

#[cfg(test)]
mod tests;
