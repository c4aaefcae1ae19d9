//! How fast a table turns between two samples.

use rins_motion::median;

/// A rate that changes by so many times the usual change of it has a corner: a ramp begins or ends.
const CORNER: f64 = 8.0;

/// Of a table without noise the change is a corner if it is more than this part of the largest rate.
const LEAST: f64 = 1e-7;

/// The rates at the start of the first sample and at the end of each, from the mean rates over the samples
/// \[rad/s\], and at which of these a corner is near.
///
/// It is the mean of those on either side, where nothing sudden happens. At the corner of a ramp that would spread the
/// acceleration over the samples beside it: there the rate is what the smoother side leads to.
pub(crate) fn edges(rates: &[f64]) -> (Vec<f64>, Vec<usize>) {
    let n = rates.len();
    let (Some(&first), Some(&last)) = (rates.first(), rates.last()) else {
        return (Vec::new(), Vec::new());
    };
    let bend = |middle: usize| {
        let [before, here, after] = [middle - 1, middle, middle + 1].map(|place| rates[place]);
        (before - 2.0 * here + after).abs()
    };
    let usual = median((1..n.saturating_sub(1)).map(bend)).unwrap_or_default();
    let largest = rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
    let corner = (CORNER * usual).max(LEAST * largest);
    // A corner within one of the samples beside an edge bends the rates over either, and over the next.
    let near = |edge: &usize| bend(edge - 1).max(bend(*edge)) > corner;
    let corners: Vec<usize> = (3..n.saturating_sub(2)).filter(near).collect();
    let mean = |edge: usize| 0.5 * (rates[edge - 1] + rates[edge]);
    let mut edges: Vec<f64> =
        std::iter::once(first).chain((1..n).map(mean)).chain([last]).collect();
    for &edge in &corners {
        let (before, after) = (rates[edge - 1], rates[edge]);
        edges[edge] = if bend(edge - 2) < bend(edge + 1) {
            before + 0.5 * (before - rates[edge - 2])
        } else {
            after - 0.5 * (rates[edge + 1] - after)
        };
    }
    (edges, corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean rates over samples of a second, and the rates at their edges, of a table that begins to speed up at a
    /// time and ends at another.
    fn ramp(from: f64, to: f64) -> (Vec<f64>, Vec<f64>) {
        let rate = |time: f64| time.clamp(from, to) - from;
        let angle = |time: f64| {
            let within = time.clamp(from, to);
            0.5 * (within - from).powi(2) + (time - within).max(0.0) * (to - from)
        };
        let edges: Vec<f64> = (0..=20).map(|edge| rate(f64::from(edge))).collect();
        let means = (0..20).map(|at| angle(f64::from(at + 1)) - angle(f64::from(at))).collect();
        (means, edges)
    }

    #[test]
    fn a_ramp_begins_and_ends_within_a_sample_or_between_two() {
        for (from, to) in [(5.0, 12.0), (5.3, 12.0), (5.0, 11.6), (5.7, 12.2)] {
            let (means, want) = ramp(from, to);
            for (edge, (got, want)) in edges(&means).0.iter().zip(&want).enumerate() {
                assert!((got - want).abs() < 1e-12, "{from} to {to}, edge {edge}: {got} {want}");
            }
        }
    }

    #[test]
    fn what_is_smooth_is_the_mean_of_both_sides() {
        let rates: Vec<f64> = (0..100).map(|at| (f64::from(at) * 0.1).sin()).collect();
        let (edges, corners) = edges(&rates);
        assert_eq!(corners, []);
        for edge in 1..100 {
            let mean = 0.5 * (rates[edge - 1] + rates[edge]);
            assert!((edges[edge] - mean).abs() < 1e-15, "edge {edge}");
        }
    }

    #[test]
    fn few_samples_have_edges_too() {
        assert_eq!(edges(&[]), (Vec::new(), Vec::new()));
        assert_eq!(edges(&[1.0]).0, [1.0, 1.0]);
        assert_eq!(edges(&[1.0, 3.0]).0, [1.0, 2.0, 3.0]);
    }
}
