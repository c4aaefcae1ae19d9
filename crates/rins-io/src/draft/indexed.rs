//! Names of columns with an index instead of an axis: `gyro[0]`, `wb_1`, `imu.fb(:,3)`.

/// Each name, with x, y or z instead of its index if exactly three names differ in it, from 0 to 2 or from 1 to 3; `None` if it
/// is unchanged.
pub(super) fn with_axes(names: &[String]) -> Vec<Option<String>> {
    let divided: Vec<_> = names.iter().map(|name| divide(name)).collect();
    let axis = |&(before, index, after): &(&str, u32, &str)| {
        let alike = divided.iter().flatten().filter(|(b, _, a)| *b == before && *a == after);
        let mut indices: Vec<u32> = alike.map(|(_, index, _)| *index).collect();
        indices.sort_unstable();
        let first = *indices.first().filter(|_| matches!(indices[..], [0, 1, 2] | [1, 2, 3]))?;
        let axis = ["x", "y", "z"].get(usize::try_from(index - first).ok()?)?;
        Some(format!("{before} {axis}{after}"))
    };
    divided.iter().map(|divided| divided.as_ref().and_then(axis)).collect()
}

/// The text before a name's last digit, the digit, and the brackets after it.
fn divide(name: &str) -> Option<(&str, u32, &str)> {
    let inner = name.trim_end_matches([')', ']', ' ']);
    let (place, letter) = inner.char_indices().next_back()?;
    Some((&name[..place], letter.to_digit(10)?, &name[inner.len()..]))
}

#[cfg(test)]
mod tests {
    use super::with_axes;

    #[test]
    fn three_indices_are_axes() {
        let of = |names: &[&str]| {
            with_axes(&names.iter().map(ToString::to_string).collect::<Vec<_>>())
                .into_iter()
                .map(Option::unwrap_or_default)
                .collect::<Vec<_>>()
        };
        assert_eq!(of(&["a[0]", "a[1]", "a[2]", "t"]), ["a[ x]", "a[ y]", "a[ z]", ""]);
        assert_eq!(of(&["w(:,2)", "w(:,3)", "w(:,1)"]), ["w(:, y)", "w(:, z)", "w(:, x)"]);
        assert_eq!(of(&["q0", "q1", "q2", "q3"]), [""; 4]);
        assert_eq!(of(&["s2", "é", ""]), [""; 3]);
    }
}
