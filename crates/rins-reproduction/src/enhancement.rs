//! "The precision of navigation is enhanced at least 20 %": the claim for each figure of Table 6.

use crate::printed;
use crate::real_test::Emulated;

/// The minimum enhancement that the paper claims.
pub(crate) const CLAIMED: f64 = 0.2;

/// The relative reduction of an error by compensation: 1 if it vanishes, negative if it increases.
pub(crate) fn enhancement(before: f64, after: f64) -> f64 {
    1.0 - (after / before).abs()
}

/// The enhancement of one figure of Table 6, printed and over emulated runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Enhancement {
    /// From the printed errors.
    pub(crate) printed: f64,
    /// The median over the runs.
    pub(crate) median: f64,
    /// The quantiles at 5 % and 95 % over the runs.
    pub(crate) range: [f64; 2],
    /// The fraction of the runs in which it is at least [`CLAIMED`].
    pub(crate) share: f64,
}

/// The five figures, in the order of [`Outcome::figures`](crate::pure_navigation::Outcome::figures).
pub(crate) fn enhancements(runs: &[Emulated]) -> [Enhancement; 5] {
    std::array::from_fn(|figure| {
        let of =
            |run: &Emulated| enhancement(run.before.figures()[figure], run.after.figures()[figure]);
        let mut each: Vec<f64> = runs.iter().map(of).collect();
        each.sort_by(f64::total_cmp);
        let met = each.iter().filter(|each| **each >= CLAIMED).count();
        Enhancement {
            printed: enhancement(
                printed::TABLE_6_BEFORE.figures()[figure],
                printed::TABLE_6_AFTER.figures()[figure],
            ),
            range: [0.05, 0.95].map(|share| quantile(&each, share)),
            median: quantile(&each, 0.5),
            share: met as f64 / runs.len() as f64,
        }
    })
}

/// The quantile of sorted numbers, interpolated linearly.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place between zero and the last"
    )]
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

/// The fraction of the runs in which all five figures are enhanced by at least [`CLAIMED`].
pub(crate) fn share_of_all(runs: &[Emulated]) -> f64 {
    let met = |run: &&Emulated| {
        let pairs = run.before.figures().into_iter().zip(run.after.figures());
        pairs.into_iter().all(|(before, after)| enhancement(before, after) >= CLAIMED)
    };
    runs.iter().filter(met).count() as f64 / runs.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pure_navigation::Outcome;
    use nalgebra::Vector3;
    use rins_frames::EulerAngles;
    use rins_testing::assert_close;

    /// A run whose five errors after compensation are those before it times a factor.
    fn run(before: f64, factor: f64) -> Emulated {
        let outcome = |size: f64| Outcome {
            velocity: [size, -size],
            attitude: EulerAngles { roll: size, pitch: -size, yaw: size },
        };
        Emulated {
            truth: Vector3::zeros(),
            estimate: Vector3::zeros(),
            before: outcome(before),
            after: outcome(before * factor),
            online: outcome(before),
        }
    }

    #[test]
    fn the_printed_figures_have_the_enhancements_of_table_6() {
        let each = enhancements(&[run(1.0, 0.5)]);
        for (one, want) in each.iter().zip([0.940, 0.702, 0.292, 0.973, 0.910]) {
            assert_close!(one.printed, want, 0.0006);
        }
    }

    #[test]
    fn a_share_counts_the_runs_that_reach_the_claim() {
        let runs = [run(1.0, 0.1), run(-2.0, 0.79), run(1.0, 0.81), run(0.1, -3.0)];
        for one in enhancements(&runs) {
            assert_close!(one.share, 0.5, 1e-12);
            assert_close!(one.median, 0.5 * (0.21 + 0.19), 1e-12);
            // The 5 % quantile is 0.15 of the way from the smallest to the next.
            assert_close!(one.range[0], -2.0 + 0.15 * 2.19, 1e-12);
        }
        assert_close!(share_of_all(&runs), 0.5, 1e-12);
    }
}
