//! The catalogue as a page of the book.

use std::fmt::Write as _;

use crate::catalogue::CATALOGUE;
use crate::term::{Action, Parameter, Prevalence, Prior, Term};

/// Text before the tables.
const HEAD: &str = "\
# The catalogue of effects

This catalogue lists every effect that `rins` simulates, estimates and identifies. Each effect is one item of the crate
`rins-terms`. `cargo run -p rins-terms --example catalogue_page` writes this page.

All errors are **reading minus true value**. The equation of an effect states what the effect adds to one of these signals:

| symbol | signal |
| --- | --- |
| `ω` | the rate that the gyros read |
| `f` | the specific force that the accelerometers read |
| `ζ` | the table angle that the encoder reads |
| `θ` | the rotation vector of the axis frame: a true tilt of the table, which gyros and accelerometers measure |

- `H` is a step from 0 to 1 and `t` is the time since the start of the run.
- `T` is the temperature. `T_ref` is the reference temperature of the model, by default 20 °C.
- An effect with x, y and z has one parameter for each axis.
- The typical ranges of gyros apply to IMUs with **fiber-optic gyros / laser gyros / MEMS**, and those of accelerometers to
  pendulous / vibrating beam / MEMS. A single range applies to any table and site.
- \"Data sheet\" is the 1σ of the data sheet of the IMU.
- Effects marked † share an entry, because no schedule distinguishes them.
- Effects marked ‡ need a particular principle of the sensor, a construction or an accident. Their prior odds are lower by a factor of e.
";

type Belongs = fn(&Term) -> bool;

/// Tables of the page: heading and selection of the terms.
const TABLES: [(&str, Belongs); 5] = [
    ("Gyros", |term| !is_log(term) && term.id.starts_with("gyro")),
    ("Accelerometers", |term| !is_log(term) && term.id.starts_with("accel")),
    ("Table, encoder, timing", |term| !is_log(term) && is_table(term)),
    ("Base, site, environment", |term| {
        let sensor = term.id.starts_with("gyro") || term.id.starts_with("accel");
        !is_log(term) && !sensor && !is_table(term)
    }),
    ("Errors of a log", is_log),
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
             | effect | cause and equation | parameters | typical range | similar effects | discriminating test |\n\
             | --- | --- | --- | --- | --- | --- |\n"
        );
        for term in CATALOGUE.iter().filter(|term| belongs(term)) {
            let cells = [
                effect(term),
                format!("{}<br>`{}`", term.cause, term.equation),
                parameters(term),
                typical_range(term),
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
    let mark = if term.prevalence == Prevalence::Particular { "‡" } else { "" };
    let rows = [vec![format!("`{}`", term.id)], ids, vec![format!("{}{mark}", term.name)]];
    rows.concat().join("<br>")
}

/// Parameters grouped by unit, then the settings.
fn parameters(term: &Term) -> String {
    let mut rows: Vec<String> = runs(term)
        .map(|run| {
            let names: Vec<_> = run.iter().map(|parameter| parameter.name).collect();
            format!("{} \\[{}\\]", names.join(", "), run[0].unit.symbol)
        })
        .collect();
    rows.extend(term.settings.iter().map(|setting| {
        let default = setting.default / setting.unit.factor;
        format!("setting: {} \\[{}\\], default {default}", setting.name, setting.unit.symbol)
    }));
    rows.join("<br>")
}

fn typical_range(term: &Term) -> String {
    let rows: Vec<String> = runs(term)
        .map(|run| match run[0].prior {
            Prior::Sheet(_) => "data sheet".to_string(),
            Prior::Usual(ranges) => ranges.map(range).join(" / "),
            Prior::Anywhere(low, high) => range((low, high)),
        })
        .collect();
    rows.join("<br>")
}

fn range((low, high): (f64, f64)) -> String {
    if low < high { format!("{low} – {high}") } else { format!("{low}") }
}

/// Groups of consecutive parameters with the same unit and typical range.
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
