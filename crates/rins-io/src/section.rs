//! A section of a TOML file, which is read key by key; errors have the line of the key.

use crate::document::{Document, Entry, Node, Value};
use crate::error::{IoError, KeyError, KeyProblem};
use crate::quantity::{Dimension, Kind, Quantity};
use crate::suggestion::nearest;

/// The expected form of a temperature, for an error message.
pub(crate) const CELSIUS: &str = r#"a temperature such as "20 degC""#;

/// A table of a file: a `[header]`, or an inline table behind a key.
#[derive(Clone, Debug)]
pub(crate) struct Section<'d> {
    document: &'d Document,
    header: String,
    prefix: String,
    line: Option<usize>,
    entries: &'d [Entry],
}

impl<'d> Section<'d> {
    /// The whole file; keys other than `known` are refused.
    pub(crate) fn root(document: &'d Document, known: &[&str]) -> Result<Self, IoError> {
        let root = Self {
            document,
            header: String::new(),
            prefix: String::new(),
            line: None,
            entries: &document.root,
        };
        root.refuse_unknown(known)?;
        Ok(root)
    }

    /// The section `[header.key]`, if there is one; keys other than `known` are refused.
    pub(crate) fn section(&self, key: &str, known: &[&str]) -> Result<Option<Self>, IoError> {
        let header =
            if self.header.is_empty() { key.to_string() } else { format!("{}.{key}", self.header) };
        self.table(key, header, String::new(), known)
    }

    /// The inline table behind `key`, if there is one; keys other than `known` are refused.
    pub(crate) fn inline(&self, key: &str, known: &[&str]) -> Result<Option<Self>, IoError> {
        self.table(key, self.header.clone(), format!("{}{key}.", self.prefix), known)
    }

    fn table(
        &self,
        key: &str,
        header: String,
        prefix: String,
        known: &[&str],
    ) -> Result<Option<Self>, IoError> {
        let Some(entry) = self.get(key) else { return Ok(None) };
        let Node::Table(entries) = &entry.value.node else {
            let expected = format!("a table with the keys {}", known.join(", "));
            return Err(self.wrong_type(key, &entry.value, expected));
        };
        let document = self.document;
        let section = Self { document, header, prefix, line: Some(entry.line), entries };
        section.refuse_unknown(known)?;
        Ok(Some(section))
    }

    /// The tables in the list behind `key`; keys in them other than `known` are refused.
    pub(crate) fn tables(&self, key: &str, known: &[&str]) -> Result<Option<Vec<Self>>, IoError> {
        let expected = format!("a list of tables with the keys {}", known.join(", "));
        let tables = self.any_tables(key, &expected)?;
        tables.iter().flatten().try_for_each(|table| table.refuse_unknown(known))?;
        Ok(tables)
    }

