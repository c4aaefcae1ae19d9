//! Terms written to files.

use std::fmt::Write as _;

use rins_frames::SignedAxes;
use rins_terms::{Model, Role, TermInstance, Unit};

use super::read::Use;
use crate::parameter::Parameter;

/// A term of a run with these axes as a `[[term]]` of a file, along the sensors' own axes.
pub(crate) fn written(chosen: &TermInstance, use_: Use, axes: &SignedAxes) -> String {
    let term = chosen.term;
    let (own, order) = (term.own_names(axes), term.own_order(axes));
    let settings = term.own_settings(&chosen.settings, axes);
    let mut text = format!("\n[[term]]\nid = {:?}\n", term.id);
    // Writing to a string cannot fail, here and below.
    for (setting, &value) in term.settings.iter().zip(&settings) {
        let _ = writeln!(text, "{} = {}", setting.name, quantity(value, setting.unit));
    }
    let names = |of: &dyn Fn(&Role) -> bool| -> Vec<&str> {
        let places = order.iter().filter(|place| of(&chosen.roles[**place]));
        places.map(|&place| own[place].as_str()).collect()
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
    for &place in &order {
        let ((_, sign), value) = (chosen.own(place, axes), chosen.values[place]);
        if use_ == Use::Calibration || value != 0.0 {
            // Adding zero avoids a negative zero.
            let value = quantity(sign * value + 0.0, term.parameters[place].unit);
            let _ = writeln!(text, "{} = {value}", own[place]);
        }
    }
    let sigmas = order.iter().filter_map(|&place| {
        let Role::Within(sigma) = chosen.roles[place] else { return None };
        Some(format!("{} = {}", own[place], quantity(sigma, term.parameters[place].unit)))
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

/// The parameters of the term at index `term` of the model of a run with these axes, along the sensors' own axes and in their units.
pub(crate) fn parameters(model: &Model, term: usize, axes: &SignedAxes) -> Vec<Parameter> {
    let chosen = &model.terms[term];
    let own = |place: usize| {
        let unit = chosen.term.parameters[place].unit;
        let (_, sign) = chosen.own(place, axes);
        Parameter {
            id: model.own_id(term, place, axes),
            value: sign * chosen.values[place] / unit.factor,
            unit: unit.symbol,
        }
    };
    chosen.term.own_order(axes).into_iter().map(own).collect()
}
