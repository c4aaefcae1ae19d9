//! All results of the page, computed once.

use nalgebra::{Vector2, Vector3};
use rins_frames::units::{ARCSEC, PPM};
use rins_frames::{Dcm, EulerAngles};
use rins_imu::{ImuError, TriadError};
use rins_simulation::Scenario;

use crate::accelerometers::{ALL, Left, single_errors};
use crate::causes::{Cause, Explanation, Graded, velocity_explanations};
use crate::coverage::{Honesty, Model, Schedule, coverage};
use crate::equations::{
    Check, bounded_term, position_columns, transposed_error, vertical_coupling,
};
use crate::error::ReproductionError;
use crate::experiment::{Experiment, Sensors, spin_axis_error};
use crate::grid::{ATTITUDES, ERRORS, RATES, Row, TIMES, grid, turn};
use crate::monte_carlo::{Campaign, UNITS};
use crate::plain_model::{Choice, velocity};
use crate::printed;
use crate::pure_navigation::{Outcome, PureNavigation};
use crate::readout::{Disagreement, Pair, Turning};
use crate::real_test::{self, Emulated};
use crate::rotation::{AttitudeHistory, histories};
use crate::running::{Followed, followed};

/// The numbers of runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// The runs of each Monte Carlo of section 4.
    pub(crate) runs: u64,
    /// The runs from which the coverage of each filter's intervals is counted.
    pub(crate) honesty_runs: u64,
    /// The duration of those runs \[s\].
    pub(crate) honesty_duration: f64,
    /// The emulated runs of section 5.
    pub(crate) emulated: u64,
    /// The number of runs of section 4 that are processed sample by sample.
    pub(crate) followed: u64,
}

impl Scale {
    /// The scale of the page: the paper's 30 runs, and enough of the others for a coverage within 1 %.
    pub(crate) const FULL: Self =
        Self { runs: 30, honesty_runs: 240, honesty_duration: 72.0, emulated: 200, followed: 200 };

    /// The number of calls of `progress`.
    pub(crate) const fn total(&self) -> u64 {
        3 * self.runs + 6 * self.honesty_runs + self.emulated + self.followed
    }
}

/// A navigation of Table 4's run with a subset of its errors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variant {
    pub(super) name: &'static str,
    pub(super) outcome: Outcome,
}

/// The velocities in Table 4 or its text, and their possible causes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct VelocityCase {
    /// Printed minus model \[m/s\].
    pub(super) misfit: [f64; 2],
    pub(super) explanations: Vec<Explanation>,
    /// The minimum difference of the model's velocity history from the printed one: time \[s\], difference \[m/s\].
    pub(super) nearest: (f64, f64),
}

/// The read-out lag, for one set of errors and compensation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LagCase {
    pub(super) name: &'static str,
    pub(super) none: Disagreement,
    pub(super) half_sample: Disagreement,
    pub(super) fitted: Disagreement,
    /// The rotation from the model's attitude to the printed one, before and after, in the axis frame \[deg\].
    pub(super) rotations: [Vector3<f64>; 2],
}

/// All results of the page.
#[derive(Clone, Debug)]
pub(crate) struct Results {
    pub(super) scale: Scale,
    pub(super) simulation: Experiment,
    pub(super) real_test: Experiment,
    /// Runs of the simulation with the biases of Table 2, processed sample by sample.
    pub(super) followed: Vec<Followed>,
    /// The attitude errors of the simulation's IMU, static and rotating.
    pub(super) histories: Vec<AttitudeHistory>,
    /// The effects of Table 1's errors after ten turns about Table 4's axis, and about a vertical one.
    pub(super) accelerometers: [Vec<Left>; 2],
    pub(super) with_bias: Campaign,
    pub(super) without_bias: Campaign,
    pub(super) section_4_1: Campaign,
    pub(super) honesty: Vec<(Model, Schedule, Honesty)>,
    pub(super) variants: Vec<Variant>,
    pub(super) after_variants: Vec<Variant>,
    pub(super) swapped: Outcome,
    pub(super) lags: Vec<LagCase>,
    /// The effect of an initial attitude that is 1 ms too old on the final velocity \[m/s\].
    pub(super) start_lag: [f64; 2],
    /// The velocity by the independent model, for each choice.
    pub(super) plain: Vec<(Choice, Vector2<f64>)>,
    /// Before compensation, after it by the table, after it by the text.
    pub(super) velocities: [VelocityCase; 3],
    pub(super) predicted: Outcome,
    pub(super) emulated: Vec<Emulated>,
    pub(super) causes_after: Vec<Graded>,
    pub(super) causes_between: Vec<Graded>,
    pub(super) grid: Vec<Row>,
    pub(super) bounded_term: Check,
    pub(super) vertical_coupling: Check,
    pub(super) transposed_error: Check,
    pub(super) position_columns: Check,
}

