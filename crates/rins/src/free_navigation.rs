//! Free inertial navigation: final errors before and after compensation, and plots over time.

use rins_calibration::{FreeNavigation, NavigationPoint};
use rins_frames::units::DEG;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::values::EulerDegrees;
use rins_report::number::figure;
use rins_report::{Cell, Column, Item, Plot, Section, Series, Style, Table};

/// A reduction of the velocity error by less than this factor counts as no change.
const LEAST_GAIN: f64 = 1.5;

/// What free inertial navigation ends with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NavigationResult {
    /// The velocity error, east, north and up \[m/s\].
    pub velocity_m_s: [f64; 3],
    /// The position error, east, north and up \[m\].
    pub position_error_m: [f64; 3],
    /// The attitude error of the axis frame \[deg\].
    pub attitude_error_deg: EulerDegrees,
}

impl From<&FreeNavigation> for NavigationResult {
    fn from(navigation: &FreeNavigation) -> Self {
        Self {
            velocity_m_s: navigation.velocity.into(),
            position_error_m: navigation.position_error.into(),
            attitude_error_deg: navigation.attitude_error.into(),
        }
    }
}

/// Free inertial navigation as recorded, and with what was estimated compensated; both from the same attitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BeforeAfterResult {
    /// As recorded.
    pub before: NavigationResult,
    /// Compensated.
    pub after: NavigationResult,
}

impl BeforeAfterResult {
    pub(crate) fn of(before: &FreeNavigation, after: &FreeNavigation) -> Self {
        Self { before: before.into(), after: after.into() }
    }
}

/// A free navigation solution with its name.
pub(crate) type Named<'a> = (&'a str, &'a FreeNavigation);

/// The horizontal velocity error over time.
pub(crate) fn velocity_plot(runs: &[Named<'_>]) -> Plot {
    let components: [Component; 2] =
        [("east", |point| point.velocity.x), ("north", |point| point.velocity.y)];
    plot("Velocity error", "Velocity [m/s]", runs, &components)
}

/// The horizontal position error over time.
pub(crate) fn position_plot(runs: &[Named<'_>]) -> Plot {
    let components: [Component; 2] =
        [("east", |point| point.position_error.x), ("north", |point| point.position_error.y)];
    plot("Position error", "Position [m]", runs, &components)
}

/// The attitude error of the axis frame over time.
pub(crate) fn attitude_plot(runs: &[Named<'_>]) -> Plot {
    let components: [Component; 3] = [
        ("roll", |point| point.attitude_error.roll / DEG),
        ("pitch", |point| point.attitude_error.pitch / DEG),
        ("yaw", |point| point.attitude_error.yaw / DEG),
    ];
    plot("Attitude error", "Angle [deg]", runs, &components)
}

type Component = (&'static str, fn(&NavigationPoint) -> f64);

fn plot(title: &str, y_label: &str, runs: &[Named<'_>], components: &[Component]) -> Plot {
    let series = runs
        .iter()
        .enumerate()
        .flat_map(|(place, (name, run))| {
            components.iter().map(move |(component, of)| Series {
                name: format!("{component}, {name}"),
                x: run.history.iter().map(|point| point.time).collect(),
                y: run.history.iter().map(of).collect(),
                style: if place == 0 { Style::Dashed } else { Style::Line },
            })
        })
        .collect();
    Plot {
        title: title.into(),
        x_label: "Time [s]".into(),
        y_label: y_label.into(),
        series,
        ..Plot::default()
    }
}

/// A sentence on the effect of compensation on free navigation.
///
/// `what` names the compensated errors, such as "the gyro errors along the spin axis".
pub(crate) fn gain_sentence(what: &str, before: &FreeNavigation, after: &FreeNavigation) -> String {
    let duration = match (before.history.first(), before.history.last()) {
        (Some(first), Some(last)) => last.time - first.time,
        _ => 0.0,
    };
    let (before, after) = (before.velocity.norm(), after.velocity.norm());
    let navigation =
        format!("the velocity error of this run after {duration:.0} s of free inertial navigation");
    if after * LEAST_GAIN < before {
        // A larger ratio is meaningless, because the remaining error is due to noise.
        let ratio = (before / after.max(1e-9)).min(1e6);
        format!(
            "Compensation of {what} reduces {navigation} from {} m/s to {} m/s, a factor of {} (in the data of the estimate, \
             not an independent test).",
            figure(before, 3),
            figure(after, 3),
            figure(ratio, 2)
        )
    } else if before * LEAST_GAIN < after {
        format!(
            "Compensation increases {navigation} from {} m/s to {} m/s.",
            figure(before, 3),
            figure(after, 3)
        )
    } else {
        format!(
            "Compensation has no effect: {navigation} is {} m/s before and {} m/s after.",
            figure(before, 3),
            figure(after, 3)
        )
    }
}

/// The report section on the effect of compensation on free navigation.
pub(crate) fn navigation_section(
    heading: &str,
    before: &FreeNavigation,
    after: &FreeNavigation,
) -> Section {
    let runs = [("before", before), ("after", after)];
    let rows = runs.map(|(name, run)| {
        let number = |value: f64, decimals| Cell::Number { value, decimals };
        let angles = [run.attitude_error.roll, run.attitude_error.pitch, run.attitude_error.yaw];
        let mut row = vec![Cell::text(name), number(run.velocity.x, 4), number(run.velocity.y, 4)];
        row.extend(angles.map(|angle| number(angle / DEG, 5)));
        row
    });
    Section {
        heading: heading.into(),
        intro: "Free inertial navigation of the run from standstill, with the same initial attitude, with raw and with \
                compensated readings. Reference: zero velocity and a fixed spin axis."
            .into(),
        items: vec![
            Item::Table(Table {
                caption: "Errors at the end of the run".into(),
                columns: ["", "v east [m/s]", "v north [m/s]", "roll [deg]", "pitch [deg]", "yaw [deg]"]
                    .iter()
                    .enumerate()
                    .map(|(place, name)| {
                        if place == 0 { Column::text(*name) } else { Column::number(*name) }
                    })
                    .collect(),
                rows: rows.to_vec(),
            }),
            Item::Plot(velocity_plot(&runs)),
            Item::Plot(attitude_plot(&runs)),
        ],
    }
}
