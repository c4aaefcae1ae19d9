//! Single mistakes of axes, signs and attitude, and what data look like without them.

use nalgebra::{Matrix3, Vector3};
use rins_frames::EulerAngles;

/// Three axes picked from three others, each once, with signs.
///
/// Corrected component `i` is `sign[i]` times component `source[i]` as it is read now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedAxes {
    /// Which component, 0 to 2.
    pub source: [usize; 3],
    /// 1 or -1.
    pub sign: [f64; 3],
}

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

impl SignedAxes {
    /// The axes as they are.
    pub const IDENTITY: Self = Self { source: [0, 1, 2], sign: [1.0; 3] };

    /// The vector's components along these axes.
    #[must_use]
    pub fn apply(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|row, _| self.sign[row] * vector[self.source[row]])
    }

    /// The matrix that makes components along these axes.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<f64> {
        Matrix3::from_columns(
            &[Vector3::x(), Vector3::y(), Vector3::z()].map(|unit| self.apply(&unit)),
        )
    }

    /// The axes by which what these have mixed up is as it was.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let mut inverse = *self;
        for row in 0..3 {
            inverse.source[self.source[row]] = row;
            inverse.sign[self.source[row]] = self.sign[row];
        }
        inverse
    }

    /// These axes picked from those that `first` picks.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let source = self.source.map(|index| first.source[index]);
        let sign = std::array::from_fn(|row| self.sign[row] * first.sign[self.source[row]]);
        Self { source, sign }
    }

    /// How many of the axes' signs are changed.
    pub fn flips(&self) -> usize {
        self.sign.iter().filter(|sign| **sign < 0.0).count()
    }

    /// How many axes stay in their place.
    pub fn kept(&self) -> usize {
        (0..3).filter(|&axis| self.source[axis] == axis).count()
    }

    /// All 48.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        const ORDERS: [[usize; 3]; 6] =
            [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
        ORDERS.into_iter().flat_map(|source| {
            (0..8_u8).map(move |bits| {
                let sign =
                    std::array::from_fn(|axis| if bits >> axis & 1 == 1 { -1.0 } else { 1.0 });
                Self { source, sign }
            })
        })
    }

    /// How unlikely a mistake is: wrong signs, or two axes exchanged, are made most often.
    fn cost(&self) -> usize {
        match (self.kept(), self.flips()) {
            (3, 0) => 0,
            // All three: gravity was taken for specific force.
            (3, 1 | 3) | (1, 0) => 1,
            (3, _) | (1, 1) | (0, 0) => 2,
            _ => 3,
        }
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
        let axes = SignedAxes::all().filter(|axes| axes.cost() > 0);
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
                Gyro(axes) | Accel(axes) | Imu(axes) => axes.cost(),
                // Two mistakes that hide each other.
                GyroAndTableSense(axes) => axes.cost() + 1,
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