impl Results {
    /// Runs all experiments; `progress` is called after each run, from any thread.
    ///
    /// # Errors
    /// [`ReproductionError`] of the first failure.
    pub(crate) fn compute(
        scale: Scale,
        progress: impl Fn() + Sync,
    ) -> Result<Self, ReproductionError> {
        let simulation = Experiment::simulation()?;
        let without = simulation.with(Sensors::WithoutGyroBias);
        let variant = Experiment::section_4_1()?;
        let real_test = Experiment::real_test()?;
        let mut honesty = Vec::new();
        for schedule in [Schedule::ConstantRate, Schedule::TwoRates, Schedule::Reversal] {
            for model in [Model::Paper, Model::WithGyroBias] {
                let Scale { honesty_runs, honesty_duration, .. } = scale;
                let of = coverage(
                    &simulation,
                    model,
                    schedule,
                    (honesty_runs, honesty_duration),
                    &progress,
                )?;
                honesty.push((model, schedule, of));
            }
        }
        Ok(Self {
            scale,
            with_bias: Campaign::of(&simulation, scale.runs, &progress)?,
            without_bias: Campaign::of(&without, scale.runs, &progress)?,
            section_4_1: Campaign::of(&variant, scale.runs, &progress)?,
            honesty,
            variants: variants(&simulation)?,
            after_variants: after_variants(&simulation)?,
            swapped: swapped(&simulation)?,
            lags: lags(&simulation)?,
            start_lag: {
                let effect = Cause::StartLag.effect(&noiseless(&simulation, Sensors::Gyros))?;
                [effect[0], effect[1]]
            },
            plain: plain(),
            velocities: velocities(&simulation)?,
            predicted: real_test::predicted(&real_test)?,
            emulated: real_test::emulate(&real_test, scale.emulated, &progress)?,
            causes_after: real_test::causes_after(&real_test)?,
            causes_between: real_test::causes_between(&real_test)?,
            grid: grid(&TIMES, &ATTITUDES, &RATES)?,
            bounded_term: bounded_term(),
            vertical_coupling: vertical_coupling(),
            transposed_error: transposed_error(),
            position_columns: position_columns(),
            followed: followed(&simulation, scale.followed, &progress)?,
            histories: histories(&simulation)?,
            accelerometers: accelerometers(&simulation)?,
            simulation,
            real_test,
        })
    }
}

/// The sensor errors with these `M_xz`, `M_yz` \[arcsec\] and `S_z` \[ppm\].
pub(super) fn spin_axis(parameters: [f64; 3]) -> ImuError {
    let [m_xz, m_yz, s_z] = parameters;
    let column = Vector3::new(m_xz * ARCSEC, m_yz * ARCSEC, s_z * PPM);
    ImuError { gyro: spin_axis_error(&column), accel: TriadError::default() }
}

/// The effects of Table 1's errors after ten turns, at Table 4's attitude and with a vertical axis.
fn accelerometers(simulation: &Experiment) -> Result<[Vec<Left>; 2], ReproductionError> {
    let all = simulation.scenario.imu_error.accel;
    let of = |attitude| {
        let together = std::iter::once((ALL.to_owned(), all));
        together
            .chain(single_errors(&all))
            .map(|(name, error)| Left::of(&name, &error, attitude, RATES[0]))
            .collect::<Result<Vec<Left>, ReproductionError>>()
    };
    Ok([of(ATTITUDES[0])?, of(ATTITUDES[2])?])
}

/// The observable combinations of `M_xz`, `M_yz` \[arcsec\] and `S_z` \[ppm\] at one constant rate: each with its bias divided by
/// the rate about the spin axis.
pub(super) fn observed(simulation: &Experiment) -> [f64; 3] {
    let Scenario { station, nav_from_table, profile, imu_error, .. } = &simulation.scenario;
    let earth = nav_from_table.inverse() * station.site.earth_rate();
    let rate = profile.rate(0.0) + earth.components().z;
    std::array::from_fn(|row| {
        (imu_error.gyro.matrix[(row, 2)] + imu_error.gyro.bias[row] / rate) / UNITS[row]
    })
}

/// The velocities of Table 4's three spin-axis errors, by every choice.
fn plain() -> Vec<(Choice, Vector2<f64>)> {
    let table_4 = turn(ATTITUDES[0], RATES[0]);
    let choices = std::iter::once(Choice::Ellipsoid).chain(Choice::OTHERS);
    choices.map(|choice| (choice, velocity(&table_4, &ERRORS, choice, 360.0))).collect()
}

fn noiseless(experiment: &Experiment, sensors: Sensors) -> PureNavigation {
    PureNavigation::of(&experiment.with(sensors).scenario).noiseless()
}

