//! Eqs. (6) to (9) and the other equations of the paper, against numerical integration.

use std::fmt::Write;

use super::number::{Table, fixed};
use super::results::Results;
use crate::equations::Check;
use crate::grid::{ATTITUDES, RATES, Row};

pub(super) fn section(results: &Results) -> String {
    let mut out = String::from("## Equations (6), (8), (9): the error mechanism {#mechanism}\n\n");
    let worst = |of: &dyn Fn(&Row) -> f64| results.grid.iter().map(of).fold(0.0, f64::max);
    let broken = results.grid.iter().flat_map(Row::broken).count();
    let _ = write!(
        out,
        "`cargo xtask verify` integrates numerically over {} places: times of 9, 36, 90 and 360 s, {} attitudes, {} rates. \
         The strapdown result is *minus* the printed one in every term. With the sign corrected the closed form is within {} % \
         of a *flat* Earth that does not turn, integrated ($S_z\\omega t$, the second order, is up to {} %). The *extended* form, linear \
         on the round Earth and to second order on the flat one, is within {} % of the navigator. {} bounds are broken.\n\n\
         At roll 30°, pitch 20°, yaw 40° and 10 °/s, in m/s, with the ratios to the navigator:\n\n",
        results.grid.len(),
        ATTITUDES.len(),
        RATES.len(),
        fixed(100.0 * worst(&|row| row.corrected.relative_to(&row.flat)), 1),
        fixed(100.0 * worst(&Row::second_order), 1),
        fixed(100.0 * worst(&|row| row.extended.relative_to(&row.navigated)), 2),
        broken,
    );
    let mut table = Table::new(&[
        "time [s]>",
        "",
        "printed>",
        "corrected>",
        "flat>",
        "extended>",
        "navigator>",
        "printed: ratio>",
        "extended: ratio>",
    ]);
    let shown = |row: &&Row| is(&row.attitude, &ATTITUDES[0]) && is(&[row.rate], &RATES[..1]);
    for row in results.grid.iter().filter(shown) {
        for (axis, name) in ["$\\delta v_x$", "$\\delta v_y$"].into_iter().enumerate() {
            let of = |errors: &crate::grid::Errors| errors.velocity[axis];
            table.row(&[
                fixed(row.time, 0),
                name.to_owned(),
                fixed(of(&row.printed), 4),
                fixed(of(&row.corrected), 4),
                fixed(of(&row.flat), 4),
                fixed(of(&row.extended), 4),
                fixed(of(&row.navigated), 4),
                fixed(of(&row.printed) / of(&row.navigated), 3),
                fixed(of(&row.extended) / of(&row.navigated), 4),
            ]);
        }
    }
    out.push_str(&table.finish());
    out.push_str(
        "![Velocity errors by eqs. (8) and (9) as printed, corrected, and \
                  navigated](figures/mechanism.svg)\n\n",
    );
    misprints(&mut out, results);
    out
}

/// Whether two lists contain bit-identical numbers.
fn is(one: &[f64], other: &[f64]) -> bool {
    one.iter().map(|number| number.to_bits()).eq(other.iter().map(|number| number.to_bits()))
}

fn misprints(out: &mut String, results: &Results) {
    out.push_str(
        "## Equations misprinted {#misprints}\n\n\
         Each against an evaluation that uses neither form: quadrature, or differences of a navigator. *Off* is relative.\n\n",
    );
    let mut table = Table::new(&[
        "equation",
        "what is wrong",
        "evaluated by",
        "printed off>",
        "corrected off>",
    ]);
    let mut row = |equation: &str, wrong: &str, by: &str, check: &Check| {
        let percent = |off: f64| {
            let percent = 100.0 * off;
            if percent < 0.001 {
                "< 0.001 %".to_owned()
            } else {
                format!("{} %", fixed(percent, 0))
            }
        };
        table.row(&[
            equation.to_owned(),
            wrong.to_owned(),
            by.to_owned(),
            percent(check.printed_off()),
            percent(check.corrected_off()),
        ]);
    };
    let at_a_turn = results.grid.iter().find(|row| row.time > 80.0 && row.time < 100.0);
    if let Some(place) = at_a_turn {
        let north = |errors: &crate::grid::Errors| errors.velocity.y;
        let check = Check {
            evaluated: north(&place.navigated),
            printed: north(&place.printed),
            corrected: north(&place.extended),
        };
        row(
            "(6), (8), (9)",
            "sign of every term of $M$ and $S$: (A.2) integrates $+C_b^n\\,\\delta\\omega$",
            "navigator at 90 s",
            &check,
        );
    }
    row(
        "(A.7)",
        "a minus at the bounded $C_s^n(1,1)$ term, if a copy has one; (9) has the plus",
        "quadrature of (7) over 18 s",
        &results.bounded_term,
    );
    row(
        "(13), row 2",
        "$-(\\rho+2\\Omega)_x v_z$ for $+(\\rho+2\\Omega)_x\\,\\delta v_z$",
        "navigator at 100 m/s north",
        &results.vertical_coupling,
    );
    row(
        "(19)",
        "$(I - \\phi\\times)\\,C_n^b$ for $C_n^b\\,(I + \\phi\\times)$",
        "transpose of $(I-\\phi\\times)\\,C_b^n$",
        &results.transposed_error,
    );
    row(
        "(21)",
        "no columns for $\\delta\\theta$, though $\\phi = \\psi + \\delta\\theta$",
        "differences of (20)",
        &results.position_columns,
    );
    out.push_str(&table.finish());
    out.push_str(
        "Where (19) is *off*, the whole attitude error is the unit: the printed form errs by more than the error that it \
         describes.\n",
    );
}
