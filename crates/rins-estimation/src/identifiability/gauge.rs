//! Gauges: combinations that no schedule makes observable, because they are a matter of definition.

use rins_terms::{Term, catalogue};

/// A set of parameters of which one combination is a choice of axes, units or origin.
#[derive(Clone, Copy, Debug)]
pub struct Gauge {
    /// The choice, such as "the zero of the table angle".
    pub name: &'static str,
    /// The reason why it is unobservable, and the remedy.
    pub why: &'static str,
    /// The parameters of the combination, each with its term and its name there. At least one of each alternative must be
    /// free; otherwise the choice is made.
    pub members: &'static [&'static [(&'static Term, &'static str)]],
}

const MOUNTING: &str = "a common tilt of gyros and accelerometers equals a tilt of the IMU; fix the \
                        mounting, or the misalignments xz and yz of one triad";

/// All known gauges, the smallest first.
pub static GAUGES: &[Gauge] = &[
    Gauge {
        name: "the zero of the table angle",
        why: "the zero of the encoder and the angle of the axis frame about the spin axis are not \
              distinguishable; fix one",
        members: &[&[(&catalogue::ENCODER_ZERO, "angle")], &[(&catalogue::AXIS_ATTITUDE, "z")]],
    },
    Gauge {
        name: "the origin of time",
        why: "only two of the three latencies of gyros, accelerometers and encoder are observable; fix one",
        members: &[
            &[(&catalogue::GYRO_LAG, "delay")],
            &[(&catalogue::ACCEL_LATENCY, "delay")],
            &[(&catalogue::ENCODER_LATENCY, "delay")],
        ],
    },
    Gauge {
        name: "the unit of force",
        why: "an error of gravity equals a common scale error of the accelerometers; survey gravity",
        members: &[
            &[(&catalogue::WRONG_GRAVITY, "gravity")],
            &[(&catalogue::ACCEL_SCALE, "x")],
            &[(&catalogue::ACCEL_SCALE, "y")],
            &[(&catalogue::ACCEL_SCALE, "z")],
        ],
    },
    Gauge {
        name: "the body axes about the spin axis",
        why: "a common rotation of both triads about it is only another choice of body axes; fix \
              accel.misalignment.xy or yx",
        members: &[
            &[(&catalogue::GYRO_MISALIGNMENT, "xy")],
            &[(&catalogue::GYRO_MISALIGNMENT, "yx")],
            &[(&catalogue::ACCEL_MISALIGNMENT, "xy")],
            &[(&catalogue::ACCEL_MISALIGNMENT, "yx")],
            &[(&catalogue::ENCODER_ZERO, "angle"), (&catalogue::AXIS_ATTITUDE, "z")],
        ],
    },
    Gauge {
        name: "the mounting of the IMU on the table about x",
        why: MOUNTING,
        members: &[
            &[(&catalogue::MOUNTING, "x")],
            &[(&catalogue::GYRO_MISALIGNMENT, "yz")],
            &[(&catalogue::GYRO_MISALIGNMENT, "zy")],
            &[(&catalogue::ACCEL_MISALIGNMENT, "yz")],
            &[(&catalogue::ACCEL_MISALIGNMENT, "zy")],
        ],
    },
    Gauge {
        name: "the mounting of the IMU on the table about y",
        why: MOUNTING,
        members: &[
            &[(&catalogue::MOUNTING, "y")],
            &[(&catalogue::GYRO_MISALIGNMENT, "xz")],
            &[(&catalogue::GYRO_MISALIGNMENT, "zx")],
            &[(&catalogue::ACCEL_MISALIGNMENT, "xz")],
            &[(&catalogue::ACCEL_MISALIGNMENT, "zx")],
        ],
    },
];

impl PartialEq for Gauge {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Gauge {}

/// Whether `id` is that of this member.
fn is_id_of(id: &str, (term, name): (&Term, &str)) -> bool {
    id.strip_prefix(term.id).and_then(|rest| rest.strip_prefix('.')) == Some(name)
}

impl Gauge {
    /// Whether a parameter is a member.
    pub fn holds(&self, id: &str) -> bool {
        self.members.iter().any(|member| member.iter().any(|one| is_id_of(id, *one)))
    }

    /// Whether the choice is open if these parameters are free.
    pub fn is_open(&self, free: &[&str]) -> bool {
        let is_free = |one: &(&'static Term, &str)| free.iter().any(|id| is_id_of(id, *one));
        self.members.iter().all(|member| member.iter().any(is_free))
    }
}

/// The gauge that contains all these parameters, of which there are at least two.
pub fn gauge_of(ids: &[&str]) -> Option<&'static Gauge> {
    GAUGES.iter().find(|gauge| ids.len() > 1 && ids.iter().all(|id| gauge.holds(id)))
}
