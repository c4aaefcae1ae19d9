//! What no schedule can tell apart, since it is a matter of definition.

/// Parameters of which a combination is a choice of axes, of units or of an origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gauge {
    /// What is chosen, such as "the zero of the table's angle".
    pub name: &'static str,
    /// Why no schedule tells it, and what to do.
    pub why: &'static str,
    /// Its parameters: of each of these one at least must be free, or else the choice is made.
    pub members: &'static [&'static [&'static str]],
}

const MOUNTING: &str = "gyros and accelerometers tilted alike are an IMU that is tilted; hold the mounting, or the \
                        misalignments xz and yz of one triad";

/// All that are known, the smallest first.
pub static GAUGES: &[Gauge] = &[
    Gauge {
        name: "the zero of the table's angle",
        why: "the encoder's zero and the axis frame's turn about its own axis are one number; hold one",
        members: &[&["encoder.zero.angle"], &["axis.attitude.z"]],
    },
    Gauge {
        name: "the origin of time",
        why: "only two of the three delays, of gyros, accelerometers and encoder, exist; hold one",
        members: &[&["gyro_lag.delay"], &["accel_latency.delay"], &["encoder_latency.delay"]],
    },
    Gauge {
        name: "the unit of force",
        why: "gravity that is wrong is a scale error common to the accelerometers; survey gravity",
        members: &[
            &["wrong_gravity.gravity"],
            &["accel.scale.x"],
            &["accel.scale.y"],
            &["accel.scale.z"],
        ],
    },
    Gauge {
        name: "the body axes about the spin axis",
        why: "gyros and accelerometers turned about it alike are other body axes; hold accel.misalignment.xy or yx",
        members: &[
            &["gyro.misalignment.xy"],
            &["gyro.misalignment.yx"],
            &["accel.misalignment.xy"],
            &["accel.misalignment.yx"],
            &["encoder.zero.angle", "axis.attitude.z"],
        ],
    },
    Gauge {
        name: "the mounting of the IMU on the table about x",
        why: MOUNTING,
        members: &[
            &["mounting.x"],
            &["gyro.misalignment.yz"],
            &["gyro.misalignment.zy"],
            &["accel.misalignment.yz"],
            &["accel.misalignment.zy"],
        ],
    },
    Gauge {
        name: "the mounting of the IMU on the table about y",
        why: MOUNTING,
        members: &[
            &["mounting.y"],
            &["gyro.misalignment.xz"],
            &["gyro.misalignment.zx"],
            &["accel.misalignment.xz"],
            &["accel.misalignment.zx"],
        ],
    },
];

impl Gauge {
    /// Whether a parameter takes part.
    pub fn holds(&self, id: &str) -> bool {
        self.members.iter().any(|member| member.contains(&id))
    }

    /// Whether the choice is left open where these parameters are free.
    pub fn is_open(&self, free: &[&str]) -> bool {
        self.members.iter().all(|member| member.iter().any(|id| free.contains(id)))
    }
}

/// The gauge that all these parameters belong to, two of them at least.
pub fn gauge_of(ids: &[&str]) -> Option<&'static Gauge> {
    GAUGES.iter().find(|gauge| ids.len() > 1 && ids.iter().all(|id| gauge.holds(id)))
}
