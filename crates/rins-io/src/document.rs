//! TOML files as a tree in which every key and value has its line number.

use std::fmt::Write as _;
use std::io::Read;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{IoError, KeyError, KeyProblem};
use crate::inputs;

/// The maximum size of a TOML file \[bytes\].
const LARGEST: u64 = 1 << 20;

/// A parsed TOML file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Document {
    pub(crate) path: PathBuf,
    pub(crate) root: Vec<Entry>,
}

/// A key and its value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) line: usize,
    pub(crate) value: Value,
}

/// A value, its line, and its text in the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Value {
    pub(crate) line: usize,
    pub(crate) source: String,
    pub(crate) node: Node,
}

/// The content of a value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Node {
    Text(String),
    Number(f64),
    Integer(i64),
    Flag(bool),
    Date,
    List(Vec<Value>),
    Table(Vec<Entry>),
}

impl Node {
    /// The description of the content in an error message.
    pub(crate) fn described(&self, source: &str) -> String {
        match self {
            Self::Text(text) => format!("{text:?} is a text"),
            Self::Number(_) | Self::Integer(_) => format!("{source} is a bare number"),
            Self::Flag(_) => format!("{source} is a flag"),
            Self::Date => format!("{source} is a date"),
            Self::List(_) => "a list".into(),
            Self::Table(_) => "a table".into(),
        }
    }
}

impl Document {
    /// Reads and parses the file at `path`.
    pub(crate) fn read(path: &Path) -> Result<Self, IoError> {
        Self::parse(&Self::text(path)?, path)
    }

    /// The text of the file at `path`.
    pub(crate) fn text(path: &Path) -> Result<String, IoError> {
        let failed = || IoError::file("read", path);
        let mut bytes = Vec::new();
        let file = inputs::open(path).map_err(failed())?;
        file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(failed())?;
        let refuse = |problem| {
            Box::new(KeyError { path: path.into(), line: None, key: String::new(), problem })
        };
        if bytes.len() as u64 > LARGEST {
            return Err(refuse(KeyProblem::TooLarge { most: LARGEST }).into());
        }
        String::from_utf8(bytes)
            .map_err(|_| refuse(KeyProblem::Syntax { message: "not UTF-8 text".into() }).into())
    }

    /// Parses `text`, the content of the file at `path`.
    pub(crate) fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        let lines = Lines::of(text);
        let root = DeTable::parse(text).map_err(|error| {
            Box::new(KeyError {
                path: path.into(),
                line: error.span().map(|span| lines.line(span.start)),
                key: String::new(),
                problem: KeyProblem::Syntax { message: one_line(error.message()) },
            })
        })?;
        Ok(Self { path: path.into(), root: lines.entries(root.get_ref()) })
    }
}

/// A parser's message joined to one line.
fn one_line(message: &str) -> String {
    message.split('\n').map(str::trim).collect::<Vec<_>>().join(", ")
}

/// A text with the positions at which its lines begin.
struct Lines<'t> {
    text: &'t str,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn of(text: &'t str) -> Self {
        let after = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self { text, starts: after.map(|(place, _)| place + 1).collect() }
    }

    fn line(&self, offset: usize) -> usize {
        1 + self.starts.partition_point(|start| *start <= offset)
    }

    fn entries(&self, table: &DeTable<'_>) -> Vec<Entry> {
        let mut entries: Vec<(usize, Entry)> = table
            .iter()
            .map(|(key, value)| {
                let start = key.span().start;
                let key = key.get_ref().to_string();
                (start, Entry { key, line: self.line(start), value: self.value(value) })
            })
            .collect();
        entries.sort_by_key(|(start, _)| *start);
        entries.into_iter().map(|(_, entry)| entry).collect()
    }

    fn value(&self, value: &Spanned<DeValue<'_>>) -> Value {
        let node = match value.get_ref() {
            DeValue::String(text) => Node::Text(text.to_string()),
            DeValue::Integer(number) => {
                match i64::from_str_radix(&digits(number.as_str()), number.radix()) {
                    Ok(integer) => Node::Integer(integer),
                    Err(_) => Node::Number(digits(number.as_str()).parse().unwrap_or(f64::NAN)),
                }
            }
            DeValue::Float(number) => {
                Node::Number(digits(number.as_str()).parse().unwrap_or(f64::NAN))
            }
            DeValue::Boolean(flag) => Node::Flag(*flag),
            DeValue::Datetime(_) => Node::Date,
            DeValue::Array(items) => Node::List(items.iter().map(|v| self.value(v)).collect()),
            DeValue::Table(table) => Node::Table(self.entries(table)),
        };
        let span = value.span();
        let source = self.text.get(span.clone()).unwrap_or_default();
        Value { line: self.line(span.start), source: source.into(), node }
    }
}

/// A number without the underscores by which TOML allows digits to be grouped.
fn digits(number: &str) -> String {
    number.replace('_', "")
}

/// `text` as a basic string of TOML.
pub(crate) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            letter if letter.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(letter));
            }
            letter => quoted.push(letter),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn values_know_their_lines() {
        let text = "# a comment\n[site]\nlatitude = \"1 deg\"\n\n[log]\ngyro = { columns = [\n  \"a\",\n  \"b\" ] }\n";
        let document = Document::parse(text, Path::new("rig.toml")).unwrap();
        let Node::Table(log) = &document.root[1].value.node else { panic!("a table") };
        let Node::Table(gyro) = &log[0].value.node else { panic!("a table") };
        let Node::List(columns) = &gyro[0].value.node else { panic!("a list") };
        let lines: Vec<usize> = columns.iter().map(|value| value.line).collect();
        assert_eq!((document.root[0].line, log[0].line, lines), (2, 6, vec![7, 8]));
    }

    proptest! {
        #[test]
        fn any_text_is_parsed_or_refused(text in "[\\[\\]={}a-c\"#'\\n0-9.,_-]{0,80}") {
            let _ = Document::parse(&text, Path::new("x.toml"));
        }
    }
}
