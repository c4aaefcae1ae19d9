//! The compensation equation and its steps, and the error budget of free inertial navigation.

use rins_frames::units::ARCSEC;
use rins_terms::Model;

use rins_design::Budget;

use super::compensation::{EQUATION, STEPS, of_run_alone};
use crate::settings::settings_in_words;
use rins_report::{Cell, Column, Item, Section, Table};

/// The compensation equation, its steps, and the terms of the model.
pub(super) fn compensation_section(model: &Model) -> Section {
    let mut items = vec![Item::Text(EQUATION.into())];
    items.extend(STEPS.iter().map(|step| Item::Text((*step).into())));
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for (place, chosen) in model.terms.iter().enumerate() {
        let of_table = of_run_alone(chosen.term.id);
        rows.push(vec![
            Cell::text((place + 1).to_string()),
            Cell::text(chosen.term.id),
            Cell::text(chosen.term.equation),
            Cell::text(if of_table {
                "not compensated: it belongs to the table".into()
            } else {
                settings_in_words(chosen.term, &chosen.settings, None)
            }),
        ]);
    }
    items.push(Item::Table(Table {
        caption: "Error terms (summed)".into(),
        columns: vec![
            Column::number(""),
            Column::id("term"),
            Column::text("contribution to the reading"),
            Column::text("settings"),
        ],
        rows,
    }));
    Section {
        heading: "How to compensate".into(),
        intro: "calibration.toml contains the errors; rins navigate --calibration and rins apply perform these steps. Errors are \
                measured minus true. S is the diagonal matrix of scale errors; M contains the misalignments as off-diagonal elements."
            .into(),
        items,
    }
}

/// The contribution of each parameter to the error of free inertial navigation.
pub(super) fn budget_section(heading: &str, ids: &[&str], budget: &Budget) -> Section {
    let shown = |value: f64| Cell::Number { value, decimals: 5 };
    let mut rows: Vec<Vec<Cell>> = ids
        .iter()
        .zip(&budget.contributions)
        .map(|(id, one)| {
            vec![
                Cell::text(*id),
                shown(one.by_value.velocity.norm()),
                Cell::Number { value: one.by_value.attitude.norm() / ARCSEC, decimals: 3 },
                shown(one.by_sigma.velocity.norm()),
                Cell::Number { value: one.by_sigma.attitude.norm() / ARCSEC, decimals: 3 },
            ]
        })
        .collect();
    rows.push(vec![
        Cell::text("all, with their correlations"),
        Cell::Empty,
        Cell::Empty,
        shown(budget.total.velocity.norm()),
        Cell::Number { value: budget.total.attitude.norm() / ARCSEC, decimals: 3 },
    ]);
    Section {
        heading: heading.into(),
        intro: format!(
            "Velocity and attitude errors after {:.0} s of free inertial navigation, caused by each estimated error if it is not \
             compensated, and by an error of 1σ (marginal) that remains after compensation. Parameters that are observable only in \
             a combination have large marginal sigmas. The last row takes their correlations into account.",
            budget.after
        ),
        items: vec![Item::Table(Table {
            caption: "Velocity and attitude errors".into(),
            columns: vec![
                Column::id("parameter"),
                Column::number("uncompensated [m/s]"),
                Column::number("uncompensated [arcsec]"),
                Column::number("compensated, 1σ [m/s]"),
                Column::number("compensated, 1σ [arcsec]"),
            ],
            rows,
        })],
    }
}
