//! Terms read from files.

use rins_frames::SignedAxes;
use rins_terms::{Role, SettingKind, Term, TermInstance, Unit, catalogue};

use crate::document::{Entry, Node};
use crate::error::{IoError, KeyProblem};
use crate::quantity::{self, Quantity};
use crate::section::{Section, quoted};
use crate::suggestion::nearest;

/// The purpose of a term in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// Simulation: its values are true, and at least one is given.
    Effect,
    /// Estimation: all parameters are estimated, unless the file states otherwise.
    Model,
    /// Compensation: parameters with a sigma were estimated.
    Calibration,
}

/// The tables of the terms in the list behind `key`.
pub(crate) fn tables<'d>(section: &Section<'d>, key: &str) -> Result<Vec<Section<'d>>, IoError> {
    let expected = r#"a list of tables such as { id = "encoder.zero", angle = "5 arcsec" }"#;
    Ok(section.any_tables(key, expected)?.unwrap_or_default())
}

/// Refuses a bias, scale error or misalignment, which has a key of its own in the section named by `place`.
pub(crate) fn refuse_triads(
    section: &Section<'_>,
    chosen: &TermInstance,
    place: impl Fn(&str) -> String,
) -> Result<(), IoError> {
    match chosen.term.id.split_once('.') {
        Some((sensor, what @ ("bias" | "scale" | "misalignment"))) => {
            let reason = format!("{sensor}.{what} stands in {}", place(sensor));
            Err(section.conflict("id", reason))
        }
        _ => Ok(()),
    }
}

/// The term in a table along the sensors' own axes, converted to a run with these axes.
pub(crate) fn read(
    section: &Section<'_>,
    use_: Use,
    axes: &SignedAxes,
) -> Result<TermInstance, IoError> {
    let term = named(section)?;
    // Noise and events of the log are not signals, and cannot be estimated.
    let estimated = use_ != Use::Effect && term.is_signal();
    let more: &[&str] = if estimated { &["id", "estimate", "sigma"] } else { &["id"] };
    let settings = term.settings.iter().map(|setting| setting.name);
    let own = term.own_names(axes);
    let names: Vec<&str> = own.iter().map(String::as_str).collect();
    let order = term.own_order(axes);
    let known: Vec<&str> = order
        .iter()
        .map(|&place| names[place])
        .chain(settings)
        .chain(more.iter().copied())
        .collect();
    if let Some(stray) = section.keys().find(|key| !known.contains(key)) {
        // A term has few keys, so that all of them can be listed.
        let problem = KeyProblem::Unknown { suggestion: None, known: known.join(", ") };
        return Err(section.error(stray, problem));
    }
    let mut chosen = TermInstance::new(term);
    for (setting, slot) in term.settings.iter().zip(&mut chosen.settings) {
        if let Some(value) = number(section, setting.name, setting.unit)? {
            let (low, high) = setting.within;
            if !(low..=high).contains(&value) {
                let Unit { symbol, factor } = setting.unit;
                let symbol = if setting.unit == Unit::ONE { "" } else { symbol };
                let range = format!("from {} to {} {symbol}", low / factor, high / factor);
                let expected = range.trim_end();
                return Err(section.not_allowed(setting.name, expected));
            }
            *slot = value;
        }
    }
    chosen.settings = term.own_settings(&chosen.settings, &axes.inverse());
    let mut given = 0;
    for (place, name) in names.iter().enumerate() {
        if let Some(value) = number(section, name, term.parameters[place].unit)? {
            let (_, sign) = chosen.own(place, axes);
            chosen.values[place] = sign * value;
            given += 1;
        }
    }
    if let (Use::Effect, 0, Some(&first)) = (use_, given, names.first()) {
        let expected = format!("at least one of {}", names.join(", "));
        return Err(section.missing(first, expected));
    }
    if estimated {
        chosen.roles = roles(section, (term, &names), use_)?;
    }
    Ok(chosen)
}

/// The same with this reference temperature \[°C\], if the table does not state its own.
pub(crate) fn read_about(
    section: &Section<'_>,
    use_: Use,
    axes: &SignedAxes,
    reference: Option<f64>,
) -> Result<TermInstance, IoError> {
    let chosen = read(section, use_, axes)?;
    let reference = reference.filter(|_| !section.has(catalogue::REFERENCE_TEMPERATURE.name));
    let about =
        |reference| chosen.clone().with_setting(SettingKind::ReferenceTemperature, reference);
    Ok(reference.map_or(chosen.clone(), about))
}

