//! Which parameters are meant by what was typed.

use std::path::Path;

use rins_design::Effect;
use rins_imu::ImuSpec;
use rins_io::{ModelFile, Quantity, nearest};
use rins_terms::{Model, Role, Term, TermInstance, catalogue};

/// A parameter and the 1σ that is wanted of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Want {
    /// The parameter's id, as it was asked for.
    pub id: String,
    /// More than zero.
    pub sigma: Quantity,
    /// The sigma as it was asked for.
    pub typed: String,
}

/// The model file that `name` is, if it is one.
pub(crate) fn model_file(name: &str) -> Option<&Path> {
    let file = Path::new(name);
    file.extension().is_some_and(|ending| ending == "toml").then_some(file)
}

/// The model of a preset, or of a file.
pub(crate) fn model(name: &str) -> anyhow::Result<Model> {
    match name {
        "full" => Ok(Model::full()),
        "paper12" => Ok(Model::paper12()),
        "baseline" => Ok(baseline()),
        "all" => Ok(everything()),
        other => match model_file(other) {
            Some(file) => Ok(ModelFile::read(file)?.model),
            None => anyhow::bail!(
                "{other:?} is no model{}: full, paper12, baseline, all, or a file that ends in .toml",
                suggestion(other, ["full", "paper12", "baseline", "all"])
            ),
        },
    }
}

/// What every run on a table leaves open: biases, attitude, mounting, and the gyro errors tied to the spin axis.
fn baseline() -> Model {
    let terms = [
        &catalogue::GYRO_BIAS,
        &catalogue::ACCEL_BIAS,
        &catalogue::AXIS_ATTITUDE,
        &catalogue::MOUNTING,
    ];
    let mut model = Model { terms: terms.map(sought).to_vec() };
    model.terms.extend(Model::paper12().terms);
    model
}

/// Every term of the catalogue that adds to signals.
fn everything() -> Model {
    let terms = catalogue::CATALOGUE.iter().filter(|term| term.is_signal());
    Model { terms: terms.map(|term| sought(term)).collect() }
}

/// A term whose parameters are sought, where it is linear.
fn sought(term: &'static Term) -> TermInstance {
    let mut chosen = TermInstance::new(term).estimated();
    if term.is(&catalogue::GYRO_DEAD_ZONE) {
        // Its square counts: a width of zero shows nothing, a usual one does.
        for (value, parameter) in chosen.values.iter_mut().zip(term.parameters) {
            *value = parameter.range(&USUAL).1;
        }
    }
    chosen
}

/// A data sheet of nothing in particular, which is that of a fibre gyro.
const USUAL: ImuSpec = {
    let triad = rins_imu::TriadSpec::white(0.0, 0.0, 0.0, 0.0);
    ImuSpec { gyro: triad, accel: triad }
};

/// The effect that a term's or a parameter's id asks for.
pub(crate) fn effect(asked: &str) -> anyhow::Result<Effect> {
    let whole = catalogue::term(asked);
    let parameter = || {
        let (term, name) = asked.rsplit_once('.')?;
        let term = catalogue::term(term)?;
        term.parameters.iter().any(|parameter| parameter.name == name).then_some(term)
    };
    let Some(term) = whole.or_else(parameter) else {
        let ids: Vec<String> = catalogue::CATALOGUE
            .iter()
            .flat_map(|term| std::iter::once(term.id.to_owned()).chain(term.parameter_ids()))
            .collect();
        let near = suggestion(asked, ids.iter().map(String::as_str));
        let hint =
            if near.is_empty() { "; `rins observe --model all SCENARIO` lists them" } else { "" };
        anyhow::bail!("there is no effect or parameter {asked:?}{near}{hint}");
    };
    anyhow::ensure!(
        term.is_signal(),
        "{} changes the noise or the log and adds nothing to any signal: no schedule is better for it than another",
        term.id
    );
    let name = asked.rsplit_once('.').map_or("", |(_, name)| name);
    let ids = if whole.is_some() {
        term.parameter_ids().collect()
    } else {
        vec![format!("{}.{name}", term.id)]
    };
    Ok(Effect { name: asked.into(), ids, term })
}

/// The same model, in which an effect is sought.
pub(crate) fn with(mut model: Model, effect: &Effect) -> Model {
    let place = model.terms.iter().position(|chosen| chosen.term.is(effect.term));
    let chosen = match place {
        Some(place) => &mut model.terms[place],
        None => {
            let mut chosen = sought(effect.term);
            chosen.roles.fill(Role::Held);
            model.terms.push(chosen);
            model.terms.last_mut().expect("it was just added")
        }
    };
    for (name, role) in effect.term.parameter_ids().zip(&mut chosen.roles) {
        if effect.ids.contains(&name) && *role == Role::Held {
            *role = Role::Free;
        }
    }
    model
}

/// A parameter and the 1σ that is wanted of it, in SI units.
pub(super) fn wanted(want: &Want) -> anyhow::Result<(Effect, f64)> {
    let Want { id, sigma, typed } = want;
    let effect = effect(id)?;
    anyhow::ensure!(
        effect.ids.len() == 1,
        "{} has several parameters, of which one is meant: {}",
        effect.term.id,
        effect.ids.join(", ")
    );
    let name = effect.ids[0].rsplit_once('.').map_or("", |(_, name)| name);
    let parameter = effect.term.parameters.iter().find(|parameter| parameter.name == name);
    let unit = parameter.expect("an effect's ids are of its parameters").unit;
    let one = Quantity::parse(&format!("1 {}", unit.symbol)).ok().map(|one| one.dimension);
    anyhow::ensure!(
        one.is_none_or(|dimension| dimension == sigma.dimension),
        "{id}={typed}: expected a quantity such as \"1 {}\"",
        unit.symbol
    );
    Ok((effect, sigma.value))
}

fn suggestion<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> String {
    nearest(word, candidates).map_or_else(String::new, |near| format!("; did you mean {near:?}?"))
}
