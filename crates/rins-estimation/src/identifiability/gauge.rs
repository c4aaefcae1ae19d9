//! What no schedule can tell apart, since it is a matter of definition.

/// A group of parameters of which a combination is a choice of axes, of units or of an origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gauge {
    /// What is chosen, such as "the mounting of the IMU on the table".
    pub name: &'static str,
    /// Why no schedule tells it, and what to do.
    pub why: &'static str,
    /// How the ids of its parameters begin.
    pub members: &'static [&'static str],
}

/// All that are known, the smallest first.
pub static GAUGES: &[Gauge] = &[
    Gauge {
        name: "the zero of the table's angle",
        why: "the encoder's zero and the axis frame's turn about its own axis are one number; hold one",
        members: &["encoder.zero", "axis.attitude.z"],
    },
    Gauge {
        name: "the unit of force",
        why: "gravity that is wrong is a scale error common to the accelerometers; survey gravity",
        members: &["wrong_gravity", "accel.scale"],
    },
    Gauge {
        name: "the origin of time",
        why: "only two of the three delays, of gyros, accelerometers and encoder, exist; hold one",
        members: &["gyro_lag", "accel_latency", "encoder_latency"],
    },
    Gauge {
        name: "the body axes about the spin axis",
        why: "gyros and accelerometers turned about it alike are other body axes; hold accel.misalignment.xy or yx",
        members: &[
            "gyro.misalignment.xy",
            "gyro.misalignment.yx",
            "accel.misalignment.xy",
            "accel.misalignment.yx",
            "encoder.zero",
            "axis.attitude.z",
        ],
    },
    Gauge {
        name: "the mounting of the IMU on the table",
        why: "gyros and accelerometers tilted alike are an IMU that is tilted; hold the mounting, or the \
              misalignments xz and yz of one triad",
        members: &[
            "mounting",
            "gyro.misalignment.xz",
            "gyro.misalignment.yz",
            "gyro.misalignment.zx",
            "gyro.misalignment.zy",
            "accel.misalignment.xz",
            "accel.misalignment.yz",
            "accel.misalignment.zx",
            "accel.misalignment.zy",
            "axis.attitude.x",
            "axis.attitude.y",
        ],
    },
];

/// The gauge that all these parameters belong to, two of them at least.
pub fn gauge_of(ids: &[&str]) -> Option<&'static Gauge> {
    let is_in = |gauge: &Gauge, id: &str| gauge.members.iter().any(|member| id.starts_with(member));
    GAUGES.iter().find(|gauge| ids.len() > 1 && ids.iter().all(|id| is_in(gauge, id)))
}
