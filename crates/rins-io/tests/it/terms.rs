//! Every term of the catalogue can be written to a file: its units are known, and its keys do not conflict.

use std::collections::BTreeSet;

use rins_io::Unit;
use rins_terms::catalogue::CATALOGUE;

#[test]
fn the_units_of_all_terms_are_those_of_files() {
    for term in CATALOGUE {
        let parameters = term.parameters.iter().map(|parameter| (parameter.name, parameter.unit));
        let settings = term.settings.iter().map(|setting| (setting.name, setting.unit));
        for (name, unit) in parameters.chain(settings) {
            let parsed = Unit::parse(unit.symbol)
                .unwrap_or_else(|error| panic!("{}.{name} is in {error}", term.id));
            let off = (parsed.factor / unit.factor - 1.0).abs();
            assert!(off < 1e-14, "{}.{name}: a {} is {}", term.id, unit.symbol, parsed.factor);
        }
    }
}

#[test]
fn no_two_keys_of_a_term_are_the_same() {
    for term in CATALOGUE {
        let parameters = term.parameters.iter().map(|parameter| parameter.name);
        let settings = term.settings.iter().map(|setting| setting.name);
        let more: &[&str] = if term.is_signal() { &["id", "estimate", "sigma"] } else { &["id"] };
        let keys: Vec<&str> = parameters.chain(settings).chain(more.iter().copied()).collect();
        let different: BTreeSet<&str> = keys.iter().copied().collect();
        assert_eq!(different.len(), keys.len(), "{}: {keys:?}", term.id);
    }
}
