//! Suggestions for misspelled words.

/// The candidate with the smallest edit distance to `word`, if it is small: at most a third of the letters (and at least one) may
/// be changed, added, omitted or swapped with a neighbor.
pub fn nearest<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let word = letters(word);
    let allowed = (word.len() / 3).max(1);
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let letters = letters(candidate);
            // Each letter of difference in length costs one edit: most candidates are excluded by their length.
            if letters.len().abs_diff(word.len()) > allowed {
                return None;
            }
            let distance = distance(&word, &letters);
            // A candidate without a common letter is not more similar than any other.
            (distance <= allowed && distance < letters.len()).then_some((distance, candidate))
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// The letters of a word in lower case, at most 256, so that the cost of a long text is bounded.
fn letters(word: &str) -> Vec<char> {
    word.chars().flat_map(char::to_lowercase).take(256).collect()
}

/// The optimal string alignment distance.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut rows = vec![(0..=b.len()).collect::<Vec<_>>()];
    for i in 1..=a.len() {
        let mut row = Vec::with_capacity(b.len() + 1);
        row.push(i);
        for j in 1..=b.len() {
            let changed = usize::from(a[i - 1] != b[j - 1]);
            let mut least =
                (rows[i - 1][j] + 1).min(row[j - 1] + 1).min(rows[i - 1][j - 1] + changed);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn slips_of_the_pen_are_understood() {
        let keys = ["latitude", "longitude", "height", "gravity"];
        assert_eq!(nearest("latitud", keys), Some("latitude"));
        assert_eq!(nearest("hieght", keys), Some("height"));
        assert_eq!(nearest("Gravity", keys), Some("gravity"));
    }

    #[test]
    fn a_far_word_gets_no_suggestion() {
        assert_eq!(nearest("colour", ["latitude", "height"]), None);
        assert_eq!(nearest("q", ["s", "m"]), None);
        assert_eq!(nearest(&"latitude".repeat(100_000), ["latitude", "height"]), None);
    }
}
