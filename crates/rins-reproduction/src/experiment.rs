//! The paper's two experiments as scenario files, with the setup of the filter.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use rins_calibration::{AxisAttitude, Setup, TableSpec};
use rins_imu::{ImuError, Seed, TriadError};
use rins_io::{Rig, ScenarioFile};
use rins_simulation::{Scenario, Simulated, simulate};

use crate::error::ReproductionError;

/// An experiment of the paper: the scenario, and the setup of the filter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Experiment {
    /// The scenario.
    pub(crate) scenario: Scenario,
    /// The setup of the calibration: station, table and IMU.
    pub(crate) setup: Setup,
}

/// The subset of the scenario's sensor errors in the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sensors {
    /// Everything in Tables 1 and 2.
    All,
    /// All except the gyro biases.
    WithoutGyroBias,
    /// The gyro errors only.
    Gyros,
    /// The three gyro errors along the spin axis, and the bias of the z gyro.
    SpinAxisAndBiasZ,
    /// The three gyro errors along the spin axis, `M_xz`, `M_yz` and `S_z`.
    SpinAxis,
    /// The three gyro errors along the spin axis and the accelerometer errors.
    SpinAxisAndAccels,
}

impl Sensors {
    /// This subset of the errors in `all`.
    #[must_use]
    pub(crate) fn of(self, all: &ImuError) -> ImuError {
        let spin_axis = spin_axis_part(&all.gyro);
        let unbiased = TriadError { bias: Vector3::zeros(), ..all.gyro };
        let only = |gyro| ImuError { gyro, accel: TriadError::default() };
        match self {
            Self::All => *all,
            Self::WithoutGyroBias => ImuError { gyro: unbiased, ..*all },
            Self::Gyros => only(all.gyro),
            Self::SpinAxis => only(spin_axis),
            Self::SpinAxisAndBiasZ => {
                only(TriadError { bias: Vector3::new(0.0, 0.0, all.gyro.bias.z), ..spin_axis })
            }
            Self::SpinAxisAndAccels => ImuError { gyro: spin_axis, ..*all },
        }
    }
}

/// The third column of a gyro triad's matrix, without its other elements.
pub(crate) fn spin_axis_part(gyro: &TriadError) -> TriadError {
    spin_axis_error(&gyro.matrix.column(2).into_owned())
}

/// A gyro triad with these `M_xz`, `M_yz` \[rad\] and `S_z`, and no other error.
pub(crate) fn spin_axis_error(column: &Vector3<f64>) -> TriadError {
    let mut matrix = Matrix3::zeros();
    matrix.set_column(2, column);
    TriadError { bias: Vector3::zeros(), matrix }
}

impl Experiment {
    /// The simulation of section 4, with the errors of Tables 1 and 2.
    ///
    /// # Errors
    /// [`ReproductionError`] if the scenario file is invalid.
    pub(crate) fn simulation() -> Result<Self, ReproductionError> {
        let text = include_str!("../../../scenarios/paper/simulation.toml");
        Self::parse("scenarios/paper/simulation.toml", text)
    }

    /// The same with the biases and noises printed in section 4.1.
    ///
    /// # Errors
    /// [`ReproductionError`] if the scenario file is invalid.
    pub(crate) fn section_4_1() -> Result<Self, ReproductionError> {
        let text = include_str!("../../../scenarios/paper/section-4-1.toml");
        Self::parse("scenarios/paper/section-4-1.toml", text)
    }

    /// The experiment of section 5, with the errors of Table 5.
    ///
    /// # Errors
    /// [`ReproductionError`] if the scenario file is invalid.
    pub(crate) fn real_test() -> Result<Self, ReproductionError> {
        let text = include_str!("../../../scenarios/paper/real-test.toml");
        Self::parse("scenarios/paper/real-test.toml", text)
    }

    fn parse(name: &'static str, text: &str) -> Result<Self, ReproductionError> {
        let file = ScenarioFile::parse(text, Path::new(name))?;
        // The filter receives the data that a user's rig file contains.
        let run = simulate(&Scenario { noise: None, ..file.scenario.clone() })?;
        let rig = Rig::parse(&file.rig_toml(&run.recording), Path::new(name))?;
        let attitude = rig.attitude;
        let imu = rig.imu.ok_or(ReproductionError::Missing { name, section: "[imu]" })?;
        let setup = Setup {
            station: file.scenario.station,
            axis: attitude.map(|known| AxisAttitude { angles: known.angles, sigma: known.sigma }),
            // The commanded rate is treated as exact, as in eq. (20).
            table: TableSpec { angle_noise: 0.0, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
            imu,
            velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
        };
        Ok(Self { scenario: file.scenario, setup })
    }

    /// This experiment with a subset of its sensor errors.
    #[must_use]
    pub(crate) fn with(&self, sensors: Sensors) -> Self {
        let imu_error = sensors.of(&self.scenario.imu_error);
        Self { scenario: Scenario { imu_error, ..self.scenario.clone() }, ..self.clone() }
    }

    /// One run of a campaign.
    ///
    /// # Errors
    /// [`ReproductionError::Scenario`] if it cannot be simulated.
    pub(crate) fn run(&self, run: u64) -> Result<Simulated, ReproductionError> {
        let seed = Seed { run, ..self.scenario.seed };
        Ok(simulate(&Scenario { seed, ..self.scenario.clone() })?)
    }
}
