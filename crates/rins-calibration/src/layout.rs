//! The places and signs of the calibration filter's states.
//!
//! Navigation errors are *computed minus true*. The attitude error `φ` of a computed matrix is defined by `C~ = (I - φ×) C`,
//! and `ψ = φ - δθ`. The gyro errors are the remaining ones: true minus compensated.

use rins_ekf::Block;

/// `δθ_x`, `δθ_y` \[rad\] and `δh` \[m\]: the rotation of the computed position about east and north, and height.
pub const POSITION: Block<3> = Block::first();
/// `δv` in n \[m/s\].
pub const VELOCITY: Block<3> = POSITION.then();
/// `ψ` in n \[rad\].
pub const ATTITUDE: Block<3> = VELOCITY.then();
/// `M_xz`, `M_yz` and `S_z`: the gyro errors along the spin axis \[rad, rad, 1\].
pub const SPIN_AXIS_ERRORS: Block<3> = ATTITUDE.then();
/// The attitude error of the axis frame, `C~_s^n = (I - α×) C_s^n`, in n \[rad\]: a constant, which is not among the paper's
/// twelve states. It includes the error of the initial attitude and the zero error of an encoder.
pub const AXIS: Block<3> = SPIN_AXIS_ERRORS.then();

/// The paper's states, eq. (10).
pub const PAPER_STATES: usize = SPIN_AXIS_ERRORS.end();
/// All states.
pub const STATES: usize = AXIS.end();
