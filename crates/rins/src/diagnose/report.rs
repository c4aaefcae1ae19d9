//! The page of a diagnosis.

use rins_diagnosis::Limit;
use rins_estimation::Estimate;

use super::found::{DiagnosisOutcome, Named};
use super::gain::gain_section;
use super::overlay::overlay_sections;
use super::structure::{size_in_words, structure_in_words};
use super::words::{alternatives, probability, separating_tests, summary};
use crate::homogeneity::{HeldOutComparison, RunComparison};
use crate::settings::settings_in_words;
use rins_report::number::figure;
use rins_report::{Cell, Column, Item, Plot, Report, Section, Series, Table, Tone};

/// The report page.
pub(super) fn diagnosis_report(found: &DiagnosisOutcome) -> Report {
    let certificate = &found.certificate;
    let samples: usize = certificate.runs.iter().map(|run| run.prepared.samples()).sum();
    let mut summary = summary(found);
    summary.extend(separating_tests(found));
    if !found.causes.is_empty() {
        summary.push(
            "model.toml, in the folder of this report, has the extended model, for rins calibrate --model; calibration.toml has its \
             estimates, for rins navigate and rins apply."
                .into(),
        );
    }
    Report {
        title: found.title(),
        subtitle: format!(
            "rins diagnose, model {}: {samples} samples, computation time {:.1} s",
            certificate.model, found.seconds
        ),
        summary,
        sections: [
            vec![causes(found), unexplained(found)],
            found.comparison.iter().map(RunComparison::section).collect(),
            found.held_out.iter().map(HeldOutComparison::section).collect(),
            overlay_sections(found),
            std::iter::once(&found.gain).chain(&found.transfer).map(gain_section).collect(),
            vec![shifts(found), limits(found), untestable(found)],
        ]
        .concat(),
    }
}

fn causes(found: &DiagnosisOutcome) -> Section {
    let rows: Vec<Vec<Cell>> = found.causes.iter().flat_map(cause_rows).collect();
    let items = if rows.is_empty() {
        vec![Item::Note(Tone::Good, "Nothing of the catalogue is significant.".into())]
    } else {
        vec![Item::Table(Table {
            caption: "Causes, the strongest evidence first".into(),
            columns: vec![
                Column::text("effect"),
                Column::id("parameter"),
                Column::number("estimate"),
                Column::text("unit"),
                Column::number("significance [σ]"),
                Column::number("p"),
                Column::text("not distinguished from"),
                Column::text("magnitude"),
            ],
            rows,
        })]
    };
    Section {
        heading: "Causes".into(),
        intro: "Each effect was estimated with all the others and with the model. p is family-wise over the catalogue: the \
                probability that, in a run without unmodeled effects, any effect of the catalogue shows evidence as strong."
            .into(),
        items,
    }
}

fn cause_rows(named: &Named) -> Vec<Vec<Cell>> {
    let cause = &named.cause;
    let settings = settings_in_words(cause.term, &cause.settings, cause.sought);
    let name = if settings.is_empty() {
        cause.term.name.to_owned()
    } else {
        format!("{}, {settings}", cause.term.name)
    };
    let joint = vec![
        Cell::Number { value: named.sigmas, decimals: 1 },
        Cell::text(probability(cause.ln_p)),
        Cell::text(alternatives(named)),
        if named.plausible {
            Cell::badge(Tone::Good, "typical")
        } else {
            Cell::badge(Tone::Warning, "too large")
        },
    ];
    let figures = |estimate: &Estimate| {
        let unit = estimate.parameter.unit;
        vec![
            Cell::text(&estimate.parameter.id),
            Cell::Estimate {
                value: estimate.value / unit.factor,
                sigma: estimate.sigma / unit.factor,
            },
            Cell::text(unit.symbol),
        ]
    };
    let empty = |cells: usize| vec![Cell::Empty; cells];
    match &cause.parameters[..] {
        [only] => vec![[vec![Cell::text(name)], figures(only), joint].concat()],
        // The significance is that of all parameters together.
        several => {
            let all = vec![Cell::text(name), Cell::text(cause.term.id)];
            std::iter::once([all, empty(2), joint].concat())
                .chain(several.iter().map(|one| [empty(1), figures(one), empty(4)].concat()))
                .collect()
        }
    }
}

fn unexplained(found: &DiagnosisOutcome) -> Section {
    let rows: Vec<Vec<Cell>> = found
        .unexplained
        .iter()
        .map(|one| {
            vec![
                Cell::text((one.run + 1).to_string()),
                Cell::text(one.channel),
                Cell::text(structure_in_words(one)),
                Cell::text(size_in_words(one).unwrap_or_default()),
                Cell::text(probability(one.ln_p)),
            ]
        })
        .collect();
    let items = if rows.is_empty() {
        vec![Item::Note(
            Tone::Good,
            "No residual structure was found: the innovations are consistent with white noise."
                .into(),
        )]
    } else {
        vec![Item::Table(Table {
            caption: "Residual structure that no effect of the catalogue explains".into(),
            columns: vec![
                Column::number("run"),
                Column::id("channel"),
                Column::text("structure"),
                Column::text("size"),
                Column::number("p"),
            ],
            rows,
        })]
    };
    Section {
        heading: "Unexplained residual structure".into(),
        intro: "The innovations of the extended model, searched for spectral lines, harmonic orders of the table angle, drifts, unequal \
                variance and outliers; and each cause, compared between parts of the run."
            .into(),
        items,
    }
}

