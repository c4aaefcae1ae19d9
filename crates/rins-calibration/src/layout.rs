//! Where the calibration filter's states stand, and what their signs mean.
//!
//! Navigation errors are *computed minus true*. The attitude error `φ` of a computed matrix is
//! defined by `C~ = (I - φ×) C`, and `ψ = φ - δθ`. The gyro errors are those still in the data:
//! true minus what is already compensated.

use rins_ekf::Block;

/// `δθ_x`, `δθ_y` \[rad\] and `δh` \[m\]: the computed position turned about east and north, and height.
pub const POSITION: Block<3> = Block::first();
/// `δv` in n \[m/s\].
pub const VELOCITY: Block<3> = POSITION.then();
/// `ψ` in n \[rad\].
pub const ATTITUDE: Block<3> = VELOCITY.then();
/// `M_xz`, `M_yz` and `S_z`: the gyro errors along the spin axis \[rad, rad, 1\].
pub const SPIN_AXIS_ERRORS: Block<3> = ATTITUDE.then();
/// The attitude error of the axis frame, `C~_s^n = (I - α×) C_s^n`, in n \[rad\]: constant, and
/// not among the paper's twelve. It carries what the start attitude was off by, an encoder's zero included.
pub const AXIS: Block<3> = SPIN_AXIS_ERRORS.then();

/// The paper's states, eq. (10).
pub const PAPER_STATES: usize = SPIN_AXIS_ERRORS.end();
/// All states.
pub const STATES: usize = AXIS.end();
