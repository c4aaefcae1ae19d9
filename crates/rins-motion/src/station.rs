//! The site of the table and its gravity.

use rins_frames::{InFrame, Nav, Site};

/// A site and its gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The site.
    pub site: Site,
    /// The magnitude of plumb-bob gravity \[m/s²\]; it points down.
    pub gravity: f64,
}

impl Station {
    /// A station with the WGS84 normal gravity of its site.
    pub fn with_normal_gravity(site: Site) -> Self {
        Self { site, gravity: site.normal_gravity() }
    }

    /// Gravity as a vector \[m/s²\].
    pub fn gravity_vector(&self) -> InFrame<Nav> {
        InFrame::new(0.0, 0.0, -self.gravity)
    }
}
