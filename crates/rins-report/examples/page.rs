//! A page with a table and a plot, on standard output.
//!
//! `cargo run -p rins-report --example page > page.html`
#![expect(clippy::print_stdout, reason = "an example prints")]

use rins_report::{Cell, Column, Item, Plot, Report, Section, Series, Table, render};

fn main() {
    let times: Vec<f64> = (0..600).map(|sample| 0.1 * f64::from(sample)).collect();
    let velocity = times.iter().map(|time| 0.02 * time * time).collect();
    let plot = Plot {
        title: "Velocity error".into(),
        x_label: "Time [s]".into(),
        y_label: "East [m/s]".into(),
        series: vec![Series {
            name: "free inertial".into(),
            x: times,
            y: velocity,
            ..Series::default()
        }],
        ..Plot::default()
    };
    let table = Table {
        caption: "Estimates, 1σ".into(),
        columns: vec![Column::text("parameter"), Column::number("value [ppm]")],
        rows: vec![vec![Cell::text("gyro.scale.z"), Cell::Estimate { value: 300.2, sigma: 1.4 }]],
    };
    let section = Section {
        heading: "Result".into(),
        items: vec![Item::Table(table), Item::Plot(plot)],
        ..Section::default()
    };
    let report = Report {
        title: "A calibration".into(),
        summary: vec!["The scale error of gyro z is 300 ppm.".into()],
        sections: vec![section],
        ..Report::default()
    };
    println!("{}", render(&report));
}
