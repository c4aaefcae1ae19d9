//! How errors are compensated, in words.

use rins_terms::catalogue;

/// The compensation, in one line.
pub(crate) const EQUATION: &str = "true = measured − (bias + (S + M) true + terms(true)); without terms, true = (I + S + M)⁻¹ (measured − bias)";

/// The compensation, step by step.
pub(crate) const STEPS: [&str; 5] = [
    "1. Transform the readings to body axes as the rig file specifies. Divide increments by their interval to obtain mean \
     angular rate and mean specific force.",
    "2. Use the measured values of gyros and accelerometers as initial estimates of the true values.",
    "3. Compute for each triad bias + (S + M) true, and the contribution of each further term of the file (its equation is in \
     the catalogue). A value in the file has the sign with which the error enters the reading.",
    "4. Subtract the sum from the measured values: this is the next estimate. Misalignment indices are row, column: \
     gyro.misalignment.xz times the rate about z is subtracted from gyro x.",
    "5. Repeat from step 3 until convergence (about three iterations). If the log contains increments, multiply the compensated readings by the interval. Noise is not \
     compensated.",
];

/// Whether a term of the model describes the run's table alone or has no name, so that there is nothing to undo in
/// another run.
pub(crate) fn of_run_alone(id: &str) -> bool {
    [catalogue::AXIS_ATTITUDE.id, catalogue::AXIS_AZIMUTH.id].contains(&id)
        || catalogue::term(id).is_none()
}
