//! Everything that the page tells, computed once.

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

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// The runs of each Monte Carlo of section 4.
    pub(crate) runs: u64,
    /// The runs in which each filter's intervals are counted.
    pub(crate) honesty_runs: u64,
    /// How long those are \[s\].
    pub(crate) honesty_duration: f64,
    /// The emulated runs of section 5.
    pub(crate) emulated: u64,
    /// The runs of section 4 that are followed sample by sample.
    pub(crate) followed: u64,
}

impl Scale {
    /// What the page is made of: the paper's 30 runs, and enough of the rest for 1 % of coverage.
    pub(crate) const FULL: Self =
        Self { runs: 30, honesty_runs: 240, honesty_duration: 72.0, emulated: 200, followed: 200 };

    /// How often `progress` is told of a run.
    pub(crate) const fn total(&self) -> u64 {
        3 * self.runs + 6 * self.honesty_runs + self.emulated + self.followed
    }
}

/// A navigation of Table 4's run with some of its errors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variant {
    pub(super) name: &'static str,
    pub(super) outcome: Outcome,
}

/// The velocities that Table 4 or its text prints, and what might have made them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct VelocityCase {
    /// Printed less model \[m/s\].
    pub(super) misfit: [f64; 2],
    pub(super) explanations: Vec<Explanation>,
    /// Where on the way the model's velocity comes nearest to the printed one: time \[s\], distance \[m/s\].
    pub(super) nearest: (f64, f64),
}

/// The read-out lag, for one set of errors and compensation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LagCase {
    pub(super) name: &'static str,
    pub(super) none: Disagreement,
    pub(super) half_sample: Disagreement,
    pub(super) fitted: Disagreement,
    /// From the model's attitude to the printed one, before and after, in the axis frame \[deg\].
    pub(super) rotations: [Vector3<f64>; 2],
}

/// Everything that the page tells.
#[derive(Clone, Debug)]
pub(crate) struct Results {
    pub(super) scale: Scale,
    pub(super) simulation: Experiment,
    pub(super) real_test: Experiment,
    /// Runs of the simulation with the biases of Table 2, followed sample by sample.
    pub(super) followed: Vec<Followed>,
    /// The attitude errors of the simulation's IMU, static and rotating.
    pub(super) histories: Vec<AttitudeHistory>,
    /// What ten turns leave of Table 1's errors on Table 4's axis, and on a level one.
    pub(super) accelerometers: [Vec<Left>; 2],
    pub(super) with_bias: Campaign,
    pub(super) without_bias: Campaign,
    pub(super) section_4_1: Campaign,
    pub(super) honesty: Vec<(Model, Schedule, Honesty)>,
    pub(super) variants: Vec<Variant>,
    pub(super) after_variants: Vec<Variant>,
    pub(super) swapped: Outcome,
    pub(super) lags: Vec<LagCase>,
    /// What a start attitude 1 ms too old does to the velocity at the end \[m/s\].
    pub(super) start_lag: [f64; 2],
    /// The velocity by the model written apart, for each choice.
    pub(super) plain: Vec<(Choice, Vector2<f64>)>,
    /// Before, after by the table, after by the text.
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
    /// Runs everything; `progress` is told of each run that is done, from any thread.
    ///
    /// # Errors
    /// [`ReproductionError`] of the first thing that fails.
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

/// The sensor errors that a set of `M_xz`, `M_yz` \[arcsec\] and `S_z` \[ppm\] stands for.
pub(super) fn spin_axis(parameters: [f64; 3]) -> ImuError {
    let [m_xz, m_yz, s_z] = parameters;
    let column = Vector3::new(m_xz * ARCSEC, m_yz * ARCSEC, s_z * PPM);
    ImuError { gyro: spin_axis_error(&column), accel: TriadError::default() }
}

/// What ten turns leave of Table 1's errors at Table 4's attitude and on a level axis.
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

/// What one constant rate shows of `M_xz`, `M_yz` \[arcsec\] and `S_z` \[ppm\]: each with its bias over
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

/// What the paper's compensation, and a full one, leave of some errors.
fn after_variants(simulation: &Experiment) -> Result<Vec<Variant>, ReproductionError> {
    let table_3 = spin_axis(printed::TABLE_3);
    // M + B/w, which is what the data show.
    let observed = spin_axis(observed(simulation));
    // A compensation that multiplies the measured rate takes out M / (1 + S).
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

/// The spin-axis errors with roll and pitch as section 4.1 prints them.
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
