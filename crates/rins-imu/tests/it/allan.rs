//! The Allan variance by its definition: half the mean squared difference of neighbouring means.

/// The overlapping Allan variance of rates, given the increments `x` over intervals of `interval`
/// \[s\], at a cluster of `n_cluster` of them.
pub(crate) fn variance(increments: &[f64], interval: f64, n_cluster: usize) -> f64 {
    let mut angles = vec![0.0; increments.len() + 1];
    for (k, increment) in increments.iter().enumerate() {
        angles[k + 1] = angles[k] + increment;
    }
    let n_terms = angles.len() - 2 * n_cluster;
    let sum: f64 = (0..n_terms)
        .map(|k| angles[k + 2 * n_cluster] - 2.0 * angles[k + n_cluster] + angles[k])
        .map(|difference| difference * difference)
        .sum();
    let cluster = n_cluster as f64 * interval;
    sum / (2.0 * cluster * cluster * n_terms as f64)
}
