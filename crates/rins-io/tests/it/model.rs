//! Model files: written, read, and refused.

use std::path::Path;

use proptest::prelude::*;
use rins_frames::units::{ARCSEC, DEG_PER_HOUR};
use rins_io::{IoError, ModelFile};
use rins_terms::catalogue::{CATALOGUE, MOST_PARAMETERS};
use rins_terms::{Model, Role, TermInstance};

use crate::support::assert_refused;

/// The relative change by writing a number in its unit and reading it again: one rounding error each way.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

const TEXT: &str = r#"
schema = 1
base = "paper12"

[[term]]
id = "gyro.bias"
sigma = { z = "0.1 deg/h" }

[[term]]
id = "gyro.scale"
estimate = false
x = "100 ppm"

[[term]]
id = "mounting"
estimate = ["y"]
x = "5 arcsec"
"#;

fn parse(text: &str) -> Result<Model, IoError> {
    ModelFile::parse(text, Path::new("model.toml")).map(|file| file.model)
}

#[test]
fn a_model_is_its_base_and_what_is_listed() {
    let model = parse(TEXT).unwrap();
    let ids: Vec<&str> = model.terms.iter().map(|chosen| chosen.term.id).collect();
    assert_eq!(ids, ["gyro.scale", "gyro.misalignment", "gyro.bias", "mounting"]);
    // A term that is listed again has the listed roles: S_z, which the base estimates, is held.
    assert_eq!(model.terms[0].roles, [Role::Held; 3]);
    assert!((model.terms[0].values[0] - 1e-4).abs() < 1e-18);
    assert_eq!(model.terms[1], Model::paper12().terms[1]);
    let [Role::Free, Role::Free, Role::Within(sigma)] = model.terms[2].roles[..] else {
        panic!("{:?}", model.terms[2].roles)
    };
    assert!((sigma - 0.1 * DEG_PER_HOUR).abs() < 1e-21);
    assert_eq!(model.terms[3].roles, [Role::Held, Role::Free]);
    assert!((model.terms[3].values[0] - 5.0 * ARCSEC).abs() < 1e-19);
}

#[test]
fn presets_are_bases_alone() {
    for (model, base) in
        [(Model::full(), "full"), (Model::paper12(), "paper12"), (Model::default(), "none")]
    {
        let text = ModelFile::of(model.clone()).to_toml();
        assert!(text.ends_with(&format!("schema = 1\nbase = {base:?}\n")), "{text}");
        assert_eq!(parse(&text).unwrap(), model);
    }
}

/// A term of the catalogue with any valid settings, values and roles.
fn any_chosen() -> impl Strategy<Value = TermInstance> {
    let numbers = || prop::collection::vec(0.0..1.0_f64, MOST_PARAMETERS);
    (
        prop::sample::select(CATALOGUE),
        numbers(),
        numbers(),
        prop::collection::vec(0..3_u8, MOST_PARAMETERS),
    )
        .prop_map(|(term, settings, values, roles)| {
            let mut chosen = TermInstance::new(term);
            for ((slot, setting), part) in
                chosen.settings.iter_mut().zip(term.settings).zip(settings)
            {
                *slot = setting.within.0 + part * (setting.within.1 - setting.within.0);
            }
            for (place, parameter) in term.parameters.iter().enumerate() {
                chosen.values[place] = (values[place] - 0.5) * parameter.unit.factor;
                chosen.roles[place] = match roles[place] {
                    _ if !term.is_signal() => Role::Held,
                    0 => Role::Held,
                    1 => Role::Free,
                    _ => Role::Within(values[place] * parameter.unit.factor + 1e-9),
                };
            }
            chosen
        })
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * b.abs()
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(
        base in 0..3_usize,
        terms in prop::collection::vec(any_chosen(), 0..6),
    ) {
        let mut model = [Model::full(), Model::paper12(), Model::default()][base].clone();
        for chosen in terms {
            let listed = |other: &&mut TermInstance| {
                other.term.id == chosen.term.id && other.settings == chosen.settings
            };
            match model.terms.iter_mut().find(listed) {
                Some(other) => *other = chosen,
                None => model.terms.push(chosen),
            }
        }
        let text = ModelFile::of(model.clone()).to_toml();
        let again = parse(&text).unwrap();
        prop_assert_eq!(again.terms.len(), model.terms.len());
        for (got, want) in again.terms.iter().zip(&model.terms) {
            prop_assert_eq!(got.term.id, want.term.id);
            let numbers = got.values.iter().chain(&got.settings);
            for (got, want) in numbers.zip(want.values.iter().chain(&want.settings)) {
                prop_assert!(near(*got, *want), "{} is {} in {}", want, got, text);
            }
            for (got, want) in got.roles.iter().zip(&want.roles) {
                let same = match (got, want) {
                    (Role::Within(got), Role::Within(want)) => near(*got, *want),
                    (got, want) => got == want,
                };
                prop_assert!(same, "{:?} is {:?} in {}", want, got, text);
            }
        }
    }
}

