//! The settings of a term as text.

use rins_report::number::{estimate, figure};
use rins_terms::{Term, Unit};

/// The settings of a term, such as "order = 2"; an estimated one (`sought`) has a sigma.
pub(crate) fn settings_in_words(
    term: &Term,
    values: &[f64],
    sought: Option<(usize, f64)>,
) -> String {
    let words: Vec<String> = term
        .settings
        .iter()
        .zip(values)
        .enumerate()
        .map(|(place, (setting, value))| {
            let unit = setting.unit;
            let symbol = symbol(unit);
            if let Some((_, sigma)) = sought.filter(|(of, _)| *of == place) {
                let (value, sigma) = estimate(value / unit.factor, sigma / unit.factor);
                return format!("{} = {value} ± {sigma} {symbol}", setting.name).trim_end().into();
            }
            let value = figure(value / unit.factor, 5);
            let value = if value.contains('.') {
                value.trim_end_matches('0').trim_end_matches('.')
            } else {
                &value
            };
            format!("{} = {value} {symbol}", setting.name).trim_end().to_owned()
        })
        .collect();
    words.join(", ")
}

/// The symbol of a unit in a sentence: empty for a plain number.
pub(crate) fn symbol(unit: Unit) -> &'static str {
    if unit == Unit::ONE { "" } else { unit.symbol }
}
