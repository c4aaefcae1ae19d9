//! How errors are compensated, in words.

use rins_terms::catalogue;

/// The compensation, in one line.
pub(crate) const EQUATION: &str = "true = measured − (bias + [S, M] true + terms(true)); with no terms, true = (I + [S, M])⁻¹ (measured − bias)";

/// The compensation, step by step.
pub(crate) const STEPS: [&str; 5] = [
    "1. Turn the sensors' axes into body axes as the rig file's axes say. Divide increments by their \
     interval: what is measured is a mean rate and a mean specific force.",
    "2. Take what was measured for the first guess of what was true, for gyros and accelerometers both.",
    "3. From that guess compute for each triad bias + [S, M] true, and what each further term of the file adds (its \
     equation is in the catalogue). A value in the file has the sign with which the error enters what was measured.",
    "4. Subtract the sum from what was measured: this is the next guess. Misalignments are read row, column: \
     gyro.misalignment.xz times the rate about z is taken from gyro x.",
    "5. Go back to 3 until nothing changes, three rounds or so; then multiply by the interval. Noise is left as it is.",
];

/// Whether a term of the model describes the run's table alone or has no name, so that there is nothing to undo in
/// another run.
pub(crate) fn of_run_alone(id: &str) -> bool {
    [catalogue::AXIS_ATTITUDE.id, catalogue::AXIS_AZIMUTH.id].contains(&id)
        || catalogue::term(id).is_none()
}
