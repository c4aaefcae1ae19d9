//! Single mistakes of axes, signs and attitude, and what data look like without them.

use rins_frames::{EulerAngles, SignedAxes};

/// A single mistake that would explain what is seen, as what undoes it.
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
    /// The sense in which the table's angle is counted.
    TableSense,
    /// Both that and the gyros' axes.
    GyroAndTableSense(SignedAxes),
}

/// How unlikely a mistake is: wrong signs, or two axes exchanged, are made most often.
fn cost(axes: &SignedAxes) -> usize {
    match (axes.kept(), axes.flips()) {
        (3, 0) => 0,
        // All three: gravity was taken for specific force.
        (3, 1 | 3) | (1, 0) => 1,
        (3, _) | (1, 1) | (0, 0) => 2,
        _ => 3,
    }
}

/// What may be otherwise than it is said to be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hypothesis {
    pub(super) gyro: SignedAxes,
    pub(super) accel: SignedAxes,
    pub(super) angles: Option<EulerAngles>,
    pub(super) latitude: f64,
    pub(super) table_sense: f64,
}

/// How much there is that a hypothesis must explain.
#[derive(Clone, Copy, Debug)]
pub(super) enum Weight {
    /// Whole vectors.
    Directions,
    /// The angle between two, or a sense of turning.
    OneFigure,
}

impl Hypothesis {
    /// Nothing but what is read.
    pub(super) const AS_READ: Self = Self {
        gyro: SignedAxes::IDENTITY,
        accel: SignedAxes::IDENTITY,
        angles: None,
        latitude: 0.0,
        table_sense: 1.0,
    };

    /// The same but for what `correction` undoes.
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

    /// The least unlikely of all single corrections with which `explains` is true; of one figure
    /// only the commonest mistakes, as among many some explain it by chance.
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
                // Two mistakes that hide each other.
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
