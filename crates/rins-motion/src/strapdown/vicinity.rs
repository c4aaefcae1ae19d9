//! The Earth's properties around an almost stationary navigator: calculated once, then extrapolated to first order.

use nalgebra::ComplexField;
use rins_frames::{EARTH_RATE, Site};
use rins_lanes::{Real, Vector};

/// The largest difference of latitude \[rad\] of the extrapolation: six meters.
const REACH_IN_LATITUDE: f64 = 1e-6;

/// The largest difference of height \[m\] of the extrapolation.
///
/// Within this range the second-order terms are about 10⁻¹² relative to the values, `(6 m / R)²`.
const REACH_IN_HEIGHT: f64 = 6.0;

/// The Earth's properties at one position.
#[derive(Clone, Copy, Debug)]
pub struct Figures<T> {
    /// The sine and cosine of the latitude.
    pub latitude: [T; 2],
    /// Their ratio.
    pub tan_latitude: T,
    /// `1 / (R_M + h)` \[1/m\].
    pub meridian_curvature: T,
    /// `1 / (R_N + h)` \[1/m\].
    pub transverse_curvature: T,
    /// Normal gravity \[m/s²\].
    pub gravity: T,
}

impl<T: Real> Figures<T> {
    /// The Earth's rate, `ω_ie^n` \[rad/s\].
    #[inline(always)]
    pub fn earth_rate(&self) -> Vector<T> {
        let [sin, cos] = self.latitude;
        Vector([sin.constant(0.0), cos * EARTH_RATE, sin * EARTH_RATE])
    }
}

/// The properties at a center, and their derivatives there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vicinity<T> {
    latitude: T,
    height: T,
    sin: T,
    cos: T,
    meridian_curvature: Slopes<T>,
    transverse_curvature: Slopes<T>,
    gravity: Slopes<T>,
}

/// A value, and its derivatives by latitude \[1/rad\] and height \[1/m\].
type Slopes<T> = [T; 3];

impl Vicinity<f64> {
    fn around(latitude: f64, height: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(latitude);
        let slopes = |figure: fn(&Site) -> f64| {
            let at = |latitude, height| figure(&Site { latitude, longitude: 0.0, height });
            let (dl, dh) = (REACH_IN_LATITUDE, REACH_IN_HEIGHT);
            [
                at(latitude, height),
                (at(latitude + dl, height) - at(latitude - dl, height)) / (2.0 * dl),
                (at(latitude, height + dh) - at(latitude, height - dh)) / (2.0 * dh),
            ]
        };
        Self {
            latitude,
            height,
            sin,
            cos,
            meridian_curvature: slopes(|s| 1.0 / (s.meridian_radius() + s.height)),
            transverse_curvature: slopes(|s| 1.0 / (s.transverse_radius() + s.height)),
            gravity: slopes(Site::normal_gravity),
        }
    }
}

impl<T: Real> Vicinity<T> {
    /// The vicinities of these positions.
    pub(super) fn of(latitude: T, height: T) -> Self {
        Self::each(latitude, |run| Vicinity::around(latitude.lane(run), height.lane(run)))
    }

    fn each(like: T, vicinity: impl Fn(usize) -> Vicinity<f64>) -> Self {
        let all: Vec<_> = (0..like.lanes()).map(vicinity).collect();
        let number = |of: fn(&Vicinity<f64>) -> f64| like.each(|run| of(&all[run]));
        let slopes = |of: fn(&Vicinity<f64>) -> Slopes<f64>| {
            [0, 1, 2].map(|index| like.each(|run| of(&all[run])[index]))
        };
        Self {
            latitude: number(|v| v.latitude),
            height: number(|v| v.height),
            sin: number(|v| v.sin),
            cos: number(|v| v.cos),
            meridian_curvature: slopes(|v| v.meridian_curvature),
            transverse_curvature: slopes(|v| v.transverse_curvature),
            gravity: slopes(|v| v.gravity),
        }
    }

