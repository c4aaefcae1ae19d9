//! A track taken apart.

use rins_terms::Moment;

use crate::support::run;

#[test]
fn stretch_begins_with_the_moment_that_the_whole_comes_to() {
    let track = run().track;
    let whole: Vec<Moment> = track.moments().collect();
    let starts = [0, 1, 517, 517, 3000, track.len() - 1, track.len()];
    for (start, moments) in starts.into_iter().zip(track.moments_from(starts)) {
        assert_eq!(moments.len(), track.len() - start);
        assert!(moments.eq(whole[start..].iter().copied()), "from {start}");
    }
    // They depend on what was before: the table has turned both ways.
    assert!(whole[3000].end.sense != whole[517].end.sense);
}
