//! A designed schedule as a report page.

use rins_report::{Item, Plot, Report, Section, Series, Style};

use super::notes::notes;
use super::result::{DesignedRunResult, MotionResult};
use super::study::DesignStudy;
use super::words::{comparison, observability, schedule_rows, summary, title};
use crate::table::captioned;

pub(super) fn report(study: &DesignStudy) -> Report {
    let runs: Vec<DesignedRunResult> =
        study.optimal.runs.iter().map(DesignedRunResult::of).collect();
    let mut schedule = vec![Item::Table(captioned("Segments", &schedule_rows(study)))];
    schedule.extend([Item::Plot(rates(&runs)), Item::Plot(shares(&runs))]);
    let sections = vec![
        Section {
            heading: "Schedule".into(),
            intro: "A segment begins with the ramp from the rate before it.".into(),
            items: schedule,
        },
        Section {
            heading: "Side by side".into(),
            intro: "1σ of each parameter with the data sheet as prior; a star marks what is not observable by itself.".into(),
            items: vec![Item::Table(captioned("Schedules", &comparison(study)))],
        },
        Section {
            heading: "Observability".into(),
            intro: String::new(),
            items: observability(study).into_iter().map(Item::Text).collect(),
        },
        Section {
            heading: "Remarks".into(),
            intro: String::new(),
            items: notes(study).into_iter().map(Item::Text).collect(),
        },
    ];
    Report {
        title: title(study),
        subtitle: "rins design".into(),
        summary: summary(study),
        sections,
    }
}

fn run_name(place: usize, run: &DesignedRunResult) -> String {
    format!("run {}, about {}, tilt {:.1} deg", place + 1, run.spin, run.tilt_deg)
}

/// The rate over time.
fn rates(runs: &[DesignedRunResult]) -> Plot {
    let series = runs.iter().enumerate().map(|(place, run)| {
        let mut series =
            Series { name: run_name(place, run), style: Style::Steps, ..Series::default() };
        for segment in &run.profile {
            series.x.push(segment.start_s);
            series.y.push(segment.rate_deg_s);
        }
        if let Some(last) = run.profile.last() {
            series.x.push(last.start_s + last.duration_s);
            series.y.push(last.rate_deg_s);
        }
        series
    });
    Plot {
        title: "Rate profile".into(),
        x_label: "Time in the run [s]".into(),
        y_label: "Rate [deg/s]".into(),
        series: series.collect(),
        caption: "Commanded rates, without their ramps.".into(),
        ..Plot::default()
    }
}

/// The shares of the approximate design over the rate.
fn shares(runs: &[DesignedRunResult]) -> Plot {
    let series = runs.iter().enumerate().map(|(place, run)| {
        let mut all: Vec<&MotionResult> = run.shares.iter().collect();
        all.sort_by(|a, b| a.rate_deg_s.total_cmp(&b.rate_deg_s));
        Series {
            name: run_name(place, run),
            x: all.iter().map(|one| one.rate_deg_s).collect(),
            y: all.iter().map(|one| 100.0 * one.share).collect(),
            style: Style::Points,
        }
    });
    Plot {
        title: "Shares of the approximate design".into(),
        x_label: "Rate [deg/s]".into(),
        y_label: "Share of the time [%]".into(),
        series: series.collect(),
        caption: "Static intervals at several table angles are points at a rate of zero.".into(),
        ..Plot::default()
    }
}
