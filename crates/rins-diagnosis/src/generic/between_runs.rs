//! Errors of the sensors that are not the same in all runs.

use rins_terms::{Model, Owner, Prevalence, Role, Term, TermInstance, catalogue};

/// An error of the sensors with a value of its own in every run.
const fn between_runs(id: &'static str, name: &'static str, of: Term) -> Term {
    Term {
        id,
        name,
        cause: "the error differs between runs: it depends on temperature, date or the time since power-on, or has changed",
        told_apart_by: "record temperature, date and the time since power-on, and compare the runs by `rins history`",
        owner: Owner::Placement,
        prevalence: Prevalence::Particular,
        ..of
    }
}

/// The scale errors of the gyros.
static GYRO_SCALE: Term = between_runs(
    "gyro_scale_between_runs",
    "scale error of a gyro that differs between runs",
    catalogue::GYRO_SCALE,
);

/// The misalignments of the gyros.
static GYRO_MISALIGNMENT: Term = between_runs(
    "gyro_misalignment_between_runs",
    "misalignment of a gyro that differs between runs",
    catalogue::GYRO_MISALIGNMENT,
);

/// The scale errors of the accelerometers.
static ACCEL_SCALE: Term = between_runs(
    "accel_scale_between_runs",
    "scale error of an accelerometer that differs between runs",
    catalogue::ACCEL_SCALE,
);

/// The misalignments of the accelerometers.
static ACCEL_MISALIGNMENT: Term = between_runs(
    "accel_misalignment_between_runs",
    "misalignment of an accelerometer that differs between runs",
    catalogue::ACCEL_MISALIGNMENT,
);

/// The errors that a model takes for the same in all runs, and what each of them is called if it is not.
static ALL: [(&Term, &Term); 4] = [
    (&catalogue::GYRO_SCALE, &GYRO_SCALE),
    (&catalogue::GYRO_MISALIGNMENT, &GYRO_MISALIGNMENT),
    (&catalogue::ACCEL_SCALE, &ACCEL_SCALE),
    (&catalogue::ACCEL_MISALIGNMENT, &ACCEL_MISALIGNMENT),
];

/// What may differ between runs of what a model estimates.
pub(crate) fn of_model(model: &Model) -> impl Iterator<Item = TermInstance> {
    let of = |(own, between): &(&Term, &'static Term)| {
        let estimated = model.terms.iter().find(|chosen| chosen.term.is(own))?;
        let mut chosen = TermInstance::new(between);
        for (role, estimated) in chosen.roles.iter_mut().zip(&estimated.roles) {
            *role = if *estimated == Role::Held { Role::Held } else { Role::Free };
        }
        chosen.roles.contains(&Role::Free).then_some(chosen)
    };
    ALL.iter().filter_map(of)
}

/// The error that is the same in all runs, of a term that is the same error with a value of its own in every run.
pub fn same_in_all_runs(term: &Term) -> Option<&'static Term> {
    ALL.iter().find(|(_, between)| between.is(term)).map(|(own, _)| *own)
}
