//! An encoder that is not read when its stamps say: its noise grows with the table's rate.

use rins_estimation::{Linear, NoiseKnowledge, Reference, Run};
use rins_terms::catalogue;

use crate::case::Case;
use crate::diagnosis::{Diagnosis, DiagnosisError};
use crate::disturbance::CHANNELS;
use crate::residuals::ABOUT_AXIS;
use crate::structure::Structure;

/// The shown quantity on which it shows.
const ANGLE: &str = "attitude.z";

impl Case<'_> {
    /// The case, and what `found` is, if the encoder may be read unevenly though the rig says nothing of it: where the spread
    /// of the angle is not the same all along, or, on a table that always changes its rate, within short stretches, and that
    /// explains it.
    pub(crate) fn read_unevenly(
        &self,
        found: Diagnosis,
        search: impl FnOnce(&Self) -> Result<Diagnosis, DiagnosisError>,
    ) -> Result<(Self, Diagnosis), DiagnosisError> {
        let NoiseKnowledge::Likely(mut sheet) = self.knowledge else { return Ok((*self, found)) };
        let spreads = found.unexplained.iter().any(|one| match one.structure {
            Structure::Spread(_) => one.channel == ANGLE,
            Structure::Tails => one.channel == CHANNELS[ABOUT_AXIS],
            _ => false,
        });
        let rates = found.after.linear.iter().flat_map(Linear::motion);
        let fastest = rates.fold(0.0_f64, |most, (_, rate)| most.max(rate.abs()));
        let encoder = found.after.noise.iter().map(|noise| noise.encoder).fold(0.0, f64::max);
        let is_read = |run: &Run| matches!(run.rig.reference, Reference::Encoder { .. });
        let is_asked = spreads && sheet.jitter == 0.0 && fastest > 0.0;
        if !is_asked || !self.runs.iter().any(is_read) {
            return Ok((*self, found));
        }
        // The noise that was found is about what it does at the fastest rate.
        sheet.jitter = encoder / fastest;
        let uneven = Case { knowledge: NoiseKnowledge::Likely(sheet), ..*self };
        let mut other = search(&uneven)?;
        let is_named = other.causes.iter().any(|cause| cause.term.is(&catalogue::TIMESTAMP_JITTER));
        if !is_named {
            return Ok((*self, found));
        }
        // What it gains is over the model that knows nothing of it.
        other.before = found.before;
        Ok((uneven, other))
    }
}
