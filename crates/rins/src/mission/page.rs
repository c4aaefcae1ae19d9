//! A mission as text and as a report page.

use rins_report::number::figure;
use rins_report::{Item, Plot, Report, Section, Series, Style, Table};

use super::Mission;
use super::result::{MissionResult, NAUTICAL_MILE, SchemeResult, WantResult};
use crate::table::{aligned, captioned};

/// The times of the text: thirds of the mission.
const THIRDS: [usize; 3] = [1, 2, 3];

/// The number of sources in the budget.
const TOLD: usize = 8;

/// The summary for a terminal.
pub(super) fn mission_text(mission: &Mission) -> String {
    let result = MissionResult::from(mission);
    let mut lines = vec![title(mission)];
    let told = summary(&result).into_iter().chain(simulation_words(&result));
    let told = told.chain(mission.remarks.iter().cloned());
    lines.extend(told.map(|sentence| format!("  {sentence}")));
    lines.push(String::new());
    lines.push(aligned(&rows(mission, &result)));
    for scheme in result.schemes.iter().filter(|scheme| !scheme.budget.is_empty()) {
        lines.push(format!("  {}, 1σ at the end by each source alone [nmi]", scheme.name));
        lines.push(aligned(&budget_rows(scheme)));
    }
    for scheme in &result.schemes {
        if let Some(want) = &scheme.want {
            lines.push(format!("  {}: {}", scheme.name, want_words(want)));
            lines.push(aligned(&want_rows(want)));
        }
    }
    // The last column of a table is empty.
    let text = lines.join("\n");
    text.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

fn title(mission: &Mission) -> String {
    format!("Mission {}", mission.name)
}

/// The schemes in the order of their error at the end.
fn summary(result: &MissionResult) -> Vec<String> {
    let last = |list: &Option<Vec<f64>>| list.as_ref().and_then(|list| list.last().copied());
    let size = |scheme: &SchemeResult| {
        let by_errors = last(&scheme.east_nmi).zip(last(&scheme.north_nmi));
        last(&scheme.trms_nmi).or_else(|| by_errors.map(|(east, north)| east.hypot(north)))
    };
    let mut all: Vec<(&SchemeResult, f64)> =
        result.schemes.iter().filter_map(|scheme| Some((scheme, size(scheme)?))).collect();
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    let Some((best, least)) = all.first() else { return Vec::new() };
    let hours = best.hours.last().copied().unwrap_or_default();
    let what = if best.trms_nmi.is_some() {
        "rms radial position error (TRMS)"
    } else {
        "position error by the stated errors"
    };
    let others: Vec<String> = all[1..]
        .iter()
        .map(|(scheme, size)| format!("{} {}", scheme.name, figure(*size, 3)))
        .collect();
    let beside =
        if others.is_empty() { String::new() } else { format!("; {} nmi", others.join(", ")) };
    vec![format!(
        "After {} h the {what} is {} nmi with the scheme {}{beside}.",
        figure(hours, 3),
        figure(*least, 3),
        best.name
    )]
}

/// The columns of the table: their names, and what they hold of a scheme.
type ColumnOf = (&'static str, fn(&SchemeResult) -> Option<&Vec<f64>>);

const COLUMNS: [ColumnOf; 9] = [
    ("east", |scheme| scheme.east_nmi.as_ref()),
    ("north", |scheme| scheme.north_nmi.as_ref()),
    ("secular, east", |scheme| scheme.law_nmi.as_ref()),
    ("CEP50", |scheme| scheme.cep50_nmi.as_ref()),
    ("CEP95", |scheme| scheme.cep95_nmi.as_ref()),
    ("TRMS", |scheme| scheme.trms_nmi.as_ref()),
    ("before the calibration", |scheme| scheme.trms_before_nmi.as_ref()),
    ("simulated CEP50", |scheme| scheme.simulated.as_ref().map(|all| &all.cep50_nmi)),
    ("simulated TRMS", |scheme| scheme.simulated.as_ref().map(|all| &all.trms_nmi)),
];

/// The errors at a third, two thirds and the end of the mission, or at the only times that there are.
fn rows(mission: &Mission, result: &MissionResult) -> Vec<Vec<String>> {
    let count = mission.times.len();
    let mut places: Vec<usize> = THIRDS
        .iter()
        .map(|thirds| (count * thirds / 3).max(1) - 1)
        .filter(|place| *place < count)
        .collect();
    places.dedup();
    let columns: Vec<&ColumnOf> = COLUMNS
        .iter()
        .filter(|(_, of)| result.schemes.iter().any(|scheme| of(scheme).is_some()))
        .collect();
    let mut rows = vec![
        ["scheme", "hours"]
            .into_iter()
            .map(String::from)
            .chain(columns.iter().map(|(name, _)| format!("{name} [nmi]")))
            .chain([String::new()])
            .collect::<Vec<_>>(),
    ];
    for scheme in &result.schemes {
        for &place in &places {
            let cell = |(_, of): &&ColumnOf| {
                of(scheme).map_or_else(|| "–".into(), |list| figure(list[place], 4))
            };
            let mut row = vec![scheme.name.clone(), figure(scheme.hours[place], 3)];
            row.extend(columns.iter().map(cell));
            row.push(String::new());
            rows.push(row);
        }
    }
    rows
}

/// What the simulated missions took.
fn simulation_words(result: &MissionResult) -> Option<String> {
    let first = result.schemes.iter().find_map(|scheme| scheme.simulated.as_ref())?;
    let all = result.schemes.iter().filter_map(|scheme| scheme.simulated.as_ref());
    let seconds: f64 = all.map(|one| one.seconds).sum();
    let hours = result.schemes[0].hours.last().copied().unwrap_or_default();
    Some(format!(
        "Simulated: {} missions of {} h for each scheme, strapdown at {} Hz with drawn errors (seed {}), in {} s.",
        first.runs,
        figure(hours, 3),
        figure(first.sample_rate_hz, 3),
        first.seed,
        figure(seconds, 2)
    ))
}

/// What holds a wanted figure, in a sentence.
fn want_words(want: &WantResult) -> String {
    let wanted = format!("{} nmi after {} h", figure(want.trms_nmi, 3), figure(want.hours, 3));
    let fixed = figure(want.fixed_nmi, 3);
    if !want.possible {
        return format!(
            "{wanted} cannot be held by any calibration: noise and the initial attitude alone leave {fixed} nmi."
        );
    }
    if want.present_nmi <= want.trms_nmi {
        return format!("{wanted} is held: {} nmi.", figure(want.present_nmi, 3));
    }
    let simulated = want
        .simulated_nmi
        .map(|simulated| format!(", {} nmi simulated", figure(simulated, 3)))
        .unwrap_or_default();
    format!(
        "{wanted} is held by the standard deviations asked for ({} nmi{simulated}; present {} nmi; noise and initial attitude {fixed} nmi). \
         `rins design SCENARIO --for position@{}h` finds the calibration schedule.",
        figure(want.reached_nmi, 3),
        figure(want.present_nmi, 3),
        want.hours
    )
}

/// The parameters that must improve, and what they contribute then.
fn want_rows(want: &WantResult) -> Vec<Vec<String>> {
    let head = ["parameter", "present", "asked", "unit", "share, 1σ [nmi]", ""];
    let must = want.parameters.iter().filter(|one| one.asked < one.present);
    let rows = must.map(|one| {
        vec![
            one.id.clone(),
            figure(one.present, 3),
            figure(one.asked, 3),
            one.unit.clone(),
            figure(one.share_nmi, 3),
            String::new(),
        ]
    });
    std::iter::once(head.map(String::from).to_vec()).chain(rows).collect()
}

fn budget_rows(scheme: &SchemeResult) -> Vec<Vec<String>> {
    let told = scheme.budget.iter().take(TOLD);
    told.map(|one| vec![one.source.clone(), figure(one.radial_nmi, 3), String::new()]).collect()
}

/// The report page.
pub(super) fn mission_report(mission: &Mission) -> Report {
    let result = MissionResult::from(mission);
    let errors = captioned("At a third, at two thirds and at the end", &rows(mission, &result));
    let mut items = vec![Item::Table(errors)];
    items.extend(plots(&result).into_iter().map(Item::Plot));
    let mut sections = vec![Section {
        heading: "Position errors".into(),
        intro: "Linear propagation of the errors: Schuler, Foucault and Earth-rate oscillations and the growth of the longitude."
            .into(),
        items,
    }];
    let budgets: Vec<Table> = result
        .schemes
        .iter()
        .filter(|scheme| !scheme.budget.is_empty())
        .map(|scheme| {
            let head = ["source", "radial, 1σ [nmi]", ""].map(String::from).to_vec();
            let rows: Vec<_> = std::iter::once(head).chain(budget_rows(scheme)).collect();
            captioned(&scheme.name, &rows)
        })
        .collect();
    if !budgets.is_empty() {
        sections.push(Section {
            heading: "Error budget".into(),
            intro: "The radial position error at the end by each source alone; correlations are not in it.".into(),
            items: budgets.into_iter().map(Item::Table).collect(),
        });
    }
    let wanted: Vec<Item> = result
        .schemes
        .iter()
        .filter_map(|scheme| scheme.want.as_ref().map(|want| (&scheme.name, want)))
        .flat_map(|(name, want)| {
            let words = Item::Text(format!("{name}: {}", want_words(want)));
            let rows = want_rows(want);
            let table = (rows.len() > 1).then(|| Item::Table(captioned(name, &rows)));
            std::iter::once(words).chain(table)
        })
        .collect();
    if !wanted.is_empty() {
        sections.push(Section {
            heading: "Wanted position error".into(),
            intro: "Parameters that contribute less than an equal share keep their standard deviation; the others share what is left equally."
                .into(),
            items: wanted,
        });
    }
    let words = simulation_words(&result).into_iter().chain(mission.remarks.iter().cloned());
    let remarks = words.map(Item::Text).collect();
    sections.push(Section { heading: "Remarks".into(), intro: String::new(), items: remarks });
    Report {
        title: title(mission),
        subtitle: "rins mission".into(),
        summary: summary(&result),
        sections,
    }
}

/// The errors over time.
fn plots(result: &MissionResult) -> Vec<Plot> {
    let plot = |title: &str, of: fn(&SchemeResult) -> Option<&Vec<f64>>| {
        let series: Vec<Series> = result
            .schemes
            .iter()
            .filter_map(|scheme| {
                Some(Series {
                    name: scheme.name.clone(),
                    x: scheme.hours.clone(),
                    y: of(scheme)?.clone(),
                    ..Series::default()
                })
            })
            .collect();
        (!series.is_empty()).then(|| Plot {
            title: title.into(),
            x_label: "Time [h]".into(),
            y_label: "Position error [nmi]".into(),
            series,
            caption: format!("One nautical mile is {NAUTICAL_MILE} m."),
            ..Plot::default()
        })
    };
    let mut all = [
        plot("Position error east by the stated errors", |scheme| scheme.east_nmi.as_ref()),
        plot("RMS radial position error (TRMS)", |scheme| scheme.trms_nmi.as_ref()),
        plot("RMS horizontal velocity error", |scheme| scheme.velocity_rms_m_s.as_ref()),
    ];
    if let Some(velocity) = &mut all[2] {
        velocity.y_label = "Velocity error [m/s]".into();
        velocity.caption = String::new();
    }
    if let Some(trms) = &mut all[1] {
        let simulated = result.schemes.iter().filter_map(|scheme| {
            let simulated = scheme.simulated.as_ref()?;
            Some(Series {
                name: format!("{}, simulated", scheme.name),
                x: scheme.hours.clone(),
                y: simulated.trms_nmi.clone(),
                style: Style::Points,
            })
        });
        trms.series.extend(simulated);
    }
    all.into_iter().flatten().collect()
}
