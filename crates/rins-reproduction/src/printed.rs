//! The printed results of the paper, in its units: m/s, degrees, arc seconds, ppm.

/// A row of Table 4 or 6: velocity east and north \[m/s\], then roll, pitch and yaw \[deg\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Navigation {
    /// `V_x`, `V_y` \[m/s\].
    pub(crate) velocity: [f64; 2],
    /// Roll, pitch, yaw \[deg\], as errors: printed minus reference.
    pub(crate) attitude_error: [f64; 3],
}

impl Navigation {
    /// All five figures, in the order of [`Outcome`](crate::pure_navigation::Outcome).
    pub(crate) fn figures(&self) -> [f64; 5] {
        let ([east, north], [roll, pitch, yaw]) = (self.velocity, self.attitude_error);
        [east, north, roll, pitch, yaw]
    }
}

/// Table 3: `M_xz`, `M_yz` \[arcsec\], `S_z` \[ppm\].
pub(crate) const TABLE_3: [f64; 3] = [59.96, 59.96, 300.02];

/// Table 4 before compensation, with the minus sign of `V_y` that only the text has.
pub(crate) const TABLE_4_BEFORE: Navigation = Navigation {
    velocity: [2.982, -17.548],
    attitude_error: [29.697 - 30.0, 20.467 - 20.0, 40.911 - 40.0],
};

/// Table 4 after compensation.
pub(crate) const TABLE_4_AFTER: Navigation = Navigation {
    velocity: [0.0447, 0.1184],
    attitude_error: [30.030 - 30.0, 19.954 - 20.0, 39.910 - 40.0],
};

/// The text of section 4.2 after compensation; it has roll and pitch interchanged.
pub(crate) const TEXT_4_AFTER: Navigation =
    Navigation { velocity: [0.065, -0.024], attitude_error: [0.034, -0.044, -0.092] };

/// Table 5: `M_xz`, `M_yz` \[arcsec\], `S_z` \[ppm\].
pub(crate) const TABLE_5: [f64; 3] = [154.2511, -107.7430, 84.0126];

/// Table 6 before compensation.
pub(crate) const TABLE_6_BEFORE: Navigation = Navigation {
    velocity: [4.9222, -1.9773],
    attitude_error: [-0.0758 - 0.0279, 0.0043 - 0.0456, 0.8809 - 0.0197],
};

/// Table 6 after compensation.
pub(crate) const TABLE_6_AFTER: Navigation = Navigation {
    velocity: [0.2950, 0.5888],
    attitude_error: [-0.0455 - 0.0279, 0.0467 - 0.0456, 0.0968 - 0.0197],
};
