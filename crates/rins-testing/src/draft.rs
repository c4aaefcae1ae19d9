//! Drafts of rig files, as a user fills them in.

/// A draft with these keys filled in, as its user would.
///
/// # Panics
/// If it has no place for one of them.
pub fn filled(draft: &str, values: &[(&str, &str)]) -> String {
    let mut text = String::new();
    let mut section = "";
    let mut left: Vec<&str> = values.iter().map(|(key, _)| *key).collect();
    for line in draft.lines() {
        let bare = line.trim_start_matches("# ");
        let header = bare.strip_prefix('[').and_then(|rest| rest.split_once(']'));
        if let Some((name, _)) = header {
            section = name;
            let wanted = values
                .iter()
                .any(|(key, _)| key.rsplit_once(name).is_some_and(|(a, _)| a.is_empty()));
            text.push_str(if wanted { bare } else { line });
        } else {
            let is_of = |key: &str| {
                let own = key.strip_prefix(section).and_then(|key| key.strip_prefix('.'));
                own.is_some_and(|own| bare.starts_with(&format!("{own} = ")))
            };
            match values.iter().find(|(key, _)| is_of(key)) {
                Some((key, value)) => {
                    left.retain(|other| other != key);
                    let own = &key[section.len() + 1..];
                    text.extend([own, " = ", value]);
                }
                None => text.push_str(line),
            }
        }
        text.push('\n');
    }
    assert!(left.is_empty(), "no such keys to fill in: {left:?}\n{draft}");
    text
}
