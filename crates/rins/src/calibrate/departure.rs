//! Estimates that lie further off than what was stated beforehand.

use rins_estimation::{Departure, Quantity};
use rins_report::number::figure;
use rins_terms::Unit;

use super::certificate::Certificate;
use crate::identifiability::name;

/// A mean NIS above this is no matter of a sensor error more or less.
pub(super) const ABSURD_NIS: f64 = 100.0;

/// An estimate that is off by more standard deviations of what was stated beforehand is told first.
const DEPARTED: f64 = 4.0;

/// One that is off by more is no result.
const ABSURD: f64 = 10.0;

impl Certificate {
    /// What is further from what was stated beforehand than such figures are, the furthest first.
    pub(crate) fn departed(&self) -> Vec<&Departure> {
        let mut departed: Vec<&Departure> =
            self.departures.iter().filter(|of| of.sigmas.abs() > DEPARTED).collect();
        departed.sort_by(|a, b| b.sigmas.abs().total_cmp(&a.sigmas.abs()));
        departed
    }

    /// Why estimates mean nothing: the innovations are beyond what any sensor error explains, or an estimate beyond what the
    /// data sheet does.
    pub(crate) fn absurd(&self) -> Option<String> {
        let nis = self.consistency.nis_mean;
        let departed = self.departed().into_iter().next().filter(|of| of.sigmas.abs() > ABSURD);
        let departed = departed.map(|of| {
            format!(
                "{}: more than {ABSURD} are no error of such a sensor; the data sheet, a unit, a scale, gravity or the attitude \
                 is wrong",
                departure_in_words(self, of)
            )
        });
        departed.or_else(|| (nis > ABSURD_NIS).then(|| {
            format!(
                "the innovations are {:.0} times larger than the noise that was found allows: units, axes, signs, \
                 attitude or table profile are wrong, and so are the estimates",
                (nis / self.consistency.nis_dof).sqrt()
            )
        }))
    }
}

/// What a departure is of: its id and unit.
pub(super) fn quantity(certificate: &Certificate, of: Quantity) -> (String, Unit) {
    match of {
        Quantity::Parameter(place) => (
            name(&certificate.identifiability, place),
            certificate.fit.parameters[place].parameter.unit,
        ),
        Quantity::GyroNoise => ("gyro.noise".into(), Unit::DEG_PER_HOUR_PER_ROOT_HERTZ),
        Quantity::AccelNoise => ("accel.noise".into(), Unit::MICRO_G_PER_ROOT_HERTZ),
    }
}

/// What is far from what was stated beforehand.
pub(super) fn departure_in_words(certificate: &Certificate, departure: &Departure) -> String {
    let (id, unit) = quantity(certificate, departure.of);
    let figures = [departure.value, departure.expected, departure.sigma]
        .map(|value| figure(value / unit.factor, 4));
    let [value, expected, sigma] = figures;
    let aliases = match departure.of {
        Quantity::Parameter(place) => {
            !certificate.identifiability.parameters[place].aliases.is_empty()
        }
        _ => false,
    };
    let what = if aliases { format!("The combination that {id} leads") } else { id };
    format!(
        "{what} is {value} {} where {expected} ± {sigma} was stated beforehand, {:.1} sigma off",
        unit.symbol,
        departure.sigmas.abs()
    )
}
