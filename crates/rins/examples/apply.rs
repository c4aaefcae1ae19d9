//! Applying a calibration in another program: readings are compensated as they arrive.

use rins::frames::{InFrame, Increments};
use rins::io::Calibration;

#[expect(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: apply CALIBRATION")?;
    let calibration = Calibration::read(file.as_ref())?;
    let compensation = calibration.error.compensation()?;
    // One reading over 10 ms: 10 deg/s about z, and gravity.
    let measured = Increments {
        angle: InFrame::new(0.0, 0.0, 0.1_f64.to_radians()),
        velocity: InFrame::new(0.0, 0.0, 0.0981),
        interval: 0.01,
    };
    let compensated = compensation.compensate(&measured);
    println!("rotation of {:?} rad becomes", measured.angle.components().as_slice());
    println!("{:?} rad", compensated.angle.components().as_slice());
    Ok(())
}
