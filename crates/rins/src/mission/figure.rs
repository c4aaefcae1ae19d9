//! A wanted position error.

use rins_io::quantity::kinds;

/// Times closer than this part are the same.
const SAME: f64 = 1e-9;

/// A wanted position error: a root mean square of the radial error (TRMS) after some time.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedFigure {
    /// The root mean square of the radial position error \[m\].
    pub rms: f64,
    /// The time since the start \[s\].
    pub time: f64,
    /// As it was typed.
    pub typed: String,
}

impl WantedFigure {
    /// The figure as it is typed, such as `1 nmi / 24 h`.
    ///
    /// # Errors
    /// A text that tells what was expected.
    ///
    /// ```
    /// use rins::mission::WantedFigure;
    /// let figure = WantedFigure::parse("1 nmi / 24 h")?;
    /// assert_eq!((figure.rms, figure.time), (1852.0, 86400.0));
    /// assert!(WantedFigure::parse("1 nmi").is_err());
    /// assert!(WantedFigure::parse("24 h / 1 nmi").is_err());
    /// # Ok::<(), String>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = "expected a position error after a time, such as \"1 nmi / 24 h\"";
        let (rms, time) = text.split_once('/').ok_or(expected)?;
        let rms =
            kinds::DISTANCE.parse(rms.trim()).map_err(|error| format!("{error}; {expected}"))?;
        let time =
            kinds::DURATION.parse(time.trim()).map_err(|error| format!("{error}; {expected}"))?;
        Ok(Self { rms, time, typed: text.trim().into() })
    }

    /// The place of its time among those of the results \[s\].
    pub(super) fn place(&self, times: &[f64]) -> anyhow::Result<usize> {
        let place = times.iter().position(|time| (time / self.time - 1.0).abs() < SAME);
        place.ok_or_else(|| {
            let last = times.last().copied().unwrap_or_default();
            anyhow::anyhow!(
                "the wanted figure is of {} h, which is none of the times of the results: every {} h until {} h; see [mission] interval and \
                 duration",
                self.time / 3600.0,
                times.first().copied().unwrap_or_default() / 3600.0,
                last / 3600.0
            )
        })
    }
}
