//! A dead zone, which has no slope at the width zero: it is tried at one width after the other.

use rins_frames::units::DEG_PER_HOUR;
use rins_terms::{
    Action, Chosen, Dual64, Role, Setting, Signals, Term, Unit, catalogue::GYRO_DEAD_ZONE,
};

use crate::candidates::Candidate;

/// The widths that are tried \[rad/s\]: wider than what a gyro sees of the Earth's rate at most none can be told, and the
/// next one explains nearly all of what one in between does.
const WIDTHS: [f64; 16] = {
    let mut widths = [10.0 * DEG_PER_HOUR; 16];
    let mut place = 1;
    while place < widths.len() {
        widths[place] = widths[place - 1] / 1.5;
        place += 1;
    }
    widths
};

/// A zone is as deep as it is wide. One that is found this many times deeper or shallower than the width at which it is
/// tried is of another width, or another effect.
const AS_DEEP: f64 = 2.0;

/// The gyros across the spin axis, the first two. That about it is slow enough at rests alone, where an encoder's noise leaves
/// a rate uncertain by more than a zone is wide, and so what is lost by it.
const ACROSS: usize = 2;

/// About which axes a zone may be: the gyros' own, or the body's.
const AXES: [f64; 2] = [0.0, 1.0];

/// How often a zone is about the gyros' own axes.
const OWN: f64 = 0.9;

const fn width(name: &'static str) -> Setting {
    let meaning = "below which rate the gyro shows nothing";
    Setting { name, meaning, unit: Unit::DEG_PER_HOUR, default: 0.0, within: (0.0, WIDTHS[0]) }
}

/// The dead zone of given widths, of any depth: linear, and at a depth that is the width the true one.
static OF_WIDTHS: Term = Term {
    settings: &[width("width_x"), width("width_y"), width("width_z"), GYRO_DEAD_ZONE.settings[0]],
    action: Action::Sensed(|depths, settings, moment, sensed, out| {
        let (widths, axes) = settings.split_at(depths.len());
        let mut zone = Signals::default();
        let whole = [0, 1, 2].map(|axis| Dual64::from_re(widths[axis]));
        GYRO_DEAD_ZONE.act_on((&whole, axes), moment, sensed, &mut zone);
        for (axis, &depth) in depths.iter().enumerate() {
            if widths[axis] > 0.0 {
                // What turns its axes does nothing to a zone that is not there.
                out.gyro[axis] += depth * (zone.gyro[axis].re / widths[axis]);
            }
        }
    }),
    ..GYRO_DEAD_ZONE
};

/// A dead zone in every width, the same for the gyros across the spin axis, about either axes.
pub(crate) fn shapes() -> Vec<Candidate> {
    let about = |axes: f64| WIDTHS.map(|width| of_widths(&[width, width, 0.0], axes));
    AXES.into_iter().flat_map(about).collect()
}

/// The dead zone that was found, and every one that a further gyro has besides.
pub(crate) fn with_another(zone: &Chosen) -> Vec<Candidate> {
    let (widths, axes) = (&zone.values, zone.settings[0]);
    let mut list = vec![of_widths(widths, axes)];
    for axis in (0..ACROSS).filter(|&axis| widths[axis] == 0.0) {
        for another in WIDTHS {
            let mut widths = widths.clone();
            widths[axis] = another;
            list.push(of_widths(&widths, axes));
        }
    }
    list
}

fn of_widths(widths: &[f64], axes: f64) -> Candidate {
    let mut chosen = Chosen::new(&OF_WIDTHS).estimated();
    chosen.settings = [widths, &[axes]].concat();
    // Each width of its own has been sought.
    let own = |&place: &usize| widths[place] > 0.0 && !widths[..place].contains(&widths[place]);
    let widths: f64 = (0..widths.len()).filter(own).map(|_| WIDTHS.len() as f64).product();
    let often = if axes == 0.0 { OWN } else { 1.0 - OWN };
    Candidate { chosen, looks: widths / often, step: None }
}

/// Whether this is a dead zone of given widths.
pub(crate) fn is_of_widths(chosen: &Chosen) -> bool {
    chosen.term.id == OF_WIDTHS.id && chosen.settings.len() == OF_WIDTHS.settings.len()
}

/// Whether this is a dead zone whose widths are its parameters.
pub(crate) fn is_true(chosen: &Chosen) -> bool {
    chosen.term.id == GYRO_DEAD_ZONE.id && !is_of_widths(chosen)
}

/// What stands for a dead zone of these widths where a model has to be linear from there down to nothing.
pub(crate) fn linear(zone: &Chosen) -> Chosen {
    let settings = [&zone.values[..], &zone.settings].concat();
    Chosen { term: &OF_WIDTHS, settings, ..zone.clone() }
}

/// Whether a shape is that of a true dead zone.
pub(crate) fn is_shape_of(shape: &Chosen, zone: &Chosen) -> bool {
    is_of_widths(shape) && shape.settings == linear(zone).settings
}

/// The true dead zone of which a shape is one width, of these gyros and of no other.
pub(crate) fn of_shape(shape: &Chosen, gyros: &[usize]) -> Chosen {
    let mut zone = Chosen::new(&GYRO_DEAD_ZONE);
    zone.settings.copy_from_slice(&shape.settings[zone.values.len()..]);
    for &gyro in gyros {
        zone.values[gyro] = shape.settings[gyro];
        zone.roles[gyro] = Role::Free;
    }
    zone
}

/// Whether depths \[rad/s\], of these gyros, are those of a zone of these widths.
pub(crate) fn is_as_deep(shape: &Chosen, gyros: &[usize], depths: &[f64]) -> bool {
    gyros.iter().zip(depths).all(|(&gyro, depth)| {
        let width = shape.settings[gyro];
        width > 0.0 && (width / AS_DEEP..=width * AS_DEEP).contains(depth)
    })
}
