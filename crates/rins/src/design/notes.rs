//! Remarks on a designed schedule.

use super::goal::DesignGoal;
use super::study::DesignStudy;

/// What else is to be known.
pub(super) fn notes(study: &DesignStudy) -> Vec<String> {
    let mut notes = vec![
        "All runs are of one power-on: the turn-on biases are the same in each, also in the schedules beside it. The time for a change of \
         the orientation is not counted."
            .to_owned(),
        format!(
            "{} candidates: rotation at the fastest rate and at half of it, both ways, and eight static intervals, in {} orientations of \
             the axis.",
            study.optimal.candidates.0, study.optimal.candidates.1
        ),
    ];
    if matches!(study.goal, DesignGoal::Position(_)) {
        notes.push(
            "The system in service aligns itself with its calibrated sensors, and stays on since the calibration. The white noise in service, \
             which no calibration changes, is not included."
                .into(),
        );
    }
    if study.is_time_dependent {
        notes.push(
            "The model has terms with settings, such as the time of an event. Their information does not add up over motions: the gap does not \
             hold for them; the values of the schedules do."
                .into(),
        );
    }
    notes
}
