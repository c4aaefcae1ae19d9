//! Single errors of axes, signs and attitude, and their corrections.

use rins_frames::{EulerAngles, SignedAxes};

/// The correction of a single error that would explain the data.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Correction {
    /// The gyros' axes.
    Gyro(SignedAxes),
    /// The accelerometers' axes.
    Accel(SignedAxes),
    /// The axes of both triads, alike.
    Imu(SignedAxes),
    /// Roll and pitch of the axis are exchanged.
    RollAndPitch,
    /// The sign of the axis' roll.
    RollSign,
    /// The sign of the axis' pitch.
    PitchSign,
    /// The sign of the axis' yaw.
    YawSign,
    /// The hemisphere.
    LatitudeSign,
    /// The direction of rotation in which the table angle increases.
    TableSense,
    /// Both the direction of rotation and the gyros' axes.
    GyroAndTableSense(SignedAxes),
}

/// The cost of an error: wrong signs, or two exchanged axes, are the most frequent.
fn cost(axes: &SignedAxes) -> usize {
    match (axes.kept(), axes.flips()) {
        (3, 0) => 0,
        // All three: gravity instead of specific force.
        (3, 1 | 3) | (1, 0) => 1,
        (3, _) | (1, 1) | (0, 0) => 2,
        _ => 3,
    }
}

/// A hypothesis on what differs from the declared properties.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hypothesis {
    pub(super) gyro: SignedAxes,
    pub(super) accel: SignedAxes,
    pub(super) angles: Option<EulerAngles>,
    pub(super) latitude: f64,
    pub(super) table_sense: f64,
}

/// The amount of data that a hypothesis must explain.
#[derive(Clone, Copy, Debug)]
pub(super) enum Weight {
    /// Whole vectors.
    Directions,
    /// The angle between two vectors, or a direction of rotation.
    OneFigure,
}

impl Hypothesis {
    /// The data as declared.
    pub(super) const AS_READ: Self = Self {
        gyro: SignedAxes::IDENTITY,
        accel: SignedAxes::IDENTITY,
        angles: None,
        latitude: 0.0,
        table_sense: 1.0,
    };

    /// The hypothesis with this correction.
    fn corrected(self, correction: Correction) -> Self {
        let turned =
            |turn: fn(EulerAngles) -> EulerAngles| Self { angles: self.angles.map(turn), ..self };
        match correction {
            Correction::Gyro(gyro) => Self { gyro, ..self },
            Correction::Accel(accel) => Self { accel, ..self },
            Correction::Imu(axes) => Self { gyro: axes, accel: axes, ..self },
            Correction::RollAndPitch => {
                turned(|angles| EulerAngles { roll: angles.pitch, pitch: angles.roll, ..angles })
            }
            Correction::RollSign => turned(|angles| EulerAngles { roll: -angles.roll, ..angles }),
            Correction::PitchSign => {
                turned(|angles| EulerAngles { pitch: -angles.pitch, ..angles })
            }
            Correction::YawSign => turned(|angles| EulerAngles { yaw: -angles.yaw, ..angles }),
            Correction::LatitudeSign => Self { latitude: -self.latitude, ..self },
            Correction::TableSense => Self { table_sense: -self.table_sense, ..self },
            Correction::GyroAndTableSense(gyro) => {
                Self { gyro, table_sense: -self.table_sense, ..self }
            }
        }
    }

    /// The most probable single corrections for which `explains` is true. For a single number only the most frequent errors
    /// are tried, because some of many errors would explain it by chance.
    pub(super) fn corrections(
        self,
        evidence: Weight,
        explains: impl Fn(&Self) -> bool,
    ) -> Vec<Correction> {
        use Correction::{
            Accel, Gyro, GyroAndTableSense, Imu, LatitudeSign, PitchSign, RollAndPitch, RollSign,
            TableSense, YawSign,
        };
        let axes = SignedAxes::all().filter(|axes| cost(axes) > 0);
        let of_axes =
            axes.flat_map(|axes| [Gyro(axes), Accel(axes), Imu(axes), GyroAndTableSense(axes)]);
        let others = [RollAndPitch, RollSign, PitchSign, YawSign, LatitudeSign, TableSense];
        let most = match evidence {
            Weight::Directions => usize::MAX,
            Weight::OneFigure => 1,
        };
        let mut best = (most, Vec::new());
        for correction in of_axes.chain(others) {
            let cost = match correction {
                Gyro(axes) | Accel(axes) | Imu(axes) => cost(&axes),
                // Two errors that hide each other.
                GyroAndTableSense(axes) => cost(&axes) + 1,
                _ => 1,
            };
            if cost <= best.0 && explains(&self.corrected(correction)) {
                if cost < best.0 {
                    best = (cost, Vec::new());
                }
                best.1.push(correction);
            }
        }
        best.1
    }
}
