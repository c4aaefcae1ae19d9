//! Checks that the targets of all links exist.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::Result;

/// The page that a server shows for an invalid address; its links are relative to the server's root.
const NOT_FOUND: &str = "404.html";

/// Checks every local link, image, script and style sheet of the pages under `root`, including
/// fragments, and the fonts of the equations; returns the number of pages.
pub(crate) fn check(root: &Path) -> Result<usize> {
    let mut broken = Vec::new();
    let pages = pages(root)?;
    for page in &pages {
        let text = fs::read_to_string(page)?;
        let shown = page.strip_prefix(root).unwrap_or(page).display();
        let targets: BTreeSet<_> =
            values(&text, "href").chain(values(&text, "src")).filter(|t| is_local(t)).collect();
        for target in targets {
            if let Some(what) = fault(page, target)? {
                broken.push(format!("{shown}: {target}: {what}"));
            }
        }
        if text.contains("class=\"katex\"") && !text.contains("katex/katex.min.css") {
            broken.push(format!("{shown}: equations without katex.min.css"));
        }
    }
    let style = root.join("katex/katex.min.css");
    for font in fonts(&fs::read_to_string(&style).map_err(|e| format!("katex.min.css: {e}"))?) {
        if !style.with_file_name(font).is_file() {
            broken.push(format!("katex.min.css: {font}: no such file"));
        }
    }
    if broken.is_empty() { Ok(pages.len()) } else { Err(broken.join("\n").into()) }
}

/// The fault of a link on `page`, if there is one.
fn fault(page: &Path, target: &str) -> Result<Option<&'static str>> {
    let (path, fragment) = target.split_once('#').unwrap_or((target, ""));
    let path = path.split('?').next().unwrap_or_default();
    let file = if path.is_empty() { page.to_path_buf() } else { page.with_file_name(path) };
    let file = plain(&file);
    if !file.is_file() {
        return Ok(Some("no such file"));
    }
    if fragment.is_empty() || file.extension().is_none_or(|ending| ending != "html") {
        return Ok(None);
    }
    let text = fs::read_to_string(&file)?;
    let is_there = values(&text, "id").any(|id| id == fragment);
    Ok((!is_there).then_some("no such place on that page"))
}

/// The path with its `..` resolved, which fails in the file system if a folder does not exist.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

fn is_local(target: &str) -> bool {
    let scheme = target.split(['/', '#', '?']).next().unwrap_or_default();
    !scheme.contains(':') && !target.starts_with("//")
}

/// The values of an attribute in HTML.
fn values<'t>(html: &'t str, attribute: &str) -> impl Iterator<Item = &'t str> {
    let opening = format!(" {attribute}=\"");
    let length = opening.len();
    let starts: Vec<usize> = html.match_indices(&opening).map(|(at, _)| at + length).collect();
    starts.into_iter().filter_map(|start| html[start..].split('"').next())
}

/// The first font of each entry in a style sheet.
fn fonts(style: &str) -> impl Iterator<Item = &str> {
    let names = style.split("url(").skip(1).filter_map(|rest| rest.split(')').next());
    names.filter(|name| Path::new(name).extension().is_some_and(|ending| ending == "woff2"))
}

/// The pages under `root`, sorted.
fn pages(root: &Path) -> Result<Vec<PathBuf>> {
    let mut pages = Vec::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "html") && !path.ends_with(NOT_FOUND) {
                pages.push(path);
            }
        }
    }
    pages.sort();
    Ok(pages)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The broken links of a book with this page, `a/b.html` and the style sheet of the equations.
    fn broken(page: &str) -> String {
        let root = tempfile::TempDir::new().unwrap();
        for folder in ["a", "katex/fonts"] {
            fs::create_dir_all(root.path().join(folder)).unwrap();
        }
        let write = |path: &str, text: &str| fs::write(root.path().join(path), text).unwrap();
        write("index.html", page);
        write("a/b.html", r#"<p id="here"><a href="../index.html">up</a>"#);
        write("katex/katex.min.css", "src:url(fonts/one.woff2),url(fonts/one.ttf)");
        write("katex/fonts/one.woff2", "");
        check(root.path()).map_or_else(|error| error.to_string(), |count| format!("{count} pages"))
    }

    #[test]
    fn sound_links_pass() {
        let page = r##"<p id="top"><a href="a/b.html#here">b</a> <a href="#top">top</a>
            <a href="https://example.org/none">out</a> <a href="mailto:a@example.org">us</a>"##;
        assert_eq!(broken(page), "2 pages");
    }

    #[test]
    fn broken_links_are_named() {
        assert_eq!(broken(r#"<a href="c.html">"#), "index.html: c.html: no such file");
        assert_eq!(broken(r#"<img src="a/c.svg">"#), "index.html: a/c.svg: no such file");
        let fragment = "index.html: a/b.html#there: no such place on that page";
        assert_eq!(broken(r#"<a href="a/b.html#there">"#), fragment);
    }

    #[test]
    fn equations_need_their_style_sheet() {
        let expected = "index.html: equations without katex.min.css";
        assert_eq!(broken(r#"<span class="katex">x</span>"#), expected);
    }
}
