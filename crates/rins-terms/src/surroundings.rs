//! What surrounds a table.

use nalgebra::Vector3;
use rins_frames::{Dcm, InFrame, Nav, Table};
use rins_motion::Station;

/// What surrounds a table: the directions in which the Earth turns, pulls and is magnetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Where the table stands.
    pub station: Station,
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The Earth's rate in the axis frame \[rad/s\].
    pub earth_rate: Vector3<f64>,
    /// The specific force at rest in the axis frame, `-g` \[m/s²\].
    pub specific_force: Vector3<f64>,
    /// The magnetic flux density in the axis frame \[T\].
    pub magnetic_field: Vector3<f64>,
}

impl Surroundings {
    /// The surroundings of a table whose axis frame has this attitude, in the Earth's dipole field.
    pub fn new(station: Station, nav_from_table: Dcm<Nav, Table>) -> Self {
        let table_from_nav = nav_from_table.inverse();
        let in_table = |vector: InFrame<Nav>| *(table_from_nav * vector).components();
        Self {
            station,
            nav_from_table,
            earth_rate: in_table(station.site.earth_rate()),
            specific_force: in_table(-station.gravity_vector()),
            magnetic_field: in_table(dipole_field(station.site.latitude)),
        }
    }

    /// The same with another magnetic field, given in n \[T\].
    #[must_use]
    pub fn with_magnetic_field(mut self, field: &InFrame<Nav>) -> Self {
        self.magnetic_field = *(self.nav_from_table.inverse() * *field).components();
        self
    }
}

/// The field of a dipole along the Earth's axis, strong as the Earth's at the equator \[T\]: within
/// some 20 deg of direction and 30 % of size of what a compass would show.
fn dipole_field(latitude: f64) -> InFrame<Nav> {
    const EQUATORIAL_FIELD: f64 = 3.0e-5;
    let (sin, cos) = latitude.sin_cos();
    InFrame::new(0.0, EQUATORIAL_FIELD * cos, -2.0 * EQUATORIAL_FIELD * sin)
}