    fn lane(&self, run: usize) -> Vicinity<f64> {
        let slopes = |slopes: &Slopes<T>| slopes.map(|x| x.lane(run));
        Vicinity {
            latitude: self.latitude.lane(run),
            height: self.height.lane(run),
            sin: self.sin.lane(run),
            cos: self.cos.lane(run),
            meridian_curvature: slopes(&self.meridian_curvature),
            transverse_curvature: slopes(&self.transverse_curvature),
            gravity: slopes(&self.gravity),
        }
    }

    /// The properties at a position; a position out of range becomes the center of a new vicinity.
    #[inline(always)]
    pub(super) fn at(&mut self, latitude: T, height: T) -> Figures<T> {
        let (north, up) = (latitude - self.latitude, height - self.height);
        let within = |x: T, reach: f64| (x * x).all_below(reach * reach);
        if !(within(north, REACH_IN_LATITUDE) && within(up, REACH_IN_HEIGHT)) {
            self.follow(latitude, height);
        }
        let (north, up) = (latitude - self.latitude, height - self.height);
        // Third-order terms are below 10⁻¹⁸ here.
        let bend = -(north * north * 0.5) + 1.0;
        let sin = self.sin * bend + self.cos * north;
        let cos = self.cos * bend - self.sin * north;
        let figure = |[value, by_latitude, by_height]: Slopes<T>| {
            value + by_latitude * north + by_height * up
        };
        Figures {
            latitude: [sin, cos],
            tan_latitude: sin / cos,
            meridian_curvature: figure(self.meridian_curvature),
            transverse_curvature: figure(self.transverse_curvature),
            gravity: figure(self.gravity),
        }
    }

    /// Calculates new vicinities for the runs that are out of range of theirs.
    #[cold]
    fn follow(&mut self, latitude: T, height: T) {
        let old = *self;
        *self = Self::each(latitude, |run| {
            let (here, up) = (latitude.lane(run), height.lane(run));
            let vicinity = old.lane(run);
            let (dl, dh) = (here - vicinity.latitude, up - vicinity.height);
            let near = |x: f64, reach: f64| x * x < reach * reach;
            if near(dl, REACH_IN_LATITUDE) && near(dh, REACH_IN_HEIGHT) {
                vicinity
            } else {
                Vicinity::around(here, up)
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rins_frames::InFrame;
    use rins_testing::any_latitude;

    /// `(6 m / R)²` times the largest second derivative, and rounding of the derivatives.
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
            let place = Site { latitude: latitude + north, longitude: 0.0, height: height + up };
            let figures = Vicinity::around(latitude, height).at(place.latitude, place.height);
            closely(figures.meridian_curvature, 1.0 / (place.meridian_radius() + place.height))?;
            closely(figures.transverse_curvature, 1.0 / (place.transverse_radius() + place.height))?;
            closely(figures.gravity, place.normal_gravity())?;
            closely(figures.latitude[1], place.latitude.cos())?;
            let w_ie = place.earth_rate();
            let w_en = place.transport_rate(&InFrame::new(30.0, -20.0, 1.0));
            closely(figures.earth_rate()[1], w_ie.components().y)?;
            closely(figures.earth_rate()[2], w_ie.components().z)?;
            let east = 30.0 * figures.transverse_curvature;
            closely(east * figures.tan_latitude, w_en.components().z)?;
        }

        /// A step in latitude alone or in height alone leaves the vicinity, and a step back into it does too.
        #[test]
        fn figures_follow_a_place_that_goes_far_one_way(
            latitude in any_latitude(),
            height in -400.0..9000.0_f64,
            north in prop::sample::select(vec![-1e-2, -2e-4, 2e-4, 1e-2]),
            up in prop::sample::select(vec![-4e3, -500.0, 500.0, 4e3]),
        ) {
            let mut vicinity = Vicinity::around(latitude, height);
            for (north, up) in [(north, 0.0), (0.0, 0.0), (0.0, up), (north, up)] {
                let place = Site { latitude: latitude + north, longitude: 0.0, height: height + up };
                let figures = vicinity.at(place.latitude, place.height);
                closely(figures.meridian_curvature, 1.0 / (place.meridian_radius() + place.height))?;
                closely(figures.gravity, place.normal_gravity())?;
                closely(figures.latitude[0], place.latitude.sin())?;
                closely(figures.latitude[1], place.latitude.cos())?;
            }
        }
    }
}
