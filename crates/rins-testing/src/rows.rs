//! Tables of cases of which all are looked at before a test fails.

use std::fmt::{Debug, Display, Write as _};

/// What is wrong with a case, in words.
pub type Fault = Result<(), String>;

/// Fails once for all rows of a table that are wrong, with the name of each and what is wrong with it.
///
/// A table without rows fails: it would hide cases that were never looked at.
///
/// ```
/// use rins_testing::{assert_rows, is};
/// let squares = [("one", 1, 1), ("two", 2, 4)];
/// assert_rows(squares.iter().map(|(name, x, square)| (name, is(&(x * x), square))));
/// ```
/// ```should_panic
/// rins_testing::assert_rows::<&str>([]);
/// ```
#[track_caller]
pub fn assert_rows<N: Display>(rows: impl IntoIterator<Item = (N, Fault)>) {
    let (mut count, mut wrong, mut faults) = (0, 0, String::new());
    for (name, fault) in rows {
        count += 1;
        if let Err(fault) = fault {
            wrong += 1;
            let _ = write!(faults, "\n{name}: {fault}");
        }
    }
    assert!(count > 0, "a table without rows");
    assert!(wrong == 0, "{wrong} of {count} cases:{faults}");
}

/// Whether something is as it should be.
///
/// # Errors
/// What was found and what was wanted.
pub fn is<T: PartialEq<U> + Debug + ?Sized, U: Debug + ?Sized>(got: &T, want: &U) -> Fault {
    if got == want { Ok(()) } else { Err(format!("got {got:?}, want {want:?}")) }
}

/// Whether a text holds another.
///
/// # Errors
/// The text, and what is not in it.
pub fn says(text: &str, part: &str) -> Fault {
    if text.contains(part) { Ok(()) } else { Err(format!("{text:?} does not say {part:?}")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(
        expected = "2 of 3 cases:\nthe second: got 2, want 3\nthe third: \"a\" does not say \"b\""
    )]
    fn every_row_that_is_wrong_is_named() {
        let rows =
            [("the first", Ok(())), ("the second", is(&2, &3)), ("the third", says("a", "b"))];
        assert_rows(rows);
    }
}
