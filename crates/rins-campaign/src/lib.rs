//! Monte Carlo campaigns: scenarios of a calibration, run thousands of times.
//!
//! **What it does.** A [`Campaign`] is a list of [`Cell`]s - a scenario with the setup of the filter - and
//! a number of runs of each, whose noise follows from the scenario's seed and the index of the run. Runs are computed
//! in [chunks](Campaign::chunks), by any thread in any order, and in SIMD lanes if
//! the scenario allows it. [`Statistics`] state whether the covariances agree with the errors.
//!
//! A [`PosteriorTally`] does the same for the posterior of any model, with true values that differ from run to run: bias, error over sigma,
//! coverage, NEES and simulation-based calibration, of each parameter and of the well-determined [`Combinations`].
//!
//! **What it does not do.** It reads and writes no files. A run's result does not depend on the others,
//! on threads, lanes or the machine.
//!
//! ```
//! use rins_calibration::{AxisAttitude, Setup, TableSpec};
//! use rins_campaign::{Campaign, Cell, Statistics};
//! # use rins_frames::units::{DEG, DEG_PER_HOUR, DEG_PER_SECOND, PPM};
//! # use rins_frames::{EulerAngles, Site};
//! # use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, TriadError, TriadSpec};
//! # use rins_motion::{Profile, Segment, Station};
//! # use rins_simulation::{Scenario, TableRecord};
//! # let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
//! # let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
//! # let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 36.0 };
//! # let station = Station::with_normal_gravity(site);
//! # let triad = |noise_density| TriadSpec::white(noise_density, 0.0, 500.0 * PPM, 6e-4);
//! # let imu = ImuSpec { gyro: triad(0.02 * DEG_PER_HOUR), accel: triad(3e-4) };
//! # let noise = ImuNoise { gyro: NoiseModel::from(&imu.gyro), accel: NoiseModel::from(&imu.accel) };
//! # let gyro = TriadError::default().with_scale(Axis::Z, 300.0 * PPM);
//! # let scenario = Scenario {
//! #     imu_error: ImuError { gyro, ..ImuError::default() },
//! #     noise: Some(noise),
//! #     table: TableRecord::CommandedRate,
//! #     ..Scenario::perfect(station, angles.dcm(), Profile::new(&[turn], None)?, 0.02)
//! # };
//! # let setup = Setup {
//! #     station,
//! #     axis: Some(AxisAttitude { angles, sigma: 0.01 * DEG }),
//! #     table: TableSpec { angle_noise: 0.0, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
//! #     imu,
//! #     velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
//! # };
//! let campaign = Campaign { cells: vec![Cell { scenario, setup }], runs: 100 };
//! let prepared = campaign.cells[0].prepare()?;
//! let runs: Vec<_> = campaign.chunks().flat_map(|chunk| prepared.run(chunk.runs)).collect();
//! let statistics = Statistics::of(&campaign.cells[0].truth(), &runs).unwrap();
//! let scale = &statistics.parameters[2];
//! assert!((scale.mean_error / scale.spread).abs() < 0.5); // 5 sigma of the mean
//! assert!((0.7..1.3).contains(&(scale.spread / scale.claimed)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
mod campaign;
mod cell;
mod lanes;
mod sbc;
mod statistics;

pub use campaign::{Campaign, Chunk, chunks};
pub use cell::{Cell, CellError, PARAMETERS, Prepared, RunFailure, RunResult};
pub use sbc::{
    COVERAGES, Combinations, Coverage, DETERMINED, EcdfBand, Nees, POINTS, PosteriorRun,
    PosteriorStatistics, PosteriorTally, QuantityStatistics, clopper_pearson,
};
pub use statistics::{Honesty, Statistics, Tally};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
