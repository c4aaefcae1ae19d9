//! Plots of free inertial navigation.

use rins_calibration::{FreeNavigation, NavigationPoint};
use rins_frames::units::DEG;

use crate::report::{Plot, Series, Style};

/// A run of free navigation and what it is called.
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
