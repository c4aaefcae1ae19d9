//! The error mechanism: the effect of constant sensor errors on inertial navigation on a rotating table.
//!
//! There are three models, from the simplest to the most accurate. All errors are *computed minus true*; the attitude error
//! is `φ` of `C~ = (I - φ×) C`.
//!
//! | | Earth | errors | valid |
//! | --- | --- | --- | --- |
//! | [`ClosedForm`] | flat, not rotating | three of the spin axis, eqs. (6), (8), (9) | first order |
//! | [`flat_navigation`] | flat, not rotating | three of the spin axis | to rounding |
//! | [`LinearModel`] | round, rotating | all 24 of both triads | first order |
//!
//! **The sign of eqs. (6), (8) and (9).** The paper (‹nie2019›) integrates `+C_b^n δω` in eq. (A.2); its own eqs. (7) and
//! (12), and any strapdown navigator, need `-C_b^n δω`. Therefore every term driven by a gyro error is printed with the wrong
//! sign; the terms of the initial errors are correct. [`Sign`] selects the sign.
//!
//! **The errors of the closed form.** In the paper's run (latitude 34.25°, roll 30°, pitch 20°, yaw 40°, 10 °/s, 360 s, 60″,
//! 60″, 300 ppm) it gives (3.174, -17.872) m/s with the sign corrected; a navigator has (2.971, -17.432) m/s, so that the
//! east velocity is wrong by 7 %. [`cost`] calculates the contributions, here without minus with the effect:
//!
//! | left out | east \[m/s\] | north \[m/s\] |
//! | --- | --: | --: |
//! | the Earth's rate | 0.082 | -0.184 |
//! | the transport rate, and with it the Schuler loop | 0.050 | -0.275 |
//! | Coriolis acceleration | 0.166 | 0.030 |
//! | products of errors, `S_z ω t` above all | -0.103 | -0.011 |
//!
//! [`LinearModel`] includes the first three and neglects the last: it is accurate to 3e-4 for small errors, but lacks 0.101
//! m/s of the east velocity in the paper's run. With the second-order terms of the flat Earth, `LinearModel` plus
//! `flat_navigation` minus `ClosedForm`, it is accurate to 0.1 % there too.
//!
//! What it does not do: changing rates, noise, and errors that are not constant in the body. A run with several rates is
//! propagated piece by piece, each from the table angle at the end of the previous one.
mod budget;
mod closed_form;
mod errors;
mod flat;
mod linear;

pub use budget::{Neglected, cost};
pub use closed_form::{ClosedForm, Sign, VelocityError};
pub use errors::{ConstantTurn, NavErrors, SensorErrors, SpinAxisErrors};
pub use flat::flat_navigation;
pub use linear::{LinearModel, Term, Terms};
