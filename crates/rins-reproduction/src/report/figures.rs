//! The charts: each figure of the paper with the expected result.

use super::chart::{Axis, Mark, Panel, Scale, Series, svg};
use super::results::Results;
use crate::grid::{ERRORS, turn};
use crate::monte_carlo::{Calibrated, Campaign, UNITS};
use crate::printed;
use crate::pure_navigation::Outcome;
use crate::statistics::Sample;
use rins_motion::mechanism::{ClosedForm, Sign};

const NAMES: [(&str, &str); 3] = [("Mxz", "arcsec"), ("Myz", "arcsec"), ("Sz", "ppm")];
const TRUTH: [f64; 3] = [60.0, 60.0, 300.0];

/// The maximum number of points of a curve.
const POINTS: usize = 80;

/// The charts' file names and texts.
pub(super) fn all(results: &Results) -> Vec<(&'static str, String)> {
    vec![
        ("figure-3.svg", figure_3(&results.with_bias)),
        ("figure-4.svg", figure_4(&results.with_bias)),
        ("figure-5.svg", figure_5(&results.with_bias)),
        ("table-6.svg", table_6(results)),
        ("mechanism.svg", mechanism()),
        ("static-and-rotating.svg", super::rotation::figure(results)),
    ]
}

/// The indices of a history that are drawn, evenly spaced in the logarithm of time.
fn places(run: &Calibrated) -> Vec<usize> {
    let count = run.history.len();
    let mut places: Vec<usize> = (0..POINTS)
        .map(|point| {
            let share = (point + 1) as f64 / POINTS as f64;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a power of the count, between 1 and it"
            )]
            let place = (count as f64).powf(share).round() as usize;
            place.clamp(1, count) - 1
        })
        .collect();
    places.dedup();
    places
}

fn time_axis(campaign: &Campaign) -> Axis {
    let history = campaign.runs.first().map_or(&[][..], |run| &run.history);
    let from = history.get(1).map_or(0.1, |point| point.time);
    let to = history.last().map_or(1.0, |point| point.time);
    Axis::new("time [s]", Scale::Logarithmic, (from, to))
}

fn figure_3(campaign: &Campaign) -> String {
    let panels: Vec<Panel> = NAMES
        .iter()
        .enumerate()
        .map(|(row, &(name, unit))| {
            let times = campaign.runs.first().map(places).unwrap_or_default();
            let at = |place: usize, of: &dyn Fn(&Calibrated) -> f64| {
                let time = campaign.runs.first().map_or(0.0, |run| run.history[place].time);
                let sample = Sample::of(campaign.runs.iter().map(of));
                (time, sample)
            };
            let claimed = times.iter().skip(1).map(|&place| {
                let (time, sample) = at(place, &|run| run.history[place].sigma[row] / UNITS[row]);
                (time, sample.mean)
            });
            let spread = times.iter().skip(1).map(|&place| {
                let (time, sample) =
                    at(place, &|run| run.history[place].estimate[row] / UNITS[row]);
                (time, sample.deviation)
            });
            let (claimed, spread): (Vec<_>, Vec<_>) = (claimed.collect(), spread.collect());
            Panel {
                title: name,
                x: time_axis(campaign),
                y: Axis::new(
                    &format!("1 sigma [{unit}]"),
                    Scale::Logarithmic,
                    sigma_range(&claimed),
                ),
                series: vec![
                    series(Some("claimed by the filter"), Mark::Line, 0, claimed),
                    series(Some("spread of 30 runs"), Mark::Dash, 1, spread),
                ],
            }
        })
        .collect();
    svg(
        "Figure 3: the sigma that the filter claims, and the spread of the runs, against time",
        &panels,
    )
}

/// The range of whole decades around these values.
fn sigma_range(points: &[(f64, f64)]) -> (f64, f64) {
    let least = points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
    let most = points.iter().map(|point| point.1).fold(0.0, f64::max);
    (10_f64.powf(least.log10().floor()), 10_f64.powf(most.log10().ceil()))
}

fn figure_4(campaign: &Campaign) -> String {
    let panels: Vec<Panel> = NAMES
        .iter()
        .enumerate()
        .map(|(row, &(name, unit))| {
            let claimed = campaign.claimed(row);
            let end = campaign.estimates(row).mean;
            let half = (end - TRUTH[row]).abs().max(10.0 * claimed) * 1.6;
            let time = time_axis(campaign);
            let truth = vec![(time.from, TRUTH[row]), (time.to, TRUTH[row])];
            let print = vec![(time.from, printed::TABLE_3[row]), (time.to, printed::TABLE_3[row])];
            let mut all: Vec<Series> = campaign
                .runs
                .iter()
                .enumerate()
                .map(|(index, run)| {
                    let points = places(run).into_iter().skip(1).map(|place| {
                        let point = &run.history[place];
                        (point.time, point.estimate[row] / UNITS[row])
                    });
                    let label = (index == 0).then_some("30 runs");
                    series(label, Mark::Thin, 0, points.collect())
                })
                .collect();
            all.push(series(Some("truth"), Mark::Dash, 3, truth));
            all.push(series(Some("Table 3"), Mark::Line, 1, print));
            Panel {
                title: name,
                x: time,
                y: Axis::new(
                    &format!("estimate [{unit}]"),
                    Scale::Linear,
                    (TRUTH[row] - half, TRUTH[row] + half),
                ),
                series: all,
            }
        })
        .collect();
    svg("Figure 4: the estimates of 30 runs against time", &panels)
}