fn shifts(found: &DiagnosisOutcome) -> Section {
    let rows = found.shifts.iter().map(|shift| {
        let unit = shift.before.parameter.unit;
        let estimate = |estimate: &Estimate| Cell::Estimate {
            value: estimate.value / unit.factor,
            sigma: estimate.sigma / unit.factor,
        };
        vec![
            Cell::text(&shift.before.parameter.id),
            estimate(&shift.before),
            estimate(&shift.after),
            Cell::text(unit.symbol),
            Cell::Number { value: -shift.sigmas(), decimals: 1 },
        ]
    });
    let items = if found.shifts.is_empty() {
        vec![Item::Note(Tone::Neutral, "No estimate changes by so much.".into())]
    } else {
        vec![Item::Table(Table {
            caption: "Estimates without and with the identified effects".into(),
            columns: vec![
                Column::id("parameter"),
                Column::number("without"),
                Column::number("with"),
                Column::text("unit"),
                Column::number("bias without [σ]"),
            ],
            rows: rows.collect(),
        })]
    };
    Section {
        heading: "Effect on the estimates".into(),
        intro: "Estimates that are biased without the identified effects. Listed if the change exceeds 1σ of the estimate without \
                the effects, and three times the standard uncertainty of the change (Hausman 1978). Without the effects the sigmas \
                are often larger, because the estimated noise then contains the effects."
            .into(),
        items,
    }
}

fn limits(found: &DiagnosisOutcome) -> Section {
    let rows = found.limits.iter().map(|limit| {
        let parameter = &limit.term.parameters[limit.parameter];
        let unit = parameter.unit;
        let (low, high) = parameter.range(&found.certificate.runs[0].prepared.imu);
        let shown = |value: f64| Cell::text(figure(value / unit.factor, 3));
        vec![
            Cell::text(limit.own_id(&found.certificate.fit.run_axes[0])),
            shown(limit.sigma),
            shown(limit.detectable),
            Cell::text(unit.symbol),
            Cell::text(format!(
                "{} to {}",
                figure(low / unit.factor, 2),
                figure(high / unit.factor, 2)
            )),
            if limit.detectable < low {
                Cell::badge(Tone::Good, "all of the range")
            } else if limit.detectable < high {
                Cell::badge(Tone::Neutral, "upper part")
            } else {
                Cell::badge(Tone::Warning, "none")
            },
        ]
    });
    Section {
        heading: "Minimum detectable effects".into(),
        intro: "For each parameter of each effect that the model does not have: the amplitude that this run detects with 95 % power, \
                at p < 0.01, if no other unmodeled effect is present. Smaller effects may be present and remain undetected."
            .into(),
        items: [power(&found.limits), vec![Item::Table(Table {
            caption: "Minimum detectable amplitudes".into(),
            columns: vec![
                Column::id("parameter"),
                Column::number("σ"),
                Column::number("minimum detectable"),
                Column::text("unit"),
                Column::text("typical range"),
                Column::text("detectable part"),
            ],
            rows: rows.collect(),
        })]].concat(),
    }
}

/// How likely an effect would have been found, over its size: the effect that is sought in the fewest ways, and that in
/// the most.
fn power(limits: &[Limit]) -> Vec<Item> {
    let by_ways = |a: &&Limit, b: &&Limit| a.significant.total_cmp(&b.significant);
    let (Some(fewest), Some(most)) = (limits.iter().min_by(by_ways), limits.iter().max_by(by_ways))
    else {
        return Vec::new();
    };
    let sigmas: Vec<f64> = (0..=120).map(|step| 0.1 * f64::from(step)).collect();
    let curve = |limit: &Limit| Series {
        name: limit.term.name.into(),
        x: sigmas.clone(),
        y: sigmas.iter().map(|sigma| 100.0 * limit.power(sigma * limit.sigma)).collect(),
        ..Series::default()
    };
    vec![Item::Plot(Plot {
        title: "Detection power of this run".into(),
        x_label: "True amplitude [σ]".into(),
        y_label: "Detected [%]".into(),
        series: vec![curve(fewest), curve(most)],
        caption: "The curves show the effects with the lowest and the highest detection threshold; those of all others lie between. The \
                  threshold rises with the number of event times, harmonic orders or parameters that are searched. The σ of each \
                  effect is in the table."
            .into(),
        ..Plot::default()
    })]
}

fn untestable(found: &DiagnosisOutcome) -> Section {
    let rows = found
        .untestable
        .iter()
        .map(|one| vec![Cell::text(one.term.id), Cell::text(one.term.name), Cell::text(&one.why)]);
    Section {
        heading: "Not testable".into(),
        intro: "Effects that this run cannot detect at any amplitude of their typical range."
            .into(),
        items: vec![Item::Table(Table {
            caption: "Not testable".into(),
            columns: vec![
                Column::id("effect"),
                Column::text("description"),
                Column::text("reason or remedy"),
            ],
            rows: rows.collect(),
        })],
    }
}
