//! Unaided inertial navigation over a scenario, and its final errors.

use nalgebra::{SVector, Vector3};
use rins_calibration::{FreeNavigation, navigate_freely};
use rins_frames::{Dcm, EulerAngles, Nav, Table, units::DEG};
use rins_imu::ImuError;
use rins_simulation::{Scenario, Simulated, simulate};

use crate::error::ReproductionError;

/// The final errors of a navigation on a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    /// Velocity east and north \[m/s\].
    pub(crate) velocity: [f64; 2],
    /// Roll, pitch and yaw of the axis frame \[rad\].
    pub(crate) attitude: EulerAngles,
}

impl Outcome {
    /// East, north \[m/s\], roll, pitch, yaw \[deg\]: in the paper's units, for comparison with it.
    pub(crate) fn figures(&self) -> [f64; 5] {
        let ([east, north], EulerAngles { roll, pitch, yaw }) = (self.velocity, self.attitude);
        [east, north, roll / DEG, pitch / DEG, yaw / DEG]
    }

    /// The same as a vector.
    pub(crate) fn vector(&self) -> SVector<f64, 5> {
        SVector::from(self.figures())
    }

    /// The same outcome with an attitude that is read out `lag` \[s\] too early, on a table that rotates at
    /// `rate` \[rad/s\], and compared with the reference at the end.
    ///
    /// `reference` is the true attitude of the axis frame.
    #[must_use]
    pub(crate) fn read_out_late(&self, reference: &EulerAngles, rate: f64, lag: f64) -> Self {
        let EulerAngles { roll, pitch, yaw } = self.attitude;
        let computed = EulerAngles {
            roll: reference.roll + roll,
            pitch: reference.pitch + pitch,
            yaw: reference.yaw + yaw,
        };
        let lagging = computed.dcm::<Nav, Table>() * Dcm::<Table, Table>::about_z(-rate * lag);
        let read = lagging.euler_angles();
        let attitude = EulerAngles {
            roll: read.roll - reference.roll,
            pitch: read.pitch - reference.pitch,
            yaw: read.yaw - reference.yaw,
        };
        Self { attitude, ..*self }
    }
}

impl From<&FreeNavigation> for Outcome {
    fn from(end: &FreeNavigation) -> Self {
        Self { velocity: [end.velocity.x, end.velocity.y], attitude: end.attitude_error }
    }
}

/// A navigation on a table: the data, the compensated errors, and the initial conditions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PureNavigation {
    /// The data.
    pub(crate) scenario: Scenario,
    /// The sensor errors that are compensated.
    pub(crate) compensated: ImuError,
    /// The initial attitude error, `φ(0)` of `C~ = (I - φ×) C`, in n \[rad\].
    pub(crate) start_error: Vector3<f64>,
    /// The reference of the final attitude.
    pub(crate) reference: Reference,
}

/// The reference of an attitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reference {
    /// The true attitude of the axis frame.
    Truth,
    /// The initial attitude of the navigation, if the truth is not known.
    Start,
}

impl PureNavigation {
    /// A navigation of raw data with exact initial conditions.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        Self {
            scenario: scenario.clone(),
            compensated: ImuError::default(),
            start_error: Vector3::zeros(),
            reference: Reference::Truth,
        }
    }

    /// The same with noise-free data.
    #[must_use]
    pub(crate) fn noiseless(mut self) -> Self {
        self.scenario.noise = None;
        self
    }

    /// The same with these errors compensated.
    #[must_use]
    pub(crate) fn compensating(mut self, errors: ImuError) -> Self {
        self.compensated = errors;
        self
    }

    /// The history of the navigation, and its end.
    ///
    /// # Errors
    /// [`ReproductionError`] if the data cannot be simulated or the errors cannot be compensated.
    pub(crate) fn navigate(&self) -> Result<FreeNavigation, ReproductionError> {
        let Simulated { recording, truth } = simulate(&self.scenario)?;
        let angles: Vec<f64> = std::iter::once(0.0).chain(truth.table_angle).collect();
        let compensation = self.compensated.compensation()?;
        let start = Dcm::<Nav, Nav>::from_rotation_vector(&-self.start_error)
            * self.scenario.nav_from_table;
        let mut end = navigate_freely(
            &recording,
            &angles,
            start,
            &self.scenario.station,
            Some(&compensation),
        );
        if self.reference == Reference::Truth {
            // The result refers to the initial attitude.
            let (begun, truth) =
                (start.euler_angles(), self.scenario.nav_from_table.euler_angles());
            let from_truth = |error: &mut EulerAngles| {
                error.roll += begun.roll - truth.roll;
                error.pitch += begun.pitch - truth.pitch;
                error.yaw += begun.yaw - truth.yaw;
            };
            from_truth(&mut end.attitude_error);
            end.history.iter_mut().for_each(|point| from_truth(&mut point.attitude_error));
        }
        Ok(end)
    }

    /// The final errors.
    ///
    /// # Errors
    /// As for [`PureNavigation::navigate`].
    pub(crate) fn outcome(&self) -> Result<Outcome, ReproductionError> {
        Ok(Outcome::from(&self.navigate()?))
    }
}
