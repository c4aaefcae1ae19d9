//! Planned runs of one IMU, without errors and without noise.

use rins_calibration::Setup;
use rins_estimation::{Noise, Reference, Rig, Run};
use rins_frames::{Dcm, Nav, SignedAxes, Table};
use rins_imu::ImuSpec;
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};

use crate::error::DesignError;

/// The longest sampling interval of a plan \[s\]: information on the parameters is contained in densities, which longer intervals
/// do not change.
const COARSEST: f64 = 0.05;

/// The largest rotation of the table in such an interval \[rad\].
const COARSEST_TURN: f64 = 0.02;

/// A planned run: a scenario of which neither errors nor noise are used.
#[derive(Clone, Debug)]
pub struct Planned {
    /// Its name.
    pub name: String,
    /// The data sheet of the IMU.
    pub imu: ImuSpec,
    /// The angular acceleration of the table, if stated \[rad/s²\].
    pub acceleration: Option<f64>,
    /// In the axes of the run, whose z is the spin axis.
    scenario: Scenario,
    axes: SignedAxes,
    noise: f64,
    wobble: f64,
    turn_on: Option<usize>,
}

impl Planned {
    /// The plan of a scenario with this table: the 1σ of a reading of its angle and that of its axis' direction \[rad\], and
    /// its angular acceleration, if stated \[rad/s²\].
    pub fn new(
        name: String,
        scenario: Scenario,
        imu: ImuSpec,
        (noise, wobble, acceleration): (f64, f64, Option<f64>),
    ) -> Self {
        let mut scenario = scenario.without_errors();
        if let TableRecord::Angle(encoder) = &mut scenario.table {
            *encoder = Encoder::default();
        }
        let axes = SignedAxes::IDENTITY;
        Self { name, imu, acceleration, scenario, axes, noise, wobble, turn_on: None }
    }

    /// A plan with the site, attitude, duration and rate of a measured run, along the axes of that run.
    ///
    /// Where that was sampled more finely than the plan needs, several samples are one, with the noise of their mean.
    ///
    /// # Errors
    /// [`DesignError::Profile`] if the duration of the run is zero.
    pub fn like(run: &Run, noise: &Noise, imu: ImuSpec) -> Result<Self, DesignError> {
        let times = &run.recording.times;
        let duration = times[times.len() - 1] - times[0];
        let interval = duration / (times.len() - 1) as f64;
        let rates = run.recording.increments.iter().map(|sample| sample.rates().angular_rate);
        let rate = rates.map(|rate| rate.components().z.abs()).fold(0.0, f64::max);
        let within = COARSEST.min(COARSEST_TURN / rate);
        let samples = (within / interval).floor().max(1.0);
        let segment = Segment { rate, duration };
        Ok(Self {
            name: "the next run".into(),
            imu,
            acceleration: None,
            scenario: Scenario::perfect(
                run.rig.station,
                run.rig.nav_from_table,
                Profile::new(&[segment], None)?,
                samples * interval,
            ),
            axes: SignedAxes::IDENTITY,
            noise: noise.encoder / samples.sqrt(),
            wobble: noise.wobble / samples.sqrt(),
            turn_on: run.turn_on,
        })
    }

    /// The same with another motion and another attitude of the axis.
    #[must_use]
    pub fn moved(&self, profile: Profile, nav_from_table: Dcm<Nav, Table>) -> Self {
        let scenario = Scenario { profile, nav_from_table, ..self.scenario.clone() };
        Self { scenario, ..self.clone() }
    }

    /// The same with the IMU mounted otherwise: axis `i` of the run, whose z is the spin axis, is `sign[i]` times the sensors' own axis
    /// `source[i]`.
    #[must_use]
    pub fn with_axes(mut self, axes: SignedAxes) -> Self {
        self.axes = axes;
        self
    }

    /// The same as part of one power-on: all runs of the same `turn_on` have the same turn-on biases.
    #[must_use]
    pub fn since(mut self, turn_on: usize) -> Self {
        self.turn_on = Some(turn_on);
        self
    }

    /// The same with the longest sampling interval that the information allows: several samples are one, with the noise of their mean.
    #[must_use]
    pub(crate) fn sampled_coarsely(mut self) -> Self {
        let within = COARSEST.min(COARSEST_TURN / self.fastest());
        let samples = (within / self.scenario.interval).floor().max(1.0);
        self.scenario.interval *= samples;
        self.noise /= samples.sqrt();
        self.wobble /= samples.sqrt();
        self
    }

    /// The site.
    pub fn station(&self) -> Station {
        self.scenario.station
    }

    /// The table angle at the end of each of the segments that its motion consists of \[rad\].
    pub fn angles(&self, segments: &[Segment]) -> Vec<f64> {
        let mut end = 0.0;
        let at = |segment: &Segment| {
            end += segment.duration;
            self.scenario.profile.angle(end)
        };
        segments.iter().map(at).collect()
    }

    /// The attitude of the axis frame.
    pub fn nav_from_table(&self) -> Dcm<Nav, Table> {
        self.scenario.nav_from_table
    }

    /// The axes of the run relative to the sensors' own.
    pub fn axes(&self) -> SignedAxes {
        self.axes
    }

    /// The duration \[s\].
    pub fn duration(&self) -> f64 {
        self.scenario.profile.duration()
    }

    /// The time constant with which the readings of the table angle settle beside the angle noise of the gyro \[s\]: the density of the
    /// readings over that of the gyro.
    pub(crate) fn time_constant(&self) -> f64 {
        self.noise * self.scenario.interval.sqrt() / self.imu.gyro.noise_density
    }

    /// Whether the log holds an angle reference at every tilt of the axis.
    pub(crate) fn has_table_reading(&self) -> bool {
        !matches!(self.scenario.table, TableRecord::Nothing)
    }

    /// The largest rate of the table \[rad/s\].
    pub fn fastest(&self) -> f64 {
        let steps = 1000;
        let times = (0..steps).map(|step| self.duration() * f64::from(step) / f64::from(steps));
        times.map(|time| self.scenario.profile.rate(time).abs()).fold(0.0, f64::max)
    }

    /// The simulated run.
    pub(crate) fn run(&self) -> Result<Run, DesignError> {
        let scenario = &self.scenario;
        let recording = simulate(scenario)
            .map_err(|source| DesignError::Scenario { name: self.name.clone(), source })?
            .recording;
        let up = scenario.nav_from_table.matrix()[(2, 2)];
        let reference = match scenario.table {
            TableRecord::Angle(_) => Reference::Encoder { noise: self.noise },
            TableRecord::CommandedRate => Reference::Command { noise: 0.0 },
            TableRecord::Nothing if self.fastest() == 0.0 => Reference::Rest,
            TableRecord::Nothing => {
                if up.abs() >= 0.9998 {
                    return Err(DesignError::NoAngleReference { name: self.name.clone() });
                }
                Reference::Gravity
            }
        };
        let rig = Rig {
            station: scenario.station,
            nav_from_table: scenario.nav_from_table,
            reference,
            wobble: self.wobble,
            velocity: Setup::FIXED_TABLE_VELOCITY_NOISE,
        };
        let run = Run::new(rig, recording)
            .map_err(|source| DesignError::Run { name: self.name.clone(), source })?
            .with_axes(self.axes);
        Ok(match self.turn_on {
            Some(turn_on) => run.since(turn_on),
            None => run,
        })
    }
}
