//! The read-out lag in the attitudes of Table 4.
//!
//! The printed attitudes before and after compensation differ from the model's by
//! the same rotation about the spin axis. A read-out that is older than its
//! reference has this effect on a rotating table.

use nalgebra::Vector3;
use rins_frames::units::DEG;
use rins_frames::{Dcm, EulerAngles, Nav, Table};

use crate::pure_navigation::Outcome;
use crate::statistics::root_mean_square;

/// An outcome of the model, with the printed roll, pitch and yaw errors \[deg\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    /// The outcome of the model.
    pub(crate) model: Outcome,
    /// The printed errors: roll, pitch, yaw \[deg\].
    pub(crate) printed: [f64; 3],
}

impl Pair {
    /// The rotation from the model's attitude to the printed one, as a rotation vector in the axis frame
    /// \[deg\]: a lag gives a z component only.
    pub(crate) fn rotation(&self, reference: &EulerAngles) -> Vector3<f64> {
        let attitude = |roll: f64, pitch: f64, yaw: f64| -> Dcm<Nav, Table> {
            EulerAngles {
                roll: reference.roll + roll,
                pitch: reference.pitch + pitch,
                yaw: reference.yaw + yaw,
            }
            .dcm()
        };
        let [roll, pitch, yaw] = self.printed.map(|angle| angle * DEG);
        let EulerAngles { roll: r, pitch: p, yaw: y } = self.model.attitude;
        let apart: Dcm<Table, Table> = attitude(r, p, y).inverse() * attitude(roll, pitch, yaw);
        apart.rotation_vector() / DEG
    }
}

/// A table that rotates during the read-out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turning {
    /// The true attitude of the axis frame.
    pub(crate) reference: EulerAngles,
    /// The rate \[rad/s\].
    pub(crate) rate: f64,
}

/// The disagreement of model and printed values for a lag.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Disagreement {
    /// The lag \[s\].
    pub(crate) lag: f64,
    /// Model minus printed, three for each pair \[deg\].
    pub(crate) residuals: Vec<f64>,
}

impl Disagreement {
    /// The disagreement of these pairs if the attitude is read out `lag` \[s\] late.
    pub(crate) fn of(pairs: &[Pair], turning: &Turning, lag: f64) -> Self {
        let residuals = pairs.iter().flat_map(|pair| {
            let model = pair.model.read_out_late(&turning.reference, turning.rate, lag).figures();
            [0, 1, 2].map(|angle| model[2 + angle] - pair.printed[angle])
        });
        Self { lag, residuals: residuals.collect() }
    }

    /// The disagreement for the least-squares lag.
    pub(crate) fn least(pairs: &[Pair], turning: &Turning) -> Self {
        /// A tenth of a millisecond: the residuals are linear over a hundred of them.
        const STEP: f64 = 1e-4;
        let mut lag = 0.0;
        for _ in 0..4 {
            let at = |lag| Self::of(pairs, turning, lag).residuals;
            let (here, after, before) = (at(lag), at(lag + STEP), at(lag - STEP));
            let slopes = after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * STEP));
            let (mut along, mut square) = (0.0, 0.0);
            for (slope, residual) in slopes.zip(&here) {
                along += slope * residual;
                square += slope * slope;
            }
            lag -= along / square;
        }
        Self::of(pairs, turning, lag)
    }

    /// The root mean square of the residuals \[deg\].
    pub(crate) fn root_mean_square(&self) -> f64 {
        root_mean_square(&self.residuals)
    }

    /// The largest residual \[deg\].
    pub(crate) fn largest(&self) -> f64 {
        self.residuals.iter().fold(0.0, |largest, residual| residual.abs().max(largest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_frames::units::{DEG, DEG_PER_SECOND};
    use rins_testing::assert_close;

    #[test]
    fn a_lag_put_in_is_found() {
        let turning = Turning {
            reference: EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG },
            rate: 10.0 * DEG_PER_SECOND,
        };
        let errors = [[-0.3, 0.5, 1.0], [0.01, 0.02, -0.03]];
        let pairs = errors.map(|[roll, pitch, yaw]| {
            let attitude = EulerAngles { roll: roll * DEG, pitch: pitch * DEG, yaw: yaw * DEG };
            let model = Outcome { velocity: [0.0; 2], attitude };
            let [_, _, roll, pitch, yaw] =
                model.read_out_late(&turning.reference, turning.rate, 0.013).figures();
            Pair { model, printed: [roll, pitch, yaw] }
        });
        let found = Disagreement::least(&pairs, &turning);
        assert_close!(found.lag, 0.013, 1e-12);
        assert!(found.root_mean_square() < 1e-12);
        assert!(Disagreement::of(&pairs, &turning, 0.0).root_mean_square() > 0.05);
        for pair in &pairs {
            let rotation = pair.rotation(&turning.reference);
            assert_close!(rotation.z, -0.13, 1e-9);
            assert!(rotation.xy().norm() < 1e-9);
        }
        // On a vertical axis the whole lag appears in yaw: 0.13 deg.
        let upright = pairs[0].model.read_out_late(&EulerAngles::default(), turning.rate, 0.013);
        assert_close!(upright.attitude.yaw, pairs[0].model.attitude.yaw - 0.13 * DEG, 1e-5 * DEG);
    }
}
