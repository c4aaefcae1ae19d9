//! The attitude error of a system that aligns itself.

use std::collections::HashMap;

use nalgebra::{Const, Dyn, OMatrix};
use rins_frames::EARTH_RATE;

use super::input::Input;
use super::service::NORTH;
use super::{GrowthError, Service};

impl Service<'_> {
    /// The attitude error `φ` east, north and up \[rad\] per unit of each parameter (3 × n) after the system has aligned itself at rest with
    /// the sensors that have these errors, while the table turns: level from the specific force, azimuth from the Earth's rate.
    ///
    /// The velocity is constant where `(0, 0, g) × φ` cancels the mean error `∇` of the specific force, and level where the Earth's rate east
    /// cancels the mean error `ε` of the rate: `φ_E = -∇_N / g`, `φ_N = ∇_E / g` and `φ_U = (ω_U φ_N - ε_E) / ω_N`
    /// (‹groves2013›, section 5.6).
    ///
    /// # Errors
    /// [`GrowthError`] if the cycle is not as it must be, or the site is a pole.
    pub fn alignment(&self) -> Result<OMatrix<f64, Const<3>, Dyn>, GrowthError> {
        self.check(&[])?;
        let station = self.surroundings.station;
        let (sin, cos) = station.site.latitude.sin_cos();
        let mut mean = OMatrix::<f64, Const<7>, Dyn>::zeros(self.parameters.len());
        let mut inputs: HashMap<u64, Input> = HashMap::new();
        let (mut angle, mut lasting) = (0.0, 0.0);
        for segment in self.cycle {
            let rate = segment.rate;
            let input = inputs.entry(rate.to_bits()).or_insert_with(|| Input::of(self, rate));
            mean += input.mean(angle, rate * segment.duration) * segment.duration;
            angle += rate * segment.duration;
            lasting += segment.duration;
        }
        mean /= lasting;
        let columns: Vec<_> = mean
            .column_iter()
            .map(|of| {
                // The rows are -ε and ∇.
                let east = -of[4] / station.gravity;
                let north = of[3] / station.gravity;
                let up = (EARTH_RATE * sin * north + of[0]) / (EARTH_RATE * cos);
                nalgebra::Vector3::new(east, north, up)
            })
            .collect();
        Ok(OMatrix::<f64, Const<3>, Dyn>::from_columns(&columns))
    }

    /// The position error east and north \[m\] after a time \[s\] per unit of each parameter (2 × n), of a system that has aligned itself.
    ///
    /// A rotation of both triads about the axis is only another choice of body axes: it does not change this error.
    ///
    /// # Errors
    /// [`GrowthError`] as of [`growth`](Self::growth).
    pub fn position_after_alignment(
        &self,
        time: f64,
    ) -> Result<OMatrix<f64, Const<2>, Dyn>, GrowthError> {
        let mut position = OMatrix::<f64, Const<2>, Dyn>::zeros(self.parameters.len());
        let start = self.alignment()?;
        for growth in self.growth(&[time])? {
            let all = growth.by_parameter + growth.by_start.fixed_columns::<3>(0) * &start;
            position.row_mut(0).copy_from(&all.row(NORTH + 1));
            position.row_mut(1).copy_from(&all.row(NORTH));
        }
        Ok(position)
    }
}

#[cfg(test)]
mod tests {
    use rins_frames::units::DEG;
    use rins_frames::{EulerAngles, Site};
    use rins_motion::{Segment, Station};
    use rins_terms::{Model, Surroundings};

    use super::*;

    /// What is a choice of axes has no effect, though each part of it has.
    #[test]
    fn rotation_of_both_triads_moves_no_position() {
        let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
        let tilted = EulerAngles { roll: 0.0, pitch: 25.0 * DEG, yaw: 30.0 * DEG }.dcm();
        let model = Model::sensors();
        let places: Vec<(usize, usize)> = model.places().collect();
        let cycle = [Segment { rate: 0.0, duration: 60.0 }];
        let service = Service {
            surroundings: Surroundings::new(Station::with_normal_gravity(site), tilted),
            cycle: &cycle,
            model: &model,
            parameters: &places,
            noise: [0.0; 2],
        };
        let position = service.position_after_alignment(86400.0).unwrap();
        let of = |id: &str| {
            let place = model.ids().position(|own| own == id).unwrap();
            position.column(place).into_owned()
        };
        let turned = ["gyro", "accel"].map(|triad| {
            of(&format!("{triad}.misalignment.xy")) - of(&format!("{triad}.misalignment.yx"))
        });
        let whole = turned[0] + turned[1];
        let part = of("gyro.misalignment.xy").norm();
        assert!(part > 1e4, "{part}");
        assert!(whole.norm() < 0.01 * part, "{whole} {part}");
        // 60 nautical miles a degree.
        let bias = of("gyro.bias.z").norm() * DEG / 3600.0 / 1852.0;
        assert!((200.0..1000.0).contains(&bias), "{bias} nmi after a day at 1 deg/h");
    }
}