fn variants(simulation: &Experiment) -> Result<Vec<Variant>, ReproductionError> {
    [
        ("the three along the spin axis", Sensors::SpinAxis),
        ("and a z gyro bias", Sensors::SpinAxisAndBiasZ),
        ("all gyro errors of Table 2", Sensors::Gyros),
        ("the three, and all of Table 1", Sensors::SpinAxisAndAccels),
        ("all of Tables 1 and 2", Sensors::All),
    ]
    .into_iter()
    .map(|(name, sensors)| Ok(Variant { name, outcome: noiseless(simulation, sensors).outcome()? }))
    .collect()
}

/// The remaining effect of some errors after the paper's compensation and after a full one.
fn after_variants(simulation: &Experiment) -> Result<Vec<Variant>, ReproductionError> {
    let table_3 = spin_axis(printed::TABLE_3);
    // M + B/w, the observable combination.
    let observed = spin_axis(observed(simulation));
    // A compensation that multiplies the measured rate removes M / (1 + S).
    let scale = 1.0 + printed::TABLE_3[2] * PPM;
    let measured_rate = spin_axis(printed::TABLE_3.map(|parameter| parameter * scale));
    [
        ("gyro errors, Table 3 compensated", Sensors::Gyros, table_3),
        ("the same, multiplying the measured rate", Sensors::Gyros, measured_rate),
        ("gyro errors, what the filter sees compensated", Sensors::Gyros, observed),
        ("gyro errors without bias, Table 3 compensated", Sensors::SpinAxis, table_3),
        ("all errors, Table 3 compensated", Sensors::All, table_3),
        ("all errors, what the filter sees compensated", Sensors::All, observed),
    ]
    .into_iter()
    .map(|(name, sensors, errors)| {
        let navigation = noiseless(simulation, sensors).compensating(errors);
        Ok(Variant { name, outcome: navigation.outcome()? })
    })
    .collect()
}

/// The spin-axis errors with roll and pitch as printed in section 4.1.
fn swapped(simulation: &Experiment) -> Result<Outcome, ReproductionError> {
    let scenario = &simulation.with(Sensors::SpinAxis).scenario;
    let EulerAngles { roll, pitch, yaw } = scenario.nav_from_table.euler_angles();
    let nav_from_table: Dcm<_, _> = EulerAngles { roll: pitch, pitch: roll, yaw }.dcm();
    PureNavigation::of(&Scenario { nav_from_table, ..scenario.clone() }).noiseless().outcome()
}

fn lags(simulation: &Experiment) -> Result<Vec<LagCase>, ReproductionError> {
    let scenario = &simulation.scenario;
    let turning = Turning {
        reference: scenario.nav_from_table.euler_angles(),
        rate: scenario.profile.rate(0.0),
    };
    let observed = observed(simulation);
    [
        ("all gyro errors; Table 3 compensated", Sensors::Gyros, printed::TABLE_3, false),
        ("all gyro errors; what the filter sees compensated", Sensors::Gyros, observed, false),
        ("without gyro bias; Table 3 compensated", Sensors::SpinAxis, printed::TABLE_3, false),
        ("all gyro errors; the text's figures after", Sensors::Gyros, printed::TABLE_3, true),
    ]
    .into_iter()
    .map(|(name, sensors, compensated, text)| {
        let navigation = noiseless(simulation, sensors);
        let after = if text { printed::TEXT_4_AFTER } else { printed::TABLE_4_AFTER };
        let pairs = [
            Pair { model: navigation.outcome()?, printed: printed::TABLE_4_BEFORE.attitude_error },
            Pair {
                model: navigation.compensating(spin_axis(compensated)).outcome()?,
                printed: after.attitude_error,
            },
        ];
        Ok(LagCase {
            name,
            none: Disagreement::of(&pairs, &turning, 0.0),
            half_sample: Disagreement::of(&pairs, &turning, 0.5 * scenario.interval),
            fitted: Disagreement::least(&pairs, &turning),
            rotations: pairs.map(|pair| pair.rotation(&turning.reference)),
        })
    })
    .collect()
}

fn velocities(simulation: &Experiment) -> Result<[VelocityCase; 3], ReproductionError> {
    let before = noiseless(simulation, Sensors::Gyros);
    let after = before.clone().compensating(spin_axis(printed::TABLE_3));
    let case = |base: &PureNavigation, printed: &printed::Navigation| {
        let way = base.navigate()?;
        let model = [way.velocity.x, way.velocity.y];
        let nearest = way
            .history
            .iter()
            .map(|point| {
                let [east, north] = printed.velocity;
                (point.time, (point.velocity.x - east).hypot(point.velocity.y - north))
            })
            .fold((0.0, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best });
        let misfit = [printed.velocity[0] - model[0], printed.velocity[1] - model[1]];
        let explanations = velocity_explanations(&Cause::OF_VELOCITY, base, misfit)?;
        Ok::<_, ReproductionError>(VelocityCase { misfit, explanations, nearest })
    };
    Ok([
        case(&before, &printed::TABLE_4_BEFORE)?,
        case(&after, &printed::TABLE_4_AFTER)?,
        case(&after, &printed::TEXT_4_AFTER)?,
    ])
}
