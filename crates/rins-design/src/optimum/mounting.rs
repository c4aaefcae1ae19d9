//! A mounting of the IMU: which of its axes lies along the spin axis.

use nalgebra::DMatrix;
use rins_frames::SignedAxes;
use rins_imu::ImuSpec;
use rins_terms::{FreeParameter, Model, Owner};

/// A mounting, with the error model of a run in it.
pub(super) struct Mounting {
    /// The axes of the run, whose z is the spin axis, relative to the sensors' own.
    pub(super) axes: SignedAxes,
    /// The model along the axes of the run.
    pub(super) model: Model,
    /// Its free parameters, with their ids along the sensors' own axes.
    free: Vec<FreeParameter>,
    /// The factors that convert them to the sensors' own axes: 1 or -1.
    signs: Vec<f64>,
    /// For each parameter of the design its place among those of the run, if the run has it; then those of the run alone.
    order: Vec<Option<usize>>,
}

impl Mounting {
    /// Mountings with these axes, and the parameters of the design: those that all runs share.
    ///
    /// Parameters of a run are shared only if all runs have the same mounting.
    pub(super) fn all(
        axes: &[SignedAxes],
        model: &Model,
        imu: &ImuSpec,
    ) -> (Vec<Self>, Vec<FreeParameter>) {
        let is_shared = |free: &FreeParameter| match free.owner {
            Owner::Sensor | Owner::PowerOn => true,
            Owner::Run => axes.len() == 1,
            Owner::Placement => false,
        };
        let mut shared: Vec<FreeParameter> = Vec::new();
        let mut mountings: Vec<Self> = Vec::new();
        for &axes in axes {
            let model = model.carried(&axes);
            let mut named = model.free_along(&axes, imu);
            // As in the information of a run along its own axes.
            named.sort_by_key(|(free, _)| (free.term, free.parameter));
            let (free, signs): (Vec<FreeParameter>, Vec<f64>) = named.into_iter().unzip();
            for one in free.iter().filter(|free| is_shared(free)) {
                if !shared.iter().any(|other| other.id == one.id) {
                    shared.push(one.clone());
                }
            }
            mountings.push(Self { axes, model, free, signs, order: Vec::new() });
        }
        for mounting in &mut mountings {
            let place = |one: &FreeParameter| mounting.free.iter().position(|own| own.id == one.id);
            let own = (0..mounting.free.len()).filter(|&place| !is_shared(&mounting.free[place]));
            mounting.order = shared.iter().map(place).chain(own.map(Some)).collect();
        }
        (mountings, shared)
    }

    /// The information of a run on its parameters as one on the parameters of the design, then on those of the run alone.
    pub(super) fn of_design(&self, information: &DMatrix<f64>) -> DMatrix<f64> {
        let size = self.order.len();
        DMatrix::from_fn(size, size, |row, column| match (self.order[row], self.order[column]) {
            (Some(row), Some(column)) => {
                self.signs[row] * self.signs[column] * information[(row, column)]
            }
            _ => 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use rins_calibration::Setup;
    use rins_frames::units::DEG;
    use rins_frames::{EulerAngles, Site};
    use rins_imu::TriadSpec;
    use rins_motion::{Profile, Segment, Station};
    use rins_simulation::Scenario;
    use rins_testing::assert_close;

    use super::*;
    use crate::pair::information;
    use crate::planned::Planned;

    /// The information of a run in another mounting follows from that of the same run about z.
    #[test]
    fn information_is_renamed() {
        let triad = TriadSpec::white(1e-6, 1e-6, 5e-4, 6e-4);
        let imu = ImuSpec { gyro: triad, accel: TriadSpec { noise_density: 3e-4, ..triad } };
        let site = Site { latitude: 0.8, longitude: 0.0, height: 0.0 };
        let attitude = EulerAngles { roll: 0.0, pitch: 40.0 * DEG, yaw: 1.0 }.dcm();
        let turn = |rate: f64| Segment { rate, duration: 20.0 };
        let profile = Profile::new(&[turn(0.1), turn(-0.2)], Some(0.1)).unwrap();
        let scenario =
            Scenario::perfect(Station::with_normal_gravity(site), attitude, profile, 0.05);
        let velocity = Setup::FIXED_TABLE_VELOCITY_NOISE;
        let planned = Planned::new("run".into(), scenario, imu, (5e-6, velocity, None));
        let model = Model::full();
        let about = |name: usize, sign: f64| SignedAxes {
            source: [(name + 1) % 3, (name + 2) % 3, name],
            sign: [1.0, sign, sign],
        };
        let axes = [about(2, 1.0), about(0, 1.0), about(1, -1.0)];
        let (mountings, shared) = Mounting::all(&axes, &model, &imu);
        assert_eq!(shared.len(), 24);
        for mounting in &mountings {
            let along_run = information(std::slice::from_ref(&planned), &mounting.model).unwrap();
            let renamed = mounting.of_design(&along_run.information());
            let own = information(&[planned.clone().with_axes(mounting.axes)], &model).unwrap();
            let places: Vec<usize> = shared
                .iter()
                .map(|one| own.unknowns.iter().position(|other| other.id == one.id).unwrap())
                .collect();
            let own = own.information().select_rows(&places).select_columns(&places);
            let most = own.amax();
            for row in 0..24 {
                for column in 0..24 {
                    assert_close!(renamed[(row, column)], own[(row, column)], 1e-9 * most);
                }
            }
        }
    }
}
