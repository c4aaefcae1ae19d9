//! The catalogue as a page of the book.

use std::fmt::Write as _;

use crate::catalogue::CATALOGUE;
use crate::term::{Action, Parameter, Prior, Term};

/// The head of the page.
const HEAD: &str = "\
# The catalogue of effects

Every effect that `rins` can simulate, estimate and name is one entry here, and one item of the crate `rins-terms`, from
which `cargo run -p rins-terms --example catalogue_page` writes this page.

Whatever is read is **read minus true**: an entry says what it adds to the rate `ω` that the gyros read, to the force `f`
that the accelerometers read, to the angle `ζ` that the encoder reads, or by which rotation vector `θ` of the axis frame
the table is truly tilted, which gyros and accelerometers feel. `H` is a step from 0 to 1, `t` the time since the run
began, `T` a temperature and `T_ref` the reference temperature of the model, 20 °C where it says no other. Where an entry
speaks of x, y and z, it has a parameter for each.

Usual magnitudes are those of IMUs with **fibre-optic gyros / laser gyros / MEMS**; of accelerometers, pendulous /
vibrating beam / MEMS; or of any table and place. \"Sheet\" is the 1σ of the IMU's data sheet. Effects marked † share an
entry: no schedule could tell them apart.
";

type Belongs = fn(&Term) -> bool;

/// The page's tables: a heading, and which terms stand under it.
const TABLES: [(&str, Belongs); 5] = [
    ("Gyros", |term| !is_log(term) && term.id.starts_with("gyro")),
    ("Accelerometers", |term| !is_log(term) && term.id.starts_with("accel")),
    ("Table, encoder, timing", |term| !is_log(term) && is_table(term)),
    ("Base, place, surroundings", |term| {
        let sensor = term.id.starts_with("gyro") || term.id.starts_with("accel");
        !is_log(term) && !sensor && !is_table(term)
    }),
    ("Faults of a log", is_log),
];

fn is_log(term: &Term) -> bool {
    matches!(term.action, Action::Log(_))
}

fn is_table(term: &Term) -> bool {
    const BEGINNINGS: [&str; 7] =
        ["axis.", "mounting", "encoder", "table", "cable", "clock", "dropped"];
    BEGINNINGS.iter().any(|beginning| term.id.starts_with(beginning))
}

/// The page, in Markdown.
pub fn page() -> String {
    let mut page = HEAD.to_string();
    for (heading, belongs) in TABLES {
        let _ = write!(
            page,
            "\n## {heading}\n\n\
             | effect | what it does | parameters | usual | confused with | told apart by |\n\
             | --- | --- | --- | --- | --- | --- |\n"
        );
        for term in CATALOGUE.iter().filter(|term| belongs(term)) {
            let cells = [
                effect(term),
                format!("{}<br>`{}`", term.cause, term.equation),
                parameters(term),
                usual(term),
                term.partners.iter().map(|id| format!("`{id}`")).collect::<Vec<_>>().join(", "),
                term.told_apart_by.to_string(),
            ];
            let cells = cells.map(|cell| cell.replace('|', "\\|"));
            let _ = writeln!(page, "| {} |", cells.join(" | "));
        }
    }
    page
}

fn effect(term: &Term) -> String {
    let ids: Vec<String> = term.also.iter().map(|id| format!("†`{id}`")).collect();
    let rows = [vec![format!("`{}`", term.id)], ids, vec![term.name.to_string()]];
    rows.concat().join("<br>")
}

/// Parameters of the same unit together, then the settings.
fn parameters(term: &Term) -> String {
    let mut rows: Vec<String> = runs(term)
        .map(|run| {
            let names: Vec<_> = run.iter().map(|parameter| parameter.name).collect();
            format!("{} \\[{}\\]", names.join(", "), run[0].unit.symbol)
        })
        .collect();
    rows.extend(term.settings.iter().map(|setting| {
        let default = setting.default / setting.unit.factor;
        format!("given: {} \\[{}\\], or {default}", setting.name, setting.unit.symbol)
    }));
    rows.join("<br>")
}

fn usual(term: &Term) -> String {
    let rows: Vec<String> = runs(term)
        .map(|run| match run[0].prior {
            Prior::Sheet(_) => "sheet".to_string(),
            Prior::Usual(ranges) => ranges.map(range).join(" / "),
            Prior::Anywhere(low, high) => range((low, high)),
        })
        .collect();
    rows.join("<br>")
}

fn range((low, high): (f64, f64)) -> String {
    if low < high { format!("{low} – {high}") } else { format!("{low}") }
}

/// Neighbouring parameters that have unit and magnitude in common.
fn runs(term: &Term) -> impl Iterator<Item = &'static [Parameter]> {
    term.parameters.chunk_by(|a, b| {
        let same = match (a.prior, b.prior) {
            (Prior::Usual(a), Prior::Usual(b)) => a == b,
            (Prior::Anywhere(low, high), Prior::Anywhere(l, h)) => (low, high) == (l, h),
            (Prior::Sheet(_), Prior::Sheet(_)) => true,
            _ => false,
        };
        same && a.unit == b.unit
    })
}