    /// The tables in the list behind `key`, whatever their keys.
    pub(crate) fn any_tables(
        &self,
        key: &str,
        expected: &str,
    ) -> Result<Option<Vec<Self>>, IoError> {
        let Some(value) = self.get(key).map(|entry| &entry.value) else { return Ok(None) };
        let Node::List(items) = &value.node else {
            return Err(self.wrong_type(key, value, expected.into()));
        };
        let mut tables = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            let key = format!("{key}[{}]", index + 1);
            let Node::Table(entries) = &item.node else {
                return Err(self.wrong_type(&key, item, expected.into()));
            };
            tables.push(Self {
                document: self.document,
                header: self.header.clone(),
                prefix: format!("{}{key}.", self.prefix),
                line: Some(item.line),
                entries,
            });
        }
        Ok(Some(tables))
    }

    /// The keys of this table.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &'d str> {
        self.entries.iter().map(|entry| entry.key.as_str())
    }

    pub(crate) fn get(&self, key: &str) -> Option<&'d Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// The text behind `key`.
    pub(crate) fn text(&self, key: &str, expected: &str) -> Result<Option<&'d str>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        match &value.node {
            Node::Text(text) => Ok(Some(text)),
            _ => Err(self.wrong_type(key, value, expected.into())),
        }
    }

    /// The quantity behind `key`, in SI units and radians.
    pub(crate) fn quantity(&self, key: &str, kind: &Kind) -> Result<Option<f64>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        self.quantity_of(key, value, kind).map(Some)
    }

    /// The temperature behind `key` \[°C\]. Kelvin is refused, because it would be a difference.
    pub(crate) fn celsius(&self, key: &str) -> Result<Option<f64>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        self.celsius_of(key, value).map(Some)
    }

    /// The range of temperatures behind `key` \[°C\].
    pub(crate) fn celsius_range(&self, key: &str) -> Result<Option<[f64; 2]>, IoError> {
        let expected = r#"two temperatures such as ["18 degC", "25 degC"], the lower one first"#;
        self.range(key, expected, |value| self.celsius_of(key, value))
    }

    /// The range of quantities behind `key`, in SI units and radians.
    pub(crate) fn quantity_range(
        &self,
        key: &str,
        kind: &Kind,
    ) -> Result<Option<[f64; 2]>, IoError> {
        let expected =
            format!("two quantities such as [{0:?}, {0:?}], the lower one first", kind.example);
        self.range(key, &expected, |value| self.quantity_of(key, value, kind))
    }

    fn range(
        &self,
        key: &str,
        expected: &str,
        read: impl Fn(&Value) -> Result<f64, IoError>,
    ) -> Result<Option<[f64; 2]>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        let Node::List(items) = &value.node else {
            return Err(self.wrong_type(key, value, expected.into()));
        };
        let [low, high] = items.as_slice() else {
            return Err(self.wrong_type(key, value, expected.into()));
        };
        let range = [read(low)?, read(high)?];
        if range[0] <= range[1] { Ok(Some(range)) } else { Err(self.not_allowed(key, expected)) }
    }

    fn celsius_of(&self, key: &str, value: &Value) -> Result<f64, IoError> {
        let Node::Text(text) = &value.node else {
            return Err(self.wrong_type(key, value, CELSIUS.into()));
        };
        let is_celsius = ["degC", "°C"].iter().any(|unit| text.trim_end().ends_with(unit));
        match (Quantity::parse(text), is_celsius) {
            (Ok(Quantity { value, dimension: Dimension::TEMPERATURE }), true) => Ok(value),
            (Err(error), _) => Err(self.error_at(key, Some(value.line), error.into())),
            _ => Err(self.not_allowed(key, CELSIUS)),
        }
    }

    /// The quantity behind `key`, which is required.
    pub(crate) fn require_quantity(&self, key: &str, kind: &Kind) -> Result<f64, IoError> {
        self.quantity(key, kind)?.ok_or_else(|| self.missing(key, such_as(kind)))
    }

    /// The three quantities behind `key`.
    pub(crate) fn triple(&self, key: &str, kind: &Kind) -> Result<Option<[f64; 3]>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        let [x, y, z] = self.three(key, value, || {
            format!("three quantities such as [{0:?}, {0:?}, {0:?}]", kind.example)
        })?;
        Ok(Some([
            self.quantity_of(&format!("{key}[1]"), x, kind)?,
            self.quantity_of(&format!("{key}[2]"), y, kind)?,
            self.quantity_of(&format!("{key}[3]"), z, kind)?,
        ]))
    }

    /// The three texts behind `key`.
    pub(crate) fn texts(&self, key: &str, expected: &str) -> Result<Option<[&'d str; 3]>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        let mut texts = [""; 3];
        for (text, item) in texts.iter_mut().zip(self.three(key, value, || expected.into())?) {
            match &item.node {
                Node::Text(given) => *text = given,
                _ => return Err(self.wrong_type(key, item, expected.into())),
            }
        }
        Ok(Some(texts))
    }

    /// The texts in the list behind `key`, of any number.
    pub(crate) fn list_of_texts(&self, key: &str, expected: &str) -> Result<Vec<String>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(Vec::new()) };
        let Node::List(items) = &value.node else {
            return Err(self.wrong_type(key, value, expected.into()));
        };
        let text = |item: &Value| match &item.node {
            Node::Text(text) => Ok(text.clone()),
            _ => Err(self.wrong_type(key, item, expected.into())),
        };
        items.iter().map(text).collect()
    }

    /// The three numbers behind `key`; a single number stands for three equal ones.
    pub(crate) fn numbers(&self, key: &str, expected: &str) -> Result<Option<[f64; 3]>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        if matches!(value.node, Node::List(_)) {
            let mut numbers = [0.0; 3];
            for (number, item) in
                numbers.iter_mut().zip(self.three(key, value, || expected.into())?)
            {
                *number = self.number_of(key, item, expected)?;
            }
            return Ok(Some(numbers));
        }
        Ok(Some([self.number_of(key, value, expected)?; 3]))
    }

    /// The non-negative integer behind `key`.
    pub(crate) fn count(&self, key: &str, expected: &str) -> Result<Option<u64>, IoError> {
        let Some(Entry { value, .. }) = self.get(key) else { return Ok(None) };
        match value.node {
            Node::Integer(number) => {
                u64::try_from(number).map(Some).map_err(|_| self.not_allowed(key, expected))
            }
            Node::Number(_) => Err(self.not_allowed(key, expected)),
            _ => Err(self.wrong_type(key, value, expected.into())),
        }
    }

    /// The `true` or `false` behind `key`; false if it is left out.
    pub(crate) fn flag(&self, key: &str) -> Result<bool, IoError> {
        match self.get(key).map(|entry| &entry.value) {
            None => Ok(false),
            Some(Value { node: Node::Flag(flag), .. }) => Ok(*flag),
            Some(value) => Err(self.wrong_type(key, value, "true or false".into())),
        }
    }

    /// The one of `choices` that the text behind `key` names.
    pub(crate) fn choice<T: Copy>(
        &self,
        key: &str,
        choices: &[(&str, T)],
    ) -> Result<Option<T>, IoError> {
        let known = || quoted(choices.iter().map(|(name, _)| *name));
        let Some(text) = self.text(key, &format!("one of {}", known()))? else { return Ok(None) };
        if let Some((_, choice)) = choices.iter().find(|(name, _)| *name == text) {
            return Ok(Some(*choice));
        }
        let suggestion = nearest(text, choices.iter().map(|(name, _)| *name)).map(Into::into);
        Err(self
            .error(key, KeyProblem::NotOneOf { value: text.into(), suggestion, known: known() }))
    }

    /// The error that `key` is missing.
    pub(crate) fn missing(&self, key: &str, expected: impl Into<String>) -> IoError {
        self.error(key, KeyProblem::Missing { expected: expected.into() })
    }

    /// The error that the value behind `key` is not permitted.
    pub(crate) fn not_allowed(&self, key: &str, expected: &str) -> IoError {
        let value = self.get(key).map_or_else(String::new, |entry| entry.value.source.clone());
        self.error(key, KeyProblem::NotAllowed { value, expected: expected.into() })
    }

    /// The error that `key` conflicts with another one.
    pub(crate) fn conflict(&self, key: &str, reason: impl Into<String>) -> IoError {
        self.error(key, KeyProblem::Conflict { reason: reason.into() })
    }

    /// The error with this problem of `key`.
    pub(crate) fn error(&self, key: &str, problem: KeyProblem) -> IoError {
        let line = self.get(key).map(|entry| entry.value.line).or(self.line);
        self.error_at(key, line, problem)
    }

    fn error_at(&self, key: &str, line: Option<usize>, problem: KeyProblem) -> IoError {
        let name = format!("{}{key}", self.prefix);
        let key = if self.header.is_empty() { name } else { format!("[{}] {name}", self.header) };
        Box::new(KeyError { path: self.document.path.clone(), line, key, problem }).into()
    }

    /// The error that the value behind `key` has another type.
    pub(crate) fn wrong_type(&self, key: &str, value: &Value, expected: String) -> IoError {
        let got = value.node.described(&value.source);
        self.error_at(key, Some(value.line), KeyProblem::WrongType { got, expected })
    }

    /// The quantity in a value, in SI units and radians.
    pub(crate) fn quantity_of(
        &self,
        key: &str,
        value: &Value,
        kind: &Kind,
    ) -> Result<f64, IoError> {
        let Node::Text(text) = &value.node else {
            return Err(self.wrong_type(key, value, such_as(kind)));
        };
        kind.parse(text).map_err(|error| self.error_at(key, Some(value.line), error.into()))
    }

    fn number_of(&self, key: &str, value: &Value, expected: &str) -> Result<f64, IoError> {
        let number = match value.node {
            Node::Number(number) => number,
            Node::Integer(number) => number as f64,
            _ => return Err(self.wrong_type(key, value, expected.into())),
        };
        if number.is_finite() { Ok(number) } else { Err(self.not_allowed(key, expected)) }
    }

    fn three(
        &self,
        key: &str,
        value: &'d Value,
        expected: impl Fn() -> String,
    ) -> Result<&'d [Value; 3], IoError> {
        let Node::List(items) = &value.node else {
            return Err(self.wrong_type(key, value, expected()));
        };
        items.as_slice().try_into().map_err(|_| {
            let got = format!("a list of {}", items.len());
            self.error_at(
                key,
                Some(value.line),
                KeyProblem::WrongType { got, expected: expected() },
            )
        })
    }

    fn refuse_unknown(&self, known: &[&str]) -> Result<(), IoError> {
        let Some(entry) = self.entries.iter().find(|entry| !known.contains(&entry.key.as_str()))
        else {
            return Ok(());
        };
        let problem = KeyProblem::Unknown {
            suggestion: nearest(&entry.key, known.iter().copied()).map(Into::into),
            known: known.join(", "),
        };
        Err(self.error_at(&entry.key, Some(entry.line), problem))
    }
}

/// The expected form of a quantity, for an error message.
pub(crate) fn such_as(kind: &Kind) -> String {
    format!("{} such as {:?}", kind.name, kind.example)
}

/// The words in quotation marks, separated by commas.
pub(crate) fn quoted<'w>(words: impl IntoIterator<Item = &'w str>) -> String {
    words.into_iter().map(|word| format!("{word:?}")).collect::<Vec<_>>().join(", ")
}