pub(super) fn series(
    label: Option<&'static str>,
    mark: Mark,
    colour: usize,
    points: Vec<(f64, f64)>,
) -> Series {
    Series { label, mark, colour, points }
}

fn figure_5(campaign: &Campaign) -> String {
    let history = campaign.runs.first().map_or(&[][..], |run| &run.before_history);
    let thin = history.len().div_ceil(2 * POINTS).max(1);
    let panels: Vec<Panel> = [("Vx, east", 0, (-4.0, 4.0)), ("Vy, north", 1, (-20.0, 20.0))]
        .into_iter()
        .map(|(title, axis, range)| {
            let navigated = history.iter().step_by(thin).chain(history.last());
            let points = navigated.map(|point| (point.time, point.velocity[axis])).collect();
            Panel {
                title,
                x: Axis::new("time [s]", Scale::Linear, (0.0, 360.0)),
                y: Axis::new("velocity [m/s]", Scale::Linear, range),
                series: vec![
                    series(Some("navigated"), Mark::Line, 0, points),
                    series(
                        Some("printed formula"),
                        Mark::Dash,
                        1,
                        closed_form(Sign::Printed, axis),
                    ),
                    series(
                        Some("Table 4"),
                        Mark::Cross,
                        3,
                        vec![(360.0, printed::TABLE_4_BEFORE.velocity[axis])],
                    ),
                ],
            }
        })
        .collect();
    svg("Figure 5: velocity before compensation, navigated and by the printed formula", &panels)
}

fn closed_form(sign: Sign, axis: usize) -> Vec<(f64, f64)> {
    let form = ClosedForm::new(turn([30.0, 20.0, 40.0], 10.0), ERRORS, sign);
    (0..=120)
        .map(|step| {
            let time = 3.0 * f64::from(step);
            (time, form.velocity_error(time).total().components()[axis])
        })
        .collect()
}

fn table_6(results: &Results) -> String {
    let panels: Vec<Panel> = [
        ("before compensation", printed::TABLE_6_BEFORE, (2.0, 8.0), 0),
        ("after compensation", printed::TABLE_6_AFTER, (-3.0, 3.0), 1),
    ]
    .into_iter()
    .map(|(title, printed, east, when)| {
        let outcome = |run: &crate::real_test::Emulated| -> Outcome {
            if when == 0 { run.before } else { run.after }
        };
        let points = results.emulated.iter().map(|run| {
            let [east, north] = outcome(run).velocity;
            (east, north)
        });
        let middle = if when == 0 { -3.0 } else { 0.0 };
        Panel {
            title,
            x: Axis::new("Vx, east [m/s]", Scale::Linear, east),
            y: Axis::new("Vy, north [m/s]", Scale::Linear, (middle - 6.0, middle + 6.0)),
            series: vec![
                series(Some("emulated runs"), Mark::Dots, 0, points.collect()),
                series(
                    Some("Table 6"),
                    Mark::Cross,
                    1,
                    vec![(printed.velocity[0], printed.velocity[1])],
                ),
            ],
        }
    })
    .collect();
    svg("Table 6: the velocities of emulated runs and the printed ones", &panels)
}

fn mechanism() -> String {
    let panels: Vec<Panel> = [("east", 0, (-0.08, 0.08)), ("north", 1, (-0.1, 0.1))]
        .into_iter()
        .map(|(title, axis, range)| {
            let one_turn = |sign| {
                let form = ClosedForm::new(turn([30.0, 20.0, 40.0], 10.0), ERRORS, sign);
                (0..=72)
                    .map(|step| {
                        let time = 0.5 * f64::from(step);
                        (time, form.velocity_error(time).total().components()[axis])
                    })
                    .collect()
            };
            let navigated = crate::grid::over_a_turn(&turn([30.0, 20.0, 40.0], 10.0), axis);
            Panel {
                title,
                x: Axis::new("time [s]", Scale::Linear, (0.0, 36.0)),
                y: Axis::new("velocity error [m/s]", Scale::Linear, range),
                series: vec![
                    series(Some("navigated"), Mark::Line, 0, navigated),
                    series(Some("(8), (9) printed"), Mark::Dash, 1, one_turn(Sign::Printed)),
                    series(Some("sign corrected"), Mark::Dash, 2, one_turn(Sign::Strapdown)),
                ],
            }
        })
        .collect();
    svg("Eqs. (8) and (9) over one turn: printed, corrected, and navigated", &panels)
}
