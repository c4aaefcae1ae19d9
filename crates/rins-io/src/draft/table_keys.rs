//! The keys of the table and of the temperature in a draft.

use super::findings::Findings;
use super::label::Label;
use super::layout::{Layout, Picked};
use super::page::{Page, short, text};
use super::sample::Sample;
use super::sections;
use super::stated::Stated;
use super::units::{UnitFound, angle_unit, rate_unit};
use crate::quantity::Dimension;

/// The table's column.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    pub(super) column: usize,
    pub(super) is_angle: bool,
    column_guess: Option<String>,
    /// The unit and, unless the header states it, the reason for it.
    unit: Option<(String, Option<String>)>,
}

impl Table {
    /// The table's column whose unit the header states, with the value of its unit in SI units,
    /// and whether it is an angle.
    pub(super) fn stated(labels: &[Label], layout: &Layout) -> Option<(usize, f64, bool)> {
        let (picked, is_angle) = picked(layout)?;
        let unit = unit(labels, picked.column, is_angle)?;
        Some((picked.column, unit.unit.factor, is_angle))
    }

    /// The table's column, with its unit from the header or from the gyros; `gyro` has their columns and the rotation of the body
    /// per row and per unit of their numbers \[rad\].
    pub(super) fn find(findings: Findings<'_>, gyro: Option<([usize; 3], f64)>) -> Option<Self> {
        let Findings { sample, labels, layout, .. } = findings;
        let (picked, is_angle) = picked(layout)?;
        let column = picked.column;
        let found = if is_angle {
            angle_unit(sample, column, gyro)
        } else {
            rate_unit(sample, column, gyro, findings.interval())
        };
        let unit = match (unit(labels, column, is_angle), found) {
            (Some(Stated { text, by_ending: false, .. }), _) => Some((text.clone(), None)),
            (Some(Stated { text, .. }), _) => {
                Some((text.clone(), Some("by the ending of the column's name".into())))
            }
            (None, Some(UnitFound { text, why })) => Some((text.into(), Some(why))),
            (None, None) => None,
        };
        let column_guess = picked.guess.clone();
        Some(Self { column, is_angle, column_guess, unit })
    }
}

/// The table's angle or, if there is none, its rate.
fn picked(layout: &Layout) -> Option<(&Picked<usize>, bool)> {
    let angle = layout.table_angle.as_ref().map(|picked| (picked, true));
    angle.or(layout.table_rate.as_ref().map(|picked| (picked, false)))
}

fn unit(labels: &[Label], column: usize, is_angle: bool) -> Option<&Stated> {
    let kind = if is_angle { Dimension::ANGLE } else { Dimension::ANGULAR_RATE };
    labels[column].unit.as_ref().filter(|stated| stated.unit.dimension == kind)
}

pub(super) fn write(page: &mut Page, findings: Findings<'_>, table: Option<&Table>) {
    let Findings { sample, labels, layout, .. } = findings;
    match table {
        Some(table) => table.write(page, sample),
        None => {
            let meaning = "the encoder's column, with table_angle.unit";
            page.optional("table_angle.column", r#""?""#, meaning);
        }
    }
    match &layout.temperature {
        Some(picked) => temperature(page, sample, labels, picked),
        None => {
            let meaning = "with temperature.unit, and temperature.path and .time if elsewhere";
            page.optional("temperature.column", r#""?""#, meaning);
        }
    }
    if table.is_none() {
        page.blank();
        page.remark("No column has the name of a table or encoder. Calibration needs the motion:");
        page.remark("a table_angle or table_rate above, or the commanded motion:");
        sections::profile(page);
    }
}

impl Table {
    fn write(&self, page: &mut Page, sample: &Sample) {
        let (name, units) = if self.is_angle {
            ("table_angle", r#""deg", "rad", "arcsec" or "rev""#)
        } else {
            ("table_rate", r#""deg/s", "rad/s" or "deg/h""#)
        };
        let key = |of: &str| format!("{name}.{of}");
        let column = text(&sample.name(self.column));
        match &self.column_guess {
            None => page.known(&key("column"), &column),
            Some(why) => page.guess(&key("column"), &column, why),
        }
        match &self.unit {
            Some((unit, None)) => page.known(&key("unit"), &text(unit)),
            Some((unit, Some(why))) => page.guess(&key("unit"), &text(unit), why),
            None => page.leave(&key("unit"), r#""?""#, units),
        }
        if self.is_angle {
            page.optional(&key("noise"), r#""? arcsec""#, "the encoder's white noise, 1 sigma");
            page.optional(&key("resolution"), r#""? arcsec""#, "its least significant bit");
            page.optional(
                &key("latency"),
                r#""? ms""#,
                "positive if the angle is older than the IMU sample",
            );
        }
    }
}

fn temperature(page: &mut Page, sample: &Sample, labels: &[Label], picked: &Picked<usize>) {
    let column = text(&sample.name(picked.column));
    match &picked.guess {
        None => page.known("temperature.column", &column),
        Some(why) => page.guess("temperature.column", &column, why),
    }
    let stated = labels[picked.column].unit.as_ref();
    let stated = stated.filter(|stated| stated.unit.dimension == Dimension::TEMPERATURE);
    let mean = mean(sample, picked.column);
    match stated {
        Some(Stated { text: unit, by_ending, .. }) => {
            let unit = text(unit);
            if *by_ending {
                page.guess("temperature.unit", &unit, "by the ending of the column's name");
            } else {
                page.known("temperature.unit", &unit);
            }
        }
        None => {
            let unit = if (-60.0..150.0).contains(&mean) {
                Some("degC")
            } else if (210.0..425.0).contains(&mean) {
                Some("K")
            } else {
                None
            };
            match unit {
                Some(unit) => {
                    let why = format!("its mean is {}", short(mean));
                    page.guess("temperature.unit", &text(unit), &why);
                }
                None => page.leave("temperature.unit", r#""?""#, r#""degC" or "K""#),
            }
        }
    }
}

/// The mean of the column's numbers.
fn mean(sample: &Sample, column: usize) -> f64 {
    let numbers = sample.runs.iter().flat_map(|run| run[column].iter());
    let finite = numbers.copied().filter(|number| number.is_finite());
    let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), number| (sum + number, count + 1.0));
    sum / count
}
