//! Terms written to files.

use std::fmt::Write as _;

use rins_terms::{Chosen, Model, Role, Unit};

use super::read::Use;
use crate::parameter::Parameter;

/// A term as a `[[term]]` of a file.
pub(crate) fn written(chosen: &Chosen, use_: Use) -> String {
    let term = chosen.term;
    let mut text = format!("\n[[term]]\nid = {:?}\n", term.id);
    // Writing to a string cannot fail, here and below.
    for (setting, &value) in term.settings.iter().zip(&chosen.settings) {
        let _ = writeln!(text, "{} = {}", setting.name, quantity(value, setting.unit));
    }
    let names = |of: &dyn Fn(&Role) -> bool| -> Vec<&str> {
        let pairs = term.parameters.iter().zip(&chosen.roles);
        pairs.filter(|(_, role)| of(role)).map(|(parameter, _)| parameter.name).collect()
    };
    let held = names(&|role| *role == Role::Held);
    let estimate = if held.is_empty() {
        "true".to_string()
    } else if held.len() == chosen.roles.len() {
        "false".to_string()
    } else {
        format!("{:?}", names(&|role| *role != Role::Held))
    };
    if term.is_signal() {
        let _ = writeln!(text, "estimate = {estimate}");
    }
    for (parameter, &value) in term.parameters.iter().zip(&chosen.values) {
        if use_ == Use::Calibration || value != 0.0 {
            let _ = writeln!(text, "{} = {}", parameter.name, quantity(value, parameter.unit));
        }
    }
    let sigmas = term.parameters.iter().zip(&chosen.roles).filter_map(|(parameter, role)| {
        let Role::Within(sigma) = role else { return None };
        Some(format!("{} = {}", parameter.name, quantity(*sigma, parameter.unit)))
    });
    let sigmas: Vec<String> = sigmas.collect();
    if !sigmas.is_empty() {
        let _ = writeln!(text, "sigma = {{ {} }}", sigmas.join(", "));
    }
    text
}

/// A number in SI units as TOML, in `unit`.
fn quantity(value: f64, unit: Unit) -> String {
    let number = value / unit.factor;
    if unit == Unit::ONE { format!("{number}") } else { format!("\"{number} {}\"", unit.symbol) }
}

/// The parameters of the term at place `term` of a model, in their units.
pub(crate) fn parameters(model: &Model, term: usize) -> Vec<Parameter> {
    let chosen = &model.terms[term];
    let pairs = chosen.term.parameters.iter().zip(&chosen.values).enumerate();
    pairs
        .map(|(place, (parameter, &value))| Parameter {
            id: model.id(term, place),
            value: value / parameter.unit.factor,
            unit: parameter.unit.symbol,
        })
        .collect()
}
