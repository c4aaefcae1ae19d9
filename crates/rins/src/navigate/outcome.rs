//! Free navigation as text, result and page.

use std::fmt;

use rins_calibration::FreeNavigation;
use rins_frames::units::DEG;
use rins_io::shown;
use rins_report::{Item, Report, Section};

use super::Navigation;
use super::free::has_table;
use super::result::NavigateResult;
use crate::basis::BasisResult;
use crate::free_navigation::{attitude_plot, position_plot, velocity_plot};
use crate::log::{site_assumption, with_repairs};
use crate::outcome::Outcome;
use crate::table::{aligned, report_table};

impl Navigation<'_> {
    fn title(&self) -> String {
        format!("Free inertial navigation of {}", self.log.name)
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let mut rows = vec![
            [
                "",
                "v east [m/s]",
                "v north [m/s]",
                "position [m]",
                "roll [deg]",
                "pitch [deg]",
                "yaw [deg]",
            ]
            .map(String::from)
            .to_vec(),
        ];
        rows.extend(self.runs.iter().map(|(name, run)| {
            let error = &run.attitude_error;
            let mut row = vec![
                (*name).to_owned(),
                format!("{:.4}", run.velocity.x),
                format!("{:.4}", run.velocity.y),
                format!("{:.2}", run.position_error.norm()),
            ];
            let angles = [error.roll, error.pitch, error.yaw];
            row.extend(angles.map(|angle| format!("{:.5}", angle / DEG)));
            row
        }));
        rows
    }

    fn summary(&self) -> Vec<String> {
        std::iter::once(format!(
            "From {}, over {:.0} s with the vertical channel held:",
            self.start.source,
            self.start.duration()
        ))
        .chain(self.runs.iter().map(|(name, run)| {
            format!(
                "{name}: velocity error {:.3} m/s and position error {:.1} m at the end.",
                run.velocity.norm(),
                run.position_error.norm()
            )
        }))
        .chain(self.beyond.notes.iter().cloned())
        .collect()
    }
}

impl fmt::Display for Navigation<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title())?;
        for sentence in self.summary() {
            writeln!(f, "  {sentence}")?;
        }
        let table = format!("\n{}", aligned(&self.rows()));
        f.write_str(&with_repairs(table, &self.log.repairs()))
    }
}

impl Outcome for Navigation<'_> {
    type Result = NavigateResult;

    fn result(&self) -> NavigateResult {
        NavigateResult::of(self)
    }

    fn basis(&self) -> BasisResult {
        let basis = BasisResult::of_log(self.log);
        basis.assuming(site_assumption(&self.log.loaded.rig)).with_files(self.calibration.clone())
    }

    fn report(&self) -> Option<Report> {
        let intro = if has_table(&self.start.recording) {
            "The truth is a base that does not move; the attitude is that of the axis frame."
        } else {
            "The truth is a base that stays in its place. Attitude errors are relative to the attitude at the start, and hold \
             the sway of the base."
        };
        let named: Vec<(&str, &FreeNavigation)> =
            self.runs.iter().map(|(name, run)| (*name, run)).collect();
        let mut summary = self.summary();
        summary.extend(self.log.repairs());
        Some(Report {
            title: self.title(),
            subtitle: format!("rins navigate: {}", shown(&self.log.loaded.rig.log.path)),
            summary,
            sections: vec![Section {
                heading: "Errors".into(),
                intro: intro.into(),
                items: vec![
                    Item::Table(report_table(&self.rows())),
                    Item::Plot(velocity_plot(&named)),
                    Item::Plot(position_plot(&named)),
                    Item::Plot(attitude_plot(&named)),
                ],
            }],
        })
    }
}
