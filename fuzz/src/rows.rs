//! Logs of text as loggers write them, but for what the fuzzer makes wrong.

use std::fmt::Write as _;

use arbitrary::Arbitrary;

/// A log of text.
#[derive(Arbitrary, Debug)]
pub struct Table {
    /// Under which keys it is read.
    pub choice: u8,
    delimiter: u8,
    mark: bool,
    dos: bool,
    header: Header,
    units: bool,
    finished: bool,
    start: f32,
    rows: Vec<Row>,
}

#[derive(Arbitrary, Debug)]
enum Header {
    Names,
    Comment,
    None,
    Shuffled(u8),
}

#[derive(Arbitrary, Debug)]
struct Row {
    step: Step,
    fields: [Field; 8],
    twice: bool,
    cut: Option<u8>,
}

#[derive(Arbitrary, Debug)]
enum Step {
    Even,
    Hundredths(u8),
    Any(f64),
    Back,
}

#[derive(Arbitrary, Debug)]
enum Field {
    Small(i16),
    Count(u16),
    Any(f64),
    Quoted(f32),
    Blank,
    Text(u32),
    Long(f64),
}

const NAMES: [&str; 9] = ["t", "gx", "gy", "gz", "ax", "ay", "az", "table", "T"];

impl Table {
    /// The log as it stands in a file.
    pub fn text(&self) -> String {
        let delimiter = [",", ";", "\t", " ", "|"][usize::from(self.delimiter) % 5];
        let end = if self.dos { "\r\n" } else { "\n" };
        let mut text = String::from(if self.mark { "\u{feff}" } else { "" });
        if delimiter == "|" {
            text += "sep=|";
            text += end;
        }
        let mut names = NAMES;
        match self.header {
            Header::None => {}
            Header::Shuffled(by) => names.rotate_left(usize::from(by) % NAMES.len()),
            Header::Comment => text += "# ",
            Header::Names => {}
        }
        if !matches!(self.header, Header::None) {
            text += &names.join(delimiter);
            text += end;
        }
        if self.units {
            text += &["s", "deg/s", "deg/s", "deg/s", "g", "g", "g", "deg", "degC"].join(delimiter);
            text += end;
        }
        let mut time = f64::from(self.start);
        for row in &self.rows {
            time = match row.step {
                Step::Even => time + 0.02,
                Step::Hundredths(count) => time + f64::from(count) * 0.01,
                Step::Any(time) => time,
                Step::Back => time - 0.02,
            };
            let mut line = time.to_string();
            let fields = row.fields.len() - row.cut.map_or(0, |cut| usize::from(cut) % 8);
            for field in &row.fields[..fields] {
                line += delimiter;
                field.write(&mut line);
            }
            for _ in 0..=u8::from(row.twice) {
                text += &line;
                text += end;
            }
        }
        if !self.finished {
            text.pop();
        }
        text
    }
}

impl Field {
    fn write(&self, line: &mut String) {
        // Writing to a string cannot fail.
        let _ = match self {
            Self::Small(number) => write!(line, "{}", f64::from(*number) * 1e-4),
            Self::Count(count) => write!(line, "{count}"),
            Self::Any(number) => write!(line, "{number:e}"),
            Self::Quoted(number) => write!(line, "\"{number}\""),
            Self::Blank => Ok(()),
            Self::Text(letter) => {
                write!(line, "{}", char::from_u32(*letter % 0x11_0000).unwrap_or('\u{3000}'))
            }
            Self::Long(number) => write!(line, "{number:.60}"),
        };
    }
}
