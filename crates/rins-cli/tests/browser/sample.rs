//! A report with everything in it that a report can hold, and names that try to break out of it.

use rins_report::{
    Band, Cell, Column, Item, Matrix, Plot, Reference, Report, Scale, Section, Series, Style,
    Table, Tone,
};

/// Would load, run or end something if any of it became markup.
const HOSTILE: &str = "</script><script>console.error('ran')</script>\
                       <img src=http://escaped.test/x.png onerror=\"console.error('ran')\">\u{2028}";

const N_SAMPLES: usize = 100_000;

pub(crate) fn report() -> Report {
    let curves = Section {
        heading: "Linked curves".into(),
        intro: HOSTILE.into(),
        items: vec![
            Item::Plot(long("one", Style::Line)),
            Item::Plot(long("two", Style::Steps)),
            Item::Plot(long(HOSTILE, Style::Dashed)),
            Item::Plot(long("four", Style::Points)),
        ],
    };
    let other = Section {
        heading: HOSTILE.into(),
        items: vec![Item::Plot(allan()), Item::Plot(Plot::default()), Item::Plot(single())],
        ..Section::default()
    };
    Report {
        title: format!("Sample {HOSTILE}"),
        subtitle: HOSTILE.into(),
        summary: vec![HOSTILE.into(), HOSTILE.into()],
        sections: vec![curves, other, words()],
    }
}

/// A curve with a spike and a gap, a band over fewer samples of its own, and a line.
fn long(name: &str, style: Style) -> Plot {
    let x: Vec<f64> = (0..N_SAMPLES).map(|row| row as f64 * 0.01).collect();
    let mut y: Vec<f64> = x.iter().map(|t| (t / 90.0).sin()).collect();
    y[61_234] = 3.0;
    y[30_000..35_000].fill(f64::NAN);
    y[36_000] = f64::INFINITY;
    let edge: Vec<f64> = x.iter().step_by(1000).copied().collect();
    Plot {
        title: name.into(),
        x_label: "Time [s]".into(),
        y_label: format!("{name} [deg]"),
        series: vec![Series { name: name.into(), x, y, style }],
        bands: vec![Band {
            name: HOSTILE.into(),
            lower: vec![-1.5; edge.len()],
            upper: vec![1.5; edge.len()],
            x: edge,
        }],
        references: vec![
            Reference { name: HOSTILE.into(), value: 2.0 },
            Reference { name: "far away".into(), value: f64::NAN },
        ],
        caption: HOSTILE.into(),
        ..Plot::default()
    }
}

fn allan() -> Plot {
    let x: Vec<f64> = (-2..=4).map(|power| 10_f64.powi(power)).collect();
    let y = x.iter().map(|t| 0.3 / t.sqrt()).collect();
    Plot {
        title: "Allan deviation".into(),
        x_label: "Averaging time [s]".into(),
        y_label: "Allan deviation [deg/h]".into(),
        x_scale: Scale::Logarithmic,
        y_scale: Scale::Logarithmic,
        series: vec![Series { name: "gyro x".into(), x, y, style: Style::Line }],
        ..Plot::default()
    }
}

/// The least that can be drawn.
fn single() -> Plot {
    let series = Series { name: "one".into(), x: vec![1.0], y: vec![1e-9], style: Style::Points };
    Plot { title: "One sample".into(), series: vec![series], ..Plot::default() }
}

fn words() -> Section {
    let table = Table {
        caption: HOSTILE.into(),
        columns: vec![Column::id("id"), Column::text(HOSTILE), Column::number("ppm")],
        rows: vec![
            vec![
                Cell::text("gyro.scale.z"),
                Cell::badge(Tone::Good, HOSTILE),
                Cell::Estimate { value: 300.02, sigma: 0.034 },
            ],
            vec![
                Cell::text(HOSTILE),
                Cell::Bar { value: 0.4, sigma: 0.1 },
                Cell::Number { value: 1.5, decimals: 2 },
            ],
        ],
    };
    let labels: Vec<String> = (0..20).map(|row| format!("accel.misalignment.{row}")).collect();
    let matrix =
        Matrix { caption: HOSTILE.into(), values: vec![vec![-0.5; labels.len()]; 20], labels };
    Section {
        heading: "Words and numbers".into(),
        intro: String::new(),
        items: vec![
            Item::Text(HOSTILE.into()),
            Item::Note(Tone::Neutral, HOSTILE.into()),
            Item::Note(Tone::Warning, HOSTILE.into()),
            Item::Note(Tone::Bad, HOSTILE.into()),
            Item::Table(table),
            Item::Matrix(matrix),
        ],
    }
}