#[rustfmt::skip]
const CASES: &[(&str, &str, &str)] = &[
    ("schema = 1\n", "", "model.toml: schema: missing, expected 1"),
    ("schema = 1", "schema = 2", "model.toml:2: schema: 2 is not allowed, expected 1"),
    ("base = \"paper12\"\n", "", "model.toml: base: missing, expected one of \"full\", \"paper12\", \"none\""),
    ("\"paper12\"", "\"papers12\"", "model.toml:3: base: \"papers12\" is not known; did you mean \"paper12\"?"),
    ("[[term]]\nid = \"gyro.bias\"", "[[terms]]\nid = \"gyro.bias\"", "model.toml:5: terms: unknown key; did you mean \"term\"?"),
    ("\"gyro.bias\"", "\"gyro.bia\"", "model.toml:6: term[1].id: \"gyro.bia\" is not known; did you mean \"gyro.bias\"?"),
    ("id = \"gyro.bias\"\n", "", "model.toml:5: term[1].id: missing, expected the id of a term such as \"encoder.zero\""),
    ("\"0.1 deg/h\"", "\"0.1 deg\"", "model.toml:7: term[1].sigma.z: \"0.1 deg\" is an angle, expected an angular rate such as \"1 deg/h\""),
    ("\"0.1 deg/h\"", "\"0 deg/h\"", "model.toml:7: term[1].sigma.z: \"0 deg/h\" is not allowed, expected more than zero"),
    ("{ z = \"0.1 deg/h\" }", "{ w = \"0.1 deg/h\" }", "model.toml:7: term[1].sigma.w: unknown key, expected one of x, y, z"),
    ("{ z = \"0.1 deg/h\" }", "\"0.1 deg/h\"", "model.toml:7: term[1].sigma: \"0.1 deg/h\" is a text, expected a table with the keys x, y, z"),
    ("estimate = false", "estimate = false\nsigma = { x = \"1 ppm\" }", "model.toml:12: term[2].sigma.x: is not estimated and has no sigma"),
    ("estimate = false", "estimate = \"x\"", "model.toml:11: term[2].estimate: \"x\" is a text, expected true, false or a list of \"x\", \"y\", \"z\""),
    ("[\"y\"]", "[\"z\"]", "model.toml:16: term[3].estimate: \"z\" is not known, expected one of \"x\", \"y\""),
    ("x = \"5 arcsec\"", "q = \"5 arcsec\"", "model.toml:17: term[3].q: unknown key, expected one of x, y, id, estimate, sigma"),
    ("\"mounting\"\nestimate = [\"y\"]\nx = \"5 arcsec\"", "\"gyro.scale\"", "model.toml:15: term[3].id: gyro.scale is listed twice"),
];

#[test]
fn wrong_models_are_refused_with_file_line_key_and_expectation() {
    assert_refused(TEXT, CASES, parse);
}
