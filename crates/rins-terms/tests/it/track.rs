//! A track taken apart.

use rins_terms::{KinematicState, Track};

use crate::support::run;

#[test]
fn stretch_begins_with_the_moment_that_the_whole_comes_to() {
    let track = &run().track;
    let whole: Vec<KinematicState> = track.moments().collect();
    let starts = [0, 1, 517, 517, 3000, track.len() - 1, track.len()];
    for (start, moments) in starts.into_iter().zip(track.moments_from(starts)) {
        assert_eq!(moments.len(), track.len() - start);
        assert!(moments.eq(whole[start..].iter().copied()), "from {start}");
    }
    // They depend on what was before: the table has turned both ways.
    assert!(whole[3000].end.sense != whole[517].end.sense);
}

/// Late angles are reckoned with the rate where a piece ends: it is as quiet as the angles let it be, but where a ramp
/// begins or ends it is not spread over the pieces.
#[test]
fn rates_between_pieces_have_little_of_the_noise_of_angles() {
    const INTERVAL: f64 = 0.02;
    const PIECE: usize = 10;
    const BESIDE: f64 = 4.0;
    const NOISE: f64 = 1e-6;
    // At rest, a ramp from the middle of a piece on, and a constant rate from within another.
    let (from, to) = (0.02 * 505.0, 0.02 * 757.0);
    let rate = |time: f64| 0.1 * (time.clamp(from, to) - from);
    let angle = |time: f64| {
        let within = time.clamp(from, to);
        0.05 * (within - from).powi(2) + 0.1 * (to - from) * (time - within).max(0.0)
    };
    let edges = 0..=1500;
    let noise = |edge: u32| NOISE * (f64::from(edge * edge % 97) / 48.0 - 1.0);
    let times: Vec<f64> = edges.clone().map(|edge| f64::from(edge) * INTERVAL).collect();
    let noisy = edges.zip(&times).map(|(edge, &time)| angle(time) + noise(edge));
    let track = Track::new(
        run().track.surroundings,
        times[1..].to_vec(),
        vec![INTERVAL; 1500],
        noisy.collect(),
        None,
    );
    let ends: Vec<usize> = (1..=1500 / PIECE).map(|piece| piece * PIECE).collect();
    for moment in track.thinned(&ends).moments().take(149) {
        let near = |corner: f64| (moment.end.time - corner).abs() < INTERVAL * (BESIDE + 2.0);
        // What two angles four samples away may be off by, or three beside the edge that lead to it.
        let most = if near(from) || near(to) { 4.0 } else { 1.001 / BESIDE };
        let most = most * NOISE / INTERVAL;
        let off = moment.end.rate - rate(moment.end.time);
        assert!(off.abs() <= most, "at {} s: {off} of {most}", moment.end.time);
    }
}
