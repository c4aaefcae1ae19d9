//! Renders the equations of a page, `$…$` and `$$…$$`, when the book is built, so that a page needs no script.

use std::fmt::{self, Write};
use std::ops::Range;

use katex::{KatexContext, Settings};
use mdbook_driver::book::Book;
use mdbook_preprocessor::{Preprocessor, PreprocessorContext};
use pulldown_cmark::{Event, Options, Parser};

/// Replaces every equation by its HTML.
#[derive(Default)]
pub(crate) struct Equations {
    katex: KatexContext,
}

/// An error in an equation.
#[derive(Debug, PartialEq)]
pub(crate) struct EquationError {
    line: usize,
    what: String,
}

impl fmt::Display for EquationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.what)
    }
}

impl Preprocessor for Equations {
    fn name(&self) -> &'static str {
        "equations"
    }

    fn run(
        &self,
        _: &PreprocessorContext,
        mut book: Book,
    ) -> Result<Book, mdbook_driver::errors::Error> {
        let mut errors = Vec::new();
        book.for_each_chapter_mut(|chapter| match self.set(&chapter.content) {
            Ok(content) => chapter.content = content,
            Err(error) => {
                let path = chapter.path.as_deref().unwrap_or("?".as_ref());
                errors.push(format!("docs/src/{}: {error}", path.display()));
            }
        });
        if errors.is_empty() {
            Ok(book)
        } else {
            Err(mdbook_driver::errors::Error::msg(errors.join("\n")))
        }
    }
}

impl Equations {
    /// The Markdown of a page with its equations rendered.
    ///
    /// # Errors
    /// [`EquationError`] for the first equation that is not valid TeX, or for an unpaired `$`.
    fn set(&self, markdown: &str) -> Result<String, EquationError> {
        let mut page = String::with_capacity(markdown.len());
        let mut done = 0;
        let options = Options::ENABLE_MATH | Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES;
        for (event, range) in Parser::new_ext(markdown, options).into_offset_iter() {
            let (tex, is_display) = match &event {
                Event::InlineMath(tex) => (tex, false),
                Event::DisplayMath(tex) => (tex, true),
                Event::Text(text) if text.contains('$') && !is_escaped(markdown, &range) => {
                    return Err(error(markdown, &range, "a `$` without its partner"));
                }
                _ => continue,
            };
            let settings =
                Settings::builder().display_mode(is_display).throw_on_error(true).build();
            let html = katex::render_to_string(&self.katex, tex, &settings)
                .map_err(|e| error(markdown, &range, &format!("{e} in `{}`", tex.trim())))?;
            page.push_str(&markdown[done..range.start]);
            page.push_str(&shielded(&html));
            done = range.end;
        }
        page.push_str(&markdown[done..]);
        Ok(page)
    }
}

fn is_escaped(markdown: &str, range: &Range<usize>) -> bool {
    markdown[..range.start].ends_with('\\')
}

fn error(markdown: &str, range: &Range<usize>, what: &str) -> EquationError {
    let line = 1 + markdown[..range.start].matches('\n').count();
    EquationError { line, what: what.into() }
}

/// HTML whose text is protected from Markdown.
///
/// Markdown copies tags unchanged but interprets the text between them, where `_`, `*` or `\` would
/// have another meaning.
fn shielded(html: &str) -> String {
    let mut shielded = String::with_capacity(2 * html.len());
    let mut in_tag = false;
    for character in html.chars() {
        let is_text = !in_tag && !"<>".contains(character);
        in_tag = character == '<' || in_tag && character != '>';
        match character {
            '\n' => shielded.push(' '),
            // `&`, `#` and `;` belong to entities.
            _ if is_text && character.is_ascii_punctuation() && !"&#;".contains(character) => {
                write!(shielded, "&#{};", u32::from(character))
                    .expect("a String takes all that is written");
            }
            _ => shielded.push(character),
        }
    }
    shielded
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(markdown: &str) -> Result<String, EquationError> {
        Equations::default().set(markdown)
    }

    #[test]
    fn equations_become_html_and_the_rest_stays() {
        let page = set("Let $a_b$ and\n\n$$x^2 \\tag{1}$$\n\n`$code$` costs \\$5.\n").unwrap();
        assert!(page.starts_with("Let <span class=\"katex\">"), "{page}");
        assert!(page.contains("class=\"katex-display\""), "{page}");
        assert!(page.ends_with("\n\n`$code$` costs \\$5.\n"), "{page}");
    }

    #[test]
    fn text_in_an_equation_holds_no_markdown() {
        let page = set("$a_b * c_d * e$").unwrap();
        let mut text = String::new();
        let mut in_tag = false;
        for character in page.chars() {
            match character {
                '<' => in_tag = true,
                '>' => in_tag = false,
                _ if !in_tag => text.push(character),
                _ => {}
            }
        }
        assert!(!text.contains(['*', '_', '\\']), "{text}");
        assert!(text.contains("&#95;"), "{text}");
    }

    #[test]
    fn wrong_equation_is_refused_with_its_line() {
        let refused = set("one\n\n$\\frac{1}$\n").unwrap_err();
        assert_eq!(refused.line, 3);
        assert!(refused.what.contains("\\frac{1}"), "{refused}");
        assert_eq!(set("two\nand $x\n").unwrap_err().what, "a `$` without its partner");
    }
}
