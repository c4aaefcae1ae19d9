//! The carrier of a mission file: legs and sway.

use rins_motion::{Carrier, CarrierError, Leg, Oscillation, Sway};

use crate::error::IoError;
use crate::quantity::kinds::{self, Kind};
use crate::section::Section;

/// The keys of `[carrier]`.
pub(super) const KEYS: [&str; 4] = ["leg", "sway", "turn_rate", "acceleration"];

const LEG: [&str; 5] = ["heading", "speed", "duration", "turn_rate", "acceleration"];

/// The oscillations, and the kind of their amplitudes.
const SWAY: [(&str, &Kind); 4] = [
    ("roll", &kinds::SWAY),
    ("pitch", &kinds::SWAY),
    ("yaw", &kinds::SWAY),
    ("heave", &kinds::HEAVE),
];

/// The carrier of a section, over a mission of `duration` \[s\].
pub(super) fn read(carrier: &Section<'_>, duration: f64) -> Result<Carrier, IoError> {
    let rate_and_acceleration = |section: &Section<'_>| {
        Ok::<_, IoError>((
            section.quantity("turn_rate", &kinds::TURN_RATE)?,
            section.quantity("acceleration", &kinds::ACCELERATION)?,
        ))
    };
    let (turn_rate, acceleration) = rate_and_acceleration(carrier)?;
    let tables = carrier.tables("leg", &LEG)?.unwrap_or_default();
    let leg = |table: &Section<'_>| {
        let own = rate_and_acceleration(table)?;
        Ok::<_, IoError>(Leg {
            heading: table.require_quantity("heading", &kinds::TURN)?,
            speed: table.require_quantity("speed", &kinds::SPEED)?,
            duration: table.require_quantity("duration", &kinds::DURATION)?,
            turn_rate: own.0.or(turn_rate),
            acceleration: own.1.or(acceleration),
        })
    };
    let legs = tables.iter().map(leg).collect::<Result<Vec<Leg>, IoError>>()?;
    let sway = carrier.inline("sway", &SWAY.map(|(key, _)| key))?;
    let oscillation = |(key, kind): (&str, &Kind)| {
        let Some(sway) = &sway else { return Ok(None) };
        let Some(one) = sway.inline(key, &["amplitude", "period", "phase"])? else {
            return Ok(None);
        };
        Ok::<_, IoError>(Some(Oscillation {
            amplitude: one.require_quantity("amplitude", kind)?,
            period: one.require_quantity("period", &kinds::PERIOD)?,
            phase: one.quantity("phase", &kinds::TURN)?.unwrap_or(0.0),
        }))
    };
    let [roll, pitch, yaw, heave] = SWAY.map(oscillation);
    let sway = Sway { roll: roll?, pitch: pitch?, yaw: yaw?, heave: heave? };
    Carrier::new(&legs, sway, duration).map_err(|error| {
        let (leg, key) = match error {
            CarrierError::HeadingJumps { leg, .. } => (Some(leg), "heading"),
            CarrierError::SpeedJumps { leg, .. } | CarrierError::Leg { leg, .. } => {
                (Some(leg), "speed")
            }
            CarrierError::TooShort { leg, .. } => (Some(leg), "duration"),
            CarrierError::Sway { .. } => (None, "sway"),
            _ => (None, "leg"),
        };
        let section = leg.and_then(|leg| tables.get(leg - 1)).unwrap_or(carrier);
        section.conflict(key, error.to_string())
    })
}
