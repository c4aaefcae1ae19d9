//! The problems of a log.

use crate::quantity::did_you_mean;

/// The problem of a log, or of one line of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LogProblem {
    /// The log is empty.
    #[error("the file is empty")]
    Empty,
    /// No line has a line end.
    #[error("no line ends in a line feed; is the file cut short, or written on an old Mac?")]
    NoLineEnd,
    /// The log has a header only.
    #[error("only a header, no samples")]
    OnlyHeader,
    /// The log has not more lines than are skipped.
    #[error("the file has no line after the {lines} that [log] skip leaves out")]
    AllSkipped {
        /// The number of skipped lines.
        lines: u64,
    },
    /// There are too few samples to determine an interval.
    #[error("{samples} sample, at least 2 are needed")]
    TooShort {
        /// The number of samples.
        samples: usize,
    },
    /// The log is a file of another format.
    #[error("this is {name}, which is not read: {remedy}")]
    Container {
        /// The format's name, with its article.
        name: &'static str,
        /// How to read or to convert it.
        remedy: &'static str,
    },
    /// The log is not UTF-8 text.
    #[error("not UTF-8 text; is it binary or UTF-16?")]
    NotText,
    /// A line is longer than permitted.
    #[error("a line of more than {most} bytes")]
    LongLine {
        /// The maximum length.
        most: u64,
    },
    /// A line has more columns than permitted.
    #[error("more than {most} columns")]
    ManyColumns {
        /// The maximum number.
        most: usize,
    },
    /// A quotation mark is not closed.
    #[error("a quotation mark is not closed")]
    OpenQuote,
    /// A line has a different number of fields than the first.
    #[error("{got} fields, expected {expected}{}", cut(*.got, *.expected))]
    FieldCount {
        /// Its number of fields.
        got: usize,
        /// The number of fields of the first line.
        expected: usize,
    },
    /// A column does not exist.
    #[error("no column {column:?}; the columns are {present}{}", did_you_mean(.suggestion.as_deref()))]
    NoColumn {
        /// The requested column.
        column: String,
        /// The most similar existing column.
        suggestion: Option<String>,
        /// The existing columns.
        present: String,
    },
    /// Two columns have the requested name.
    #[error("two columns are called {column:?}")]
    TwoColumns {
        /// The name.
        column: String,
    },
    /// A field is empty.
    #[error("column {column:?}: empty, expected a number")]
    EmptyField {
        /// The column.
        column: String,
    },
    /// A field is not a number.
    #[error("column {column:?}: {text:?} is not a number{}", comma(.text))]
    NotANumber {
        /// The column.
        column: String,
        /// The field.
        text: String,
    },
    /// A field of the first of two time columns is not a date.
    #[error("column {column:?}: {text:?} is not a date such as 2021-07-05 or 05.07.2021")]
    NotADate {
        /// The column.
        column: String,
        /// The field.
        text: String,
    },
    /// A field of the first of two time columns is not a whole number.
    #[error("column {column:?}: {text:?} is not a whole number")]
    NotWhole {
        /// The column.
        column: String,
        /// The field.
        text: String,
    },
    /// A field of the second of two time columns is not a part of one unit of the first.
    #[error("column {column:?}: {text:?} is not from 0 to less than {longest} s; check time.unit")]
    BeyondPart {
        /// The column.
        column: String,
        /// The field.
        text: String,
        /// The longest unit of the first column \[s\].
        longest: i64,
    },
    /// A field is infinite or NaN.
    #[error("column {column:?}: {text:?} is not finite")]
    NotFinite {
        /// The column.
        column: String,
        /// The field.
        text: String,
    },
    /// A number is larger than any plausible reading.
    #[error("column {column:?}: {value:e} {unit} is not plausible; check this line and the unit")]
    BeyondReason {
        /// The column.
        column: String,
        /// The number in SI units, radians or degrees Celsius.
        value: f64,
        /// The unit.
        unit: &'static str,
    },
    /// No row has the text of a row filter.
    #[error("no row has {value:?} in column {column:?}")]
    NoSuchRows {
        /// The column.
        column: String,
        /// The text.
        value: String,
    },
    /// The readings of a table angle with its own clock are too rare.
    #[error("the table angle is read at {rate:.3} Hz, expected at least {least} Hz")]
    SlowTableAngle {
        /// Their rate \[Hz\].
        rate: f64,
        /// The least \[Hz\].
        least: f64,
    },
    /// The sample interval is implausible.
    #[error(
        "samples are {interval:.3e} s apart, expected from {least:e} s to {most:e} s; check the time \
         column and its unit"
    )]
    Pace {
        /// The median interval \[s\].
        interval: f64,
        /// The minimum plausible interval \[s\].
        least: f64,
        /// The maximum plausible interval \[s\].
        most: f64,
    },
    /// A sample counter is not an integer.
    #[error("column {column:?}: {count} is not a whole number of samples")]
    PartOfASample {
        /// The column.
        column: String,
        /// The number.
        count: f64,
    },
    /// Time does not increase.
    #[error("time goes from {before} s to {now} s, it must increase")]
    TimeNotIncreasing {
        /// The time of the previous line \[s\].
        before: f64,
        /// The time of this line \[s\].
        now: f64,
    },
    /// A gap between two samples is too long.
    #[error("a gap of {length:.6} s after {after} s, more than {largest} s; cut the log there")]
    LongGap {
        /// The length of the gap \[s\].
        length: f64,
        /// The time of the previous line \[s\].
        after: f64,
        /// The maximum accepted length \[s\].
        largest: f64,
    },
    /// The gaps make up too much of a log's time.
    #[error(
        "{count} gaps are {lost:.6} s of the log's {lasting:.6} s, more than {:.0} %; are its time \
         stamps those of samples, or of packets?", most * 100.0
    )]
    ManyGaps {
        /// The number of gaps.
        count: usize,
        /// The total length of the gaps \[s\].
        lost: f64,
        /// The duration of the log \[s\].
        lasting: f64,
        /// The maximum accepted fraction.
        most: f64,
    },
    /// Increments are missing, and the rig file does not state the meaning of the increment after the gap.
    #[error(
        "a gap of {length:.6} s after {after} s in a log of increments; state in [log] whether the next \
         increment covers it: gaps = \"accumulated\" or gaps = \"held\""
    )]
    LostIncrements {
        /// The length of the gap \[s\].
        length: f64,
        /// The time of the previous line \[s\].
        after: f64,
    },
    /// The sampling rate differs from that in the rig file.
    #[error("the rate is {measured:.3} Hz in the time column and {stated:.3} Hz in [log] rate")]
    WrongRate {
        /// The measured rate \[Hz\].
        measured: f64,
        /// The rate in the rig file \[Hz\].
        stated: f64,
    },
    /// A channel is stuck.
    #[error("{channel} is {value} in every sample: the channel is stuck or the wrong column")]
    Stuck {
        /// The channel, as in `gyro x ("gx")`.
        channel: String,
        /// The number in its column.
        value: f64,
    },
    /// A step of the table angle is too large for its direction to be determined.
    #[error(
        "the table angle moves by {turns:.3} of a turn in one sample, so its direction is ambiguous; log \
         it at a higher rate, or unwrapped"
    )]
    AmbiguousAngle {
        /// The step, in turns.
        turns: f64,
    },
    /// Too many rows cannot be read.
    #[error("{first}; {count} of {rows} rows are damaged, more than one in a hundred")]
    ManyDamaged {
        /// The problem of the first of them.
        first: Box<Self>,
        /// Their number.
        count: usize,
        /// The number of rows that were read.
        rows: usize,
    },
    /// Two files of one run have different numbers of samples.
    #[error("{samples} samples, but {other} has {expected}; they must be sampled together")]
    UnequalLength {
        /// The number of samples of this file.
        samples: usize,
        /// The other file.
        other: String,
        /// The number of samples of the other file.
        expected: usize,
    },
    /// Two files of one run have different times.
    #[error(
        "at {time} s where {other} is at {expected} s; sensors in separate files must be sampled \
         within a tenth of an interval"
    )]
    UnequalTimes {
        /// The time in this file \[s\].
        time: f64,
        /// The other file.
        other: String,
        /// The time there \[s\].
        expected: f64,
    },
    /// Two files of one run have no time in common.
    #[error("has no time in common with {other}; check the units and offset of their clocks")]
    NoOverlap {
        /// The other file.
        other: String,
    },
    /// The temperatures do not cover the log.
    #[error("temperatures from {first} s to {last} s do not cover the log's {time} s")]
    NoTemperature {
        /// The first temperature's time \[s\].
        first: f64,
        /// The last temperature's time \[s\].
        last: f64,
        /// The time without a temperature \[s\].
        time: f64,
    },
    /// The log continues after the end of the table profile.
    #[error("the log lasts {log:.3} s, the [table] profile only {profile:.3} s")]
    BeyondProfile {
        /// The duration of the log \[s\].
        log: f64,
        /// The duration of the profile \[s\].
        profile: f64,
    },
    /// The stated window or static interval contains no sample of the log.
    #[error(
        "[log] {key} is from {from} to {to} s, and the log from {first} to {last} s; times are those of its time column"
    )]
    OutsideLog {
        /// The key.
        key: &'static str,
        /// The start of the stated span \[s\].
        from: f64,
        /// The end of the stated span \[s\].
        to: f64,
        /// The start of the log \[s\].
        first: f64,
        /// The end of the log \[s\].
        last: f64,
    },
    /// A binary file ends within a row.
    #[error("the last row is cut short: rows have {bytes} bytes")]
    PartOfARow {
        /// The number of bytes of a row.
        bytes: usize,
    },
    /// A small file claims a very large number of rows.
    #[error("more than {most} rows, the most that are read of a log of this size")]
    ManyRows {
        /// The maximum number of rows.
        most: u64,
    },
    /// A file violates its format.
    #[error("not a {format} file, or a damaged one: {message}")]
    Damaged {
        /// The format.
        format: &'static str,
        /// The violation.
        message: String,
    },
    /// Pages are compressed with an unsupported codec.
    #[error("compressed with {codec}; write it uncompressed, or with snappy or gzip")]
    Codec {
        /// The codec.
        codec: String,
    },
    /// The same row is repeated very often, for example because of a hole in the file or a logger that hangs.
    #[error("equal to the previous row, as are {times} rows after it; does the file have a gap?")]
    SameRow {
        /// The minimum number of repetitions.
        times: u64,
    },
    /// A column does not contain one number per row.
    #[error("column {column:?} is {found}, expected one number per row")]
    WrongColumn {
        /// The column.
        column: String,
        /// The content of the column.
        found: String,
    },
    /// A log contains no IMU message.
    #[error("no RAWIMUA, RAWIMUSA, RAWIMUXA or RAWIMUSXA message")]
    NoMessages,
    /// A message has no checksum.
    #[error("a message without a checksum; is the line cut short?")]
    NoChecksum,
    /// The checksum of a message is wrong.
    #[error("the checksum is {found:08x}, but {stated:?} in the line; the line is damaged")]
    Checksum {
        /// The checksum in the message.
        stated: String,
        /// The computed checksum.
        found: u32,
    },
    /// A number of a PSINS header is implausible.
    #[error("the header's {name} is {value}, expected {expected}")]
    Header {
        /// The meaning of the number.
        name: &'static str,
        /// The number.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
    /// A PSINS log ends within its header.
    #[error("the header has {rows} of its 3 rows")]
    ShortHeader {
        /// The number of rows.
        rows: usize,
    },
}

fn cut(got: usize, expected: usize) -> &'static str {
    if got < expected { "; is the line cut short?" } else { "" }
}

fn comma(text: &str) -> &'static str {
    let decimal_comma = text.contains(',') && text.replace(',', ".").parse::<f64>().is_ok();
    if decimal_comma { "; if commas are decimal marks, state decimal = \",\" in [log]" } else { "" }
}
