//! The radius that holds a normal error in the plane with a given probability.

use statrs::function::erf::erf;

/// The number of steps of the integral over the larger axis, which is even.
const STEPS: u32 = 400;

/// The number of bisections: to the resolution of a number.
const BISECTIONS: u32 = 60;

/// The radius that holds an error with these standard deviations along its principal axes, the larger first, with this probability: the
/// circular error probable for 0.5.
pub(super) fn probable_radius([larger, smaller]: [f64; 2], probability: f64) -> f64 {
    if larger <= 0.0 {
        return 0.0;
    }
    let ratio = smaller / larger;
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if within(middle, ratio) < probability {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high) * larger
}

/// The probability within a radius, for standard deviations of one and `ratio`: over `x = r sin t`, by Simpson's rule.
fn within(radius: f64, ratio: f64) -> f64 {
    let density = |step: u32| {
        let angle = std::f64::consts::FRAC_PI_2 * f64::from(step) / f64::from(STEPS);
        let (sin, cos) = angle.sin_cos();
        let x = radius * sin;
        let across = radius * cos / (ratio * std::f64::consts::SQRT_2);
        let inside = if across.is_finite() { erf(across) } else { 1.0 };
        let weight = match step {
            0 | STEPS => 1.0,
            _ if step % 2 == 1 => 4.0,
            _ => 2.0,
        };
        weight * (-0.5 * x * x).exp() * inside * radius * cos
    };
    let sum: f64 = (0..=STEPS).map(density).sum();
    let step = std::f64::consts::FRAC_PI_2 / f64::from(STEPS);
    sum * step / 3.0 * (2.0 / std::f64::consts::PI).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle has Rayleigh's quantiles, a line those of a normal number.
    #[test]
    fn radii_are_those_of_a_circle_and_of_a_line() {
        let near =
            |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-4, "{got}, not {want}");
        near(probable_radius([2.0, 2.0], 0.5), 2.0 * 1.177_410);
        near(probable_radius([2.0, 2.0], 0.95), 2.0 * 2.447_747);
        near(probable_radius([3.0, 0.0], 0.5), 3.0 * 0.674_490);
        near(probable_radius([3.0, 1e-6], 0.95), 3.0 * 1.959_964);
        assert!(probable_radius([0.0, 0.0], 0.5).abs() < f64::MIN_POSITIVE);
    }
}
