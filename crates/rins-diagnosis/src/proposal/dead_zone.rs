//! A dead zone, which has no slope at the width zero: it is tried at one width after the other.

use rins_frames::units::DEG_PER_HOUR;
use rins_terms::{
    Action, Dual64, DualVector, KinematicState, Role, Setting, SettingKind, Signals, Term,
    TermInstance, Unit, catalogue::GYRO_DEAD_ZONE,
};

use crate::proposal::candidates::Candidate;

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
    Setting {
        kind: SettingKind::RateThreshold,
        name,
        meaning: "rate below which the gyro reads zero",
        unit: Unit::DEG_PER_HOUR,
        default: 0.0,
        within: (0.0, WIDTHS[0]),
    }
}

/// The dead zone of given widths, of any depth: linear, and at a depth that is the width the true one.
static OF_WIDTHS: Term = Term {
    settings: &[width("width_x"), width("width_y"), width("width_z"), GYRO_DEAD_ZONE.settings[0]],
    action: Action::Sensed(as_deep),
    ..GYRO_DEAD_ZONE
};

/// The same of the gyros across the spin axis alone.
static ACROSS_OF_WIDTHS: Term = Term {
    parameters: GYRO_DEAD_ZONE.parameters.split_at(ACROSS).0,
    settings: &[width("width_x"), width("width_y"), GYRO_DEAD_ZONE.settings[0]],
    ..OF_WIDTHS
};

/// Adds what is lost in zones of so many depths: the settings are their widths, and about which axes they are.
fn as_deep(
    depths: &[Dual64],
    settings: &[f64],
    moment: &KinematicState,
    sensed: &DualVector,
    out: &mut Signals,
) {
    let (widths, axes) = settings.split_at(depths.len());
    let mut zone = Signals::default();
    let mut whole = [Dual64::from_re(0.0); 3];
    for (whole, &width) in whole.iter_mut().zip(widths) {
        whole.re = width;
    }
    GYRO_DEAD_ZONE.act_on((&whole, axes), moment, sensed, &mut zone);
    for (axis, &depth) in depths.iter().enumerate() {
        if widths[axis] > 0.0 {
            // What turns its axes does nothing to a zone that is not there.
            out.gyro[axis] += depth * (zone.gyro[axis].re / widths[axis]);
        }
    }
}

/// A dead zone in every width, the same for the gyros across the spin axis, about either axes.
pub(crate) fn shapes() -> Vec<Candidate> {
    let about = |axes: f64| WIDTHS.map(|width| across([width; ACROSS], axes));
    AXES.into_iter().flat_map(about).collect()
}

/// The dead zone that was found, and every one that a further gyro has besides.
pub(crate) fn with_another(zone: &TermInstance) -> Vec<Candidate> {
    let axes = zone.settings[0];
    let nothing = vec![0.0; zone.values.len()];
    let mut list = vec![tried(linear(zone).with_values(&nothing))];
    let widths = [0, 1].map(|gyro| zone.values[gyro]);
    for gyro in (0..ACROSS).filter(|&gyro| widths[gyro] == 0.0) {
        for another in WIDTHS {
            let mut widths = widths;
            widths[gyro] = another;
            list.push(across(widths, axes));
        }
    }
    list
}

fn across([x, y]: [f64; ACROSS], axes: f64) -> Candidate {
    let mut chosen = TermInstance::new(&ACROSS_OF_WIDTHS);
    chosen.settings.copy_from_slice(&[x, y, axes]);
    tried(chosen)
}

fn tried(shape: TermInstance) -> Candidate {
    let (widths, axes) = shape.settings.split_at(shape.values.len());
    // Each width of its own has been sought.
    let own = |&place: &usize| widths[place] > 0.0 && !widths[..place].contains(&widths[place]);
    let widths: f64 = (0..widths.len()).filter(own).map(|_| WIDTHS.len() as f64).product();
    let often = if axes[0] == 0.0 { OWN } else { 1.0 - OWN };
    Candidate { chosen: shape.estimated(), looks: widths / often, step: None, departs: None }
}

/// Whether this is a dead zone of given widths.
pub(crate) fn is_of_widths(chosen: &TermInstance) -> bool {
    chosen.term.is(&OF_WIDTHS) && chosen.settings.len() > GYRO_DEAD_ZONE.settings.len()
}

/// Whether this is a dead zone whose widths are its parameters.
pub(crate) fn is_true(chosen: &TermInstance) -> bool {
    chosen.term.is(&GYRO_DEAD_ZONE) && !is_of_widths(chosen)
}

/// What stands for a dead zone of these widths where a model has to be linear from there down to nothing.
pub(crate) fn linear(zone: &TermInstance) -> TermInstance {
    let settings = [&zone.values[..], &zone.settings].concat();
    TermInstance { term: &OF_WIDTHS, settings, ..zone.clone() }
}

/// The true dead zone of which a shape is one width, of these gyros and of no other.
pub(crate) fn of_shape(shape: &TermInstance, gyros: &[usize]) -> TermInstance {
    let mut zone = TermInstance::new(&GYRO_DEAD_ZONE);
    zone.settings.copy_from_slice(&shape.settings[shape.values.len()..]);
    for &gyro in gyros {
        zone.values[gyro] = shape.settings[gyro];
        zone.roles[gyro] = Role::Free;
    }
    zone
}

/// Whether depths \[rad/s\], of these gyros, are those of a zone of these widths.
pub(crate) fn is_as_deep(shape: &TermInstance, gyros: &[usize], depths: &[f64]) -> bool {
    gyros.iter().zip(depths).all(|(&gyro, depth)| {
        let width = shape.settings[gyro];
        width > 0.0 && (width / AS_DEEP..=width * AS_DEEP).contains(depth)
    })
}