/// The term whose id a section gives.
fn named(section: &Section<'_>) -> Result<&'static Term, IoError> {
    let expected = r#"the id of a term such as "encoder.zero""#;
    let id = section.text("id", expected)?.ok_or_else(|| section.missing("id", expected))?;
    catalogue::term(id).ok_or_else(|| {
        let ids =
            catalogue::CATALOGUE.iter().flat_map(|term| term.also.iter().copied().chain([term.id]));
        let suggestion = nearest(id, ids).map(Into::into);
        let known = "the ids of the catalogue, such as \"encoder.zero\"".into();
        section.error("id", KeyProblem::NotOneOf { value: id.into(), suggestion, known })
    })
}

/// The roles of the parameters: which are estimated, and their sigma before or after.
fn roles(
    section: &Section<'_>,
    (term, names): (&Term, &[&str]),
    use_: Use,
) -> Result<Vec<Role>, IoError> {
    let sigma_table = section.inline("sigma", names)?;
    let estimated = estimated(section, names)?;
    let mut roles = Vec::with_capacity(names.len());
    for (&name, parameter) in names.iter().zip(term.parameters) {
        let sigma = match &sigma_table {
            Some(table) => sigma_of(table, name, parameter.unit)?,
            None => None,
        };
        let free = match (&estimated, use_) {
            (Some(estimated), _) => estimated.contains(&name),
            (None, Use::Calibration) => sigma.is_some(),
            (None, _) => true,
        };
        roles.push(match (free, sigma) {
            (true, Some(sigma)) => Role::Within(sigma),
            (true, None) => Role::Free,
            (false, None) => Role::Held,
            (false, Some(_)) => {
                let table = sigma_table.as_ref().unwrap_or(section);
                return Err(table.conflict(name, "is not estimated and has no sigma"));
            }
        });
    }
    Ok(roles)
}

/// The parameters in `estimate`, if the key exists.
fn estimated<'n>(
    section: &Section<'_>,
    names: &[&'n str],
) -> Result<Option<Vec<&'n str>>, IoError> {
    let expected = || format!("true, false or a list of {}", quoted(names.iter().copied()));
    let Some(Entry { value, .. }) = section.get("estimate") else { return Ok(None) };
    let texts = match &value.node {
        Node::Flag(true) => return Ok(Some(names.to_vec())),
        Node::Flag(false) => return Ok(Some(Vec::new())),
        Node::List(_) => section.list_of_texts("estimate", &expected())?,
        _ => return Err(section.wrong_type("estimate", value, expected())),
    };
    let known = |text: &String| {
        names.iter().copied().find(|name| name == text).ok_or_else(|| {
            let known = quoted(names.iter().copied());
            let problem = KeyProblem::NotOneOf { value: text.clone(), suggestion: None, known };
            section.error("estimate", problem)
        })
    };
    texts.iter().map(known).collect::<Result<_, _>>().map(Some)
}

fn sigma_of(table: &Section<'_>, name: &str, unit: Unit) -> Result<Option<f64>, IoError> {
    match number(table, name, unit)? {
        Some(sigma) if sigma <= 0.0 => Err(table.not_allowed(name, "more than zero")),
        sigma => Ok(sigma),
    }
}

/// The number behind `key` in SI units: a quantity of the dimension of `unit`, or a bare number if the unit is a plain number.
fn number(section: &Section<'_>, key: &str, unit: Unit) -> Result<Option<f64>, IoError> {
    if unit == Unit::CELSIUS {
        return section.celsius(key);
    }
    let Some(Entry { value, .. }) = section.get(key) else { return Ok(None) };
    let plain = unit == Unit::ONE;
    let dimension = quantity::Unit::parse(unit.symbol)
        .map_err(|error| section.error(key, error.into()))?
        .dimension;
    let expected = || match (plain, dimension) {
        (true, _) => "a number such as 1".into(),
        (_, dimension) => format!("{dimension} such as \"1 {}\"", unit.symbol),
    };
    let number = match &value.node {
        Node::Integer(number) if plain => *number as f64,
        Node::Number(number) if plain => *number,
        Node::Text(text) => {
            let parsed = Quantity::parse(text).map_err(|error| section.error(key, error.into()))?;
            if parsed.dimension != dimension {
                let got = format!("{text:?} is {}", parsed.dimension);
                return Err(section.error(key, KeyProblem::WrongType { got, expected: expected() }));
            }
            parsed.value
        }
        _ => return Err(section.wrong_type(key, value, expected())),
    };
    if number.is_finite() { Ok(Some(number)) } else { Err(section.not_allowed(key, &expected())) }
}
