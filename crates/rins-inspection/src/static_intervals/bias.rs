//! The distinction of a bias from a constant rate about the vertical.

use nalgebra::Vector3;
use rins_frames::EARTH_RATE;
use rins_frames::units::{DEG, STANDARD_GRAVITY};

use super::interval::NotStatic;
use super::options::StaticOptions;

/// The largest difference of the directions of gravity in the body for equal attitudes \[rad\].
const SAME_ATTITUDE: f64 = 10.0 * DEG;

/// If the same rate occurs in attitudes that differ by more than this \[rad\], a true rate would rotate gravity in one of
/// them.
const OTHER_ATTITUDE: f64 = 30.0 * DEG;

/// The number of longest pieces that are tried as those whose rate is a bias.
const MOST_TRIED: usize = 200;

/// The means over a quiet span of constant rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) duration: f64,
    pub(super) rate: Vector3<f64>,
    /// The uncertainty of the rate due to noise and sway, six sigma of the norm \[rad/s\].
    pub(super) uncertainty: f64,
    /// The direction of gravity.
    pub(super) up: Vector3<f64>,
}

impl Piece {
    /// The rate about the vertical.
    fn about_vertical(&self) -> f64 {
        self.rate.dot(&self.up).abs()
    }

    /// The difference of the rates of two pieces about the vertical of this one, and its limit.
    fn apart(&self, other: &Self, options: &StaticOptions) -> (f64, f64) {
        let turned = (self.up - other.up).norm();
        let allowed = options.largest_rate_change()
            + options.largest_g_sensitivity() * STANDARD_GRAVITY * turned
            + 2.0 * EARTH_RATE
            + self.uncertainty
            + other.uncertainty;
        ((self.rate - other.rate).dot(&self.up).abs(), allowed)
    }
}

/// The reason why each piece is not static, if it is not.
///
/// Gravity has a constant direction over each piece, so that only a rotation about the vertical is possible. Biases have the
/// size stated in the data sheet or, without one, an assumed size. They are equal in all pieces, apart from their drift and
/// their sensitivity to specific force. If pieces differ by more, those that agree with the largest number of attitudes and
/// pieces are static, and of several such groups the slowest.
pub(super) fn turning(pieces: &[Piece], options: &StaticOptions) -> Vec<Option<NotStatic>> {
    let limit = options.largest_bias();
    let within =
        |piece: &Piece| piece.about_vertical() <= limit + 2.0 * EARTH_RATE + piece.uncertainty;
    let mut longest: Vec<usize> = (0..pieces.len()).collect();
    longest.sort_by(|a, b| pieces[*b].duration.total_cmp(&pieces[*a].duration));
    longest.truncate(MOST_TRIED);

    let mut best: Option<(f64, usize, bool)> = None;
    for &tried in &longest {
        let candidate = &pieces[tried];
        let mut attitudes: Vec<Vector3<f64>> = Vec::new();
        let (mut count, mut proven) = (0, false);
        for piece in pieces {
            let (apart, allowed) = piece.apart(candidate, options);
            if apart > allowed {
                continue;
            }
            count += 1;
            proven |= piece.up.angle(&candidate.up) > OTHER_ATTITUDE
                && (piece.rate - candidate.rate).norm() <= allowed;
            if attitudes.iter().all(|up| up.angle(&piece.up) > SAME_ATTITUDE) {
                attitudes.push(piece.up);
            }
        }
        if !(proven || within(candidate)) {
            continue;
        }
        // A bias at its limit has the probability of a deviation of four sigma.
        let sigmas = 4.0 * candidate.about_vertical() / limit;
        let score = 2.0 * attitudes.len() as f64 + f64::from(count) - sigmas * sigmas;
        if best.is_none_or(|best| score > best.0) {
            best = Some((score, tried, proven));
        }
    }
    let why = |piece: &Piece| {
        let proven = best.is_some_and(|(.., proven)| proven);
        if let Some((_, tried, _)) = best {
            let (apart, allowed) = piece.apart(&pieces[tried], options);
            if apart > allowed {
                return Some(NotStatic::RateDiffers { apart, allowed });
            }
        }
        let beyond = NotStatic::RateBeyondBias {
            rate: piece.about_vertical(),
            limit,
            stated: options.gyro.bias_sigma.is_some(),
        };
        (!(proven || within(piece))).then_some(beyond)
    };
    pieces.iter().map(why).collect()
}
