//! The linear model of the errors of a navigator whose vertical channel is held.

use nalgebra::Vector3;
use rins_frames::{EARTH_RATE, Site};

use super::service::Square;

/// The matrix `A` of `x' = A x + u` at a place, a velocity \[m/s\] and a specific force \[m/s²\], both in n.
pub(super) fn system(velocity: &Vector3<f64>, force: &Vector3<f64>, site: &Site) -> Square {
    let (sin, cos) = site.latitude.sin_cos();
    let tan = sin / cos;
    let meridian = site.meridian_radius() + site.height;
    let transverse = site.transverse_radius() + site.height;
    let v = velocity;
    let earth = Vector3::new(0.0, EARTH_RATE * cos, EARTH_RATE * sin);
    let transport = Vector3::new(-v.y / meridian, v.x / transverse, v.x * tan / transverse);
    let nav = earth + transport;
    // The change of the Earth's and of the transport rate by each of δv east, δv north and δr north.
    let of_earth = [
        Vector3::zeros(),
        Vector3::zeros(),
        Vector3::new(0.0, -EARTH_RATE * sin, EARTH_RATE * cos) / meridian,
    ];
    let of_transport = [
        Vector3::new(0.0, 1.0, tan) / transverse,
        Vector3::new(-1.0 / meridian, 0.0, 0.0),
        Vector3::new(0.0, 0.0, v.x / (cos * cos * transverse * meridian)),
    ];
    let mut system = Square::zeros();
    system.fixed_view_mut::<3, 3>(0, 0).copy_from(&-nav.cross_matrix());
    system.fixed_view_mut::<2, 3>(3, 0).copy_from(&force.cross_matrix().fixed_view::<2, 3>(0, 0));
    let coriolis = (earth + nav).cross_matrix();
    system.fixed_view_mut::<2, 2>(3, 3).copy_from(&-coriolis.fixed_view::<2, 2>(0, 0));
    for place in 0..3 {
        let change = of_earth[place] + of_transport[place];
        let force = (of_earth[place] + change).cross(v);
        for axis in 0..3 {
            system[(axis, 3 + place)] += change[axis];
        }
        for axis in 0..2 {
            system[(3 + axis, 3 + place)] -= force[axis];
        }
    }
    system[(5, 4)] = 1.0;
    system[(6, 3)] = 1.0;
    // East is measured along the circle of latitude.
    system[(6, 5)] = v.x * tan / meridian;
    system[(6, 6)] = -v.y * tan / meridian;
    system
}
