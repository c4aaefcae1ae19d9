//! Strategies over physical quantities, as bare numbers, so that every crate can use them.

use proptest::prelude::*;

/// Any unit vector.
pub fn any_direction() -> impl Strategy<Value = [f64; 3]> {
    [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64].prop_filter_map(
        "a direction needs a length",
        |direction| {
            let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            (length > 1e-3).then(|| direction.map(|x| x / length))
        },
    )
}

/// Any rotation vector of up to 3.1 rad, short of half a turn \[rad\].
pub fn any_rotation_vector() -> impl Strategy<Value = [f64; 3]> {
    (any_direction(), 0.0..3.1_f64).prop_map(|(direction, angle)| direction.map(|x| x * angle))
}

/// Any rotation vector from a tenth of a radian down to nothing that matters, over a hundred
/// decades \[rad\].
pub fn small_rotation_vector() -> impl Strategy<Value = [f64; 3]> {
    (any_direction(), -100.0..-1.0_f64)
        .prop_map(|(direction, exponent)| direction.map(|x| x * 10_f64.powf(exponent)))
}

/// Any 3 × 3 matrix with elements in [-1, 1].
pub fn any_matrix() -> impl Strategy<Value = [[f64; 3]; 3]> {
    prop::array::uniform3([-1.0..=1.0_f64, -1.0..=1.0_f64, -1.0..=1.0_f64])
}

/// Any latitude that is not within a degree of a pole \[rad\].
pub fn any_latitude() -> impl Strategy<Value = f64> {
    -1.55..1.55_f64
}

/// Any roll, pitch and yaw short of gimbal lock \[rad\].
pub fn any_euler_angles() -> impl Strategy<Value = [f64; 3]> {
    [-3.1..3.1_f64, -1.5..1.5_f64, -3.1..3.1_f64]
}
