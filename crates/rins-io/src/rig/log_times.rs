//! Times in a rig file that refer to its log: `static` and `window` of `[log]`.

use super::log_spec::{TimeColumn, TimeUnit};
use crate::document::{Node, Value};
use crate::error::{IoError, KeyProblem};
use crate::quantity::kinds;
use crate::section::Section;

/// The maximum number of spans.
const MOST_SPANS: usize = 100_000;

const SPAN: &str = r#"a span of two times, such as ["10 s", "40 s"], the later one last"#;

/// The format of times that refer to a log.
pub(super) struct Clock<'l> {
    log: &'l Section<'l>,
    /// The unit of the time column \[s\], if there is one.
    unit: Option<f64>,
}

impl<'l> Clock<'l> {
    pub(super) fn of(log: &'l Section<'l>, time: Option<&TimeColumn>, rate: Option<f64>) -> Self {
        let unit = time.and_then(|time| match time.unit {
            TimeUnit::Seconds(seconds) => Some(seconds),
            TimeUnit::Samples => rate.map(|rate| 1.0 / rate),
        });
        Self { log, unit }
    }

    /// The part of the log that is read \[s\].
    pub(super) fn window(&self) -> Result<Option<[f64; 2]>, IoError> {
        self.log.get("window").map(|entry| self.span("window", &entry.value)).transpose()
    }

    /// The static intervals \[s\].
    pub(super) fn static_spans(&self) -> Result<Vec<[f64; 2]>, IoError> {
        const SPANS: &str = r#"a list of spans such as [["10 s", "40 s"], ["55 s", "70 s"]]"#;
        let Some(entry) = self.log.get("static") else { return Ok(Vec::new()) };
        let Node::List(items) = &entry.value.node else {
            return Err(self.log.wrong_type("static", &entry.value, SPANS.into()));
        };
        if items.is_empty() || items.len() > MOST_SPANS {
            return Err(self.log.not_allowed("static", SPANS));
        }
        let mut spans: Vec<[f64; 2]> = Vec::with_capacity(items.len());
        for (place, item) in items.iter().enumerate() {
            let span = self.span(&format!("static[{}]", place + 1), item)?;
            if spans.last().is_some_and(|last| last[1] > span[0]) {
                let expected = "spans that follow each other and do not overlap";
                return Err(self.log.not_allowed("static", expected));
            }
            spans.push(span);
        }
        Ok(spans)
    }

    fn span(&self, key: &str, value: &Value) -> Result<[f64; 2], IoError> {
        let Node::List(items) = &value.node else {
            return Err(self.log.wrong_type(key, value, SPAN.into()));
        };
        let [from, to] = items.as_slice() else {
            return Err(self.log.wrong_type(key, value, SPAN.into()));
        };
        let span = [self.time(&format!("{key}[1]"), from)?, self.time(&format!("{key}[2]"), to)?];
        if span[0] < span[1] {
            return Ok(span);
        }
        let problem = KeyProblem::NotAllowed { value: value.source.clone(), expected: SPAN.into() };
        Err(self.log.error(key, problem))
    }

    /// A time \[s\], from a quantity or from a number in the unit of the time column.
    fn time(&self, key: &str, value: &Value) -> Result<f64, IoError> {
        let number = match value.node {
            Node::Number(number) if number.is_finite() => number,
            Node::Integer(number) => number as f64,
            _ => return self.log.quantity_of(key, value, &kinds::LOG_TIME),
        };
        self.unit.map(|unit| number * unit).ok_or_else(|| {
            let expected = r#"a quantity such as "10 s", for the log has no time column"#.into();
            let problem = KeyProblem::NotAllowed { value: value.source.clone(), expected };
            self.log.error(key, problem)
        })
    }
}
