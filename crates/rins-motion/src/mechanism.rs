//! The error mechanism: what constant sensor errors do to a navigator on a turning table.
//!
//! Three answers to one question, from the simplest to the nearest to the truth. All errors are
//! *computed minus true*, the attitude error is `φ` of `C~ = (I - φ×) C`.
//!
//! | | Earth | errors | valid |
//! | --- | --- | --- | --- |
//! | [`ClosedForm`] | flat, not turning | three of the spin axis, eqs. (6), (8), (9) | first order |
//! | [`flat_navigation`] | flat, not turning | three of the spin axis | to rounding |
//! | [`LinearModel`] | round, turning | all 24 of both triads | first order |
//!
//! **The sign of eqs. (6), (8) and (9).** The paper (‹nie2019›) integrates `+C_b^n δω` in eq.
//! (A.2); its own eqs. (7) and (12), and any strapdown navigator, need `-C_b^n δω`. Every term
//! that a gyro error drives is therefore printed with the wrong sign; those of the initial errors
//! are right. [`Sign`] chooses.
//!
//! **What the closed form costs.** In the paper's run (latitude 34.25°, roll 30°, pitch 20°, yaw
//! 40°, 10 °/s, 360 s, 60″, 60″, 300 ppm) it gives (3.174, -17.872) m/s with the sign corrected;
//! a navigator has (2.971, -17.432) m/s, so that the east velocity is 7 % off. [`cost`] tells the
//! parts, here without minus with:
//!
//! | left out | east \[m/s\] | north \[m/s\] |
//! | --- | --: | --: |
//! | the Earth's rate | 0.082 | -0.184 |
//! | the transport rate, and with it the Schuler loop | 0.050 | -0.275 |
//! | Coriolis acceleration | 0.166 | 0.030 |
//! | products of errors, `S_z ω t` above all | -0.103 | -0.011 |
//!
//! [`LinearModel`] keeps the first three, and lacks the last: it is right to 3e-4 of errors that
//! are small, and lacks 0.101 m/s to the east of the paper's. With the second order of the flat
//! Earth, `LinearModel` and `flat_navigation` minus `ClosedForm`, it has these to 0.1 % as well.
//!
//! What it does not do: rates that change, noise, and errors that are not constant in the body.
//! A run in which the rate changes is carried piece by piece, each from the table angle reached.
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
