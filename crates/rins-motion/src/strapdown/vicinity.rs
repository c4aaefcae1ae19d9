//! The Earth around a navigator that hardly moves: computed once, carried along to first order.

use rins_frames::{EARTH_RATE, Site};

/// How far in latitude \[rad\] the figures are carried: six metres.
const REACH_IN_LATITUDE: f64 = 1e-6;

/// How far in height \[m\] they are carried.
///
/// Over this reach the terms of second order are some 10⁻¹² of the figures, `(6 m / R)²`.
const REACH_IN_HEIGHT: f64 = 6.0;

/// The Earth's figures at one place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Figures {
    /// The Earth's rate towards north and up, `ω_ie^n` \[rad/s\].
    pub(super) earth_rate: (f64, f64),
    /// `1 / (R_M + h)` \[1/m\].
    pub(super) meridian_curvature: f64,
    /// `1 / (R_N + h)` \[1/m\].
    pub(super) transverse_curvature: f64,
    pub(super) cos_latitude: f64,
    pub(super) tan_latitude: f64,
    /// Normal gravity \[m/s²\].
    pub(super) gravity: f64,
}

/// The figures at a centre, and their slopes there.
#[derive(Clone, Debug)]
pub(super) struct Vicinity {
    centre: Site,
    sin: f64,
    cos: f64,
    meridian_curvature: Slopes,
    transverse_curvature: Slopes,
    gravity: Slopes,
}

#[derive(Clone, Copy, Debug)]
struct Slopes {
    value: f64,
    by_latitude: f64,
    by_height: f64,
}

impl Vicinity {
    pub(super) fn around(centre: &Site) -> Self {
        let (sin, cos) = centre.latitude.sin_cos();
        Self {
            centre: *centre,
            sin,
            cos,
            meridian_curvature: Slopes::of(centre, |s| 1.0 / (s.meridian_radius() + s.height)),
            transverse_curvature: Slopes::of(centre, |s| 1.0 / (s.transverse_radius() + s.height)),
            gravity: Slopes::of(centre, Site::normal_gravity),
        }
    }

    /// The figures at `place`, about which a new vicinity is laid if it is out of reach.
    pub(super) fn at(&mut self, place: &Site) -> Figures {
        let mut north = place.latitude - self.centre.latitude;
        let mut up = place.height - self.centre.height;
        if north.abs() > REACH_IN_LATITUDE || up.abs() > REACH_IN_HEIGHT {
            *self = Self::around(place);
            (north, up) = (0.0, 0.0);
        }
        // Terms of third order are below 10⁻¹⁸ here.
        let bend = 1.0 - 0.5 * north * north;
        let (sin, cos) = (self.sin * bend + self.cos * north, self.cos * bend - self.sin * north);
        Figures {
            earth_rate: (EARTH_RATE * cos, EARTH_RATE * sin),
            meridian_curvature: self.meridian_curvature.at(north, up),
            transverse_curvature: self.transverse_curvature.at(north, up),
            cos_latitude: cos,
            tan_latitude: sin / cos,
            gravity: self.gravity.at(north, up),
        }
    }
}

impl Slopes {
    fn of(centre: &Site, figure: impl Fn(&Site) -> f64) -> Self {
        let Site { latitude, height, .. } = *centre;
        let at = |latitude, height| figure(&Site { latitude, height, ..*centre });
        let (dl, dh) = (REACH_IN_LATITUDE, REACH_IN_HEIGHT);
        Self {
            value: figure(centre),
            by_latitude: (at(latitude + dl, height) - at(latitude - dl, height)) / (2.0 * dl),
            by_height: (at(latitude, height + dh) - at(latitude, height - dh)) / (2.0 * dh),
        }
    }

    fn at(&self, north: f64, up: f64) -> f64 {
        self.value + self.by_latitude * north + self.by_height * up
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rins_frames::InFrame;
    use rins_testing::any_latitude;

    /// `(6 m / R)²` times the largest second derivative, and rounding in the slopes.
    const RELATIVE: f64 = 2e-11;

    fn closely(got: f64, want: f64) -> Result<(), TestCaseError> {
        prop_assert!((got - want).abs() <= RELATIVE * want.abs(), "{got:e} for {want:e}");
        Ok(())
    }

    proptest! {
        #[test]
        fn figures_are_those_of_the_place(
            latitude in any_latitude(),
            height in -400.0..9000.0_f64,
            north in -3e-6..3e-6_f64,
            up in -15.0..15.0_f64,
        ) {
            let centre = Site { latitude, longitude: 0.0, height };
            let place = Site { latitude: latitude + north, height: height + up, ..centre };
            let figures = Vicinity::around(&centre).at(&place);
            closely(figures.meridian_curvature, 1.0 / (place.meridian_radius() + place.height))?;
            closely(figures.transverse_curvature, 1.0 / (place.transverse_radius() + place.height))?;
            closely(figures.gravity, place.normal_gravity())?;
            closely(figures.cos_latitude, place.latitude.cos())?;
            let w_ie = place.earth_rate();
            let w_en = place.transport_rate(&InFrame::new(30.0, -20.0, 1.0));
            closely(figures.earth_rate.0, w_ie.components().y)?;
            closely(figures.earth_rate.1, w_ie.components().z)?;
            let east = 30.0 * figures.transverse_curvature;
            closely(east * figures.tan_latitude, w_en.components().z)?;
        }
    }
}
