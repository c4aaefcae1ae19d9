//! What can be wrong with a log.

use crate::quantity::did_you_mean;

/// What is wrong with a log, or with one line of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LogProblem {
    /// There is nothing in it.
    #[error("the file is empty")]
    Empty,
    /// No line of it has an end.
    #[error("no line ends in a line feed; is the file cut short, or written on an old Mac?")]
    NoLineEnd,
    /// There is a header and nothing else.
    #[error("only a header, no samples")]
    OnlyHeader,
    /// There are too few samples to tell an interval.
    #[error("{samples} sample, at least 2 are needed")]
    TooShort {
        /// How many there are.
        samples: usize,
    },
    /// It is a file of another format.
    #[error("this is {name}, which is not read: {remedy}")]
    Container {
        /// The format's name, with its article.
        name: &'static str,
        /// How to read or to convert it.
        remedy: &'static str,
    },
    /// It is not UTF-8 text.
    #[error("not UTF-8 text; is it binary or UTF-16?")]
    NotText,
    /// A line is longer than any log's.
    #[error("a line of more than {most} bytes")]
    LongLine {
        /// The most that is read.
        most: u64,
    },
    /// A line has more columns than any log's.
    #[error("more than {most} columns")]
    ManyColumns {
        /// The most that is read.
        most: usize,
    },
    /// A quotation mark is not closed.
    #[error("a quotation mark is not closed")]
    OpenQuote,
    /// A line has another number of fields than the first.
    #[error("{got} fields, expected {expected}{}", cut(*.got, *.expected))]
    FieldCount {
        /// How many it has.
        got: usize,
        /// How many the first line has.
        expected: usize,
    },
    /// A column is not there.
    #[error("no column {column:?}; the columns are {present}{}", did_you_mean(.suggestion.as_deref()))]
    NoColumn {
        /// The column that is wanted.
        column: String,
        /// What may have been meant.
        suggestion: Option<String>,
        /// The columns that are there.
        present: String,
    },
    /// Two columns have the name that is wanted.
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
    /// A field is infinite or not a number.
    #[error("column {column:?}: {text:?} is not finite")]
    NotFinite {
        /// The column.
        column: String,
        /// The field.
        text: String,
    },
    /// A number is larger than any that is measured.
    #[error("column {column:?}: {value:e} {unit} is not plausible; check this line and the unit")]
    BeyondReason {
        /// The column.
        column: String,
        /// The number in SI units, radians or degrees Celsius.
        value: f64,
        /// Which of these.
        unit: &'static str,
    },
    /// Samples follow each other as no log's do.
    #[error(
        "samples are {interval:.3e} s apart, expected from {least:e} s to {most:e} s; check the time \
         column and its unit"
    )]
    Pace {
        /// The median interval \[s\].
        interval: f64,
        /// The least that is believed \[s\].
        least: f64,
        /// The most \[s\].
        most: f64,
    },
    /// A sample counter is not whole.
    #[error("column {column:?}: {count} is not a whole number of samples")]
    PartOfASample {
        /// The column.
        column: String,
        /// The number.
        count: f64,
    },
    /// Time does not go on.
    #[error("time goes from {before} s to {now} s, it must increase")]
    TimeNotIncreasing {
        /// The time of the line before \[s\].
        before: f64,
        /// The time of this line \[s\].
        now: f64,
    },
    /// Too much time passes between two samples.
    #[error("a gap of {length:.6} s after {after} s, more than {largest} s; cut the log there")]
    LongGap {
        /// How long it is \[s\].
        length: f64,
        /// The time of the line before \[s\].
        after: f64,
        /// The longest that is accepted \[s\].
        largest: f64,
    },
    /// The gaps are too much of a log's time.
    #[error(
        "{count} gaps are {lost:.6} s of the log's {lasting:.6} s, more than {:.0} %; are its time \
         stamps those of samples, or of packets?", most * 100.0
    )]
    ManyGaps {
        /// How many there are.
        count: usize,
        /// How long they are in all \[s\].
        lost: f64,
        /// How long the log is \[s\].
        lasting: f64,
        /// The largest share that is accepted.
        most: f64,
    },
    /// Increments are missing, and nothing says what became of them.
    #[error(
        "a gap of {length:.6} s after {after} s in a log of increments; state in [log] whether the next \
         increment covers it: gaps = \"accumulated\" or gaps = \"held\""
    )]
    LostIncrements {
        /// How long it is \[s\].
        length: f64,
        /// The time of the line before \[s\].
        after: f64,
    },
    /// The samples do not follow each other at the rate that the rig says.
    #[error("the rate is {measured:.3} Hz in the time column and {stated:.3} Hz in [log] rate")]
    WrongRate {
        /// The rate of the samples \[Hz\].
        measured: f64,
        /// The rate in the rig file \[Hz\].
        stated: f64,
    },
    /// A channel never moves.
    #[error("{channel} is {value} in every sample: the channel is stuck or the wrong column")]
    Stuck {
        /// The channel, as in `gyro x ("gx")`.
        channel: String,
        /// The number in its column.
        value: f64,
    },
    /// The table angle steps so far that its direction cannot be told.
    #[error(
        "the table angle moves by {turns:.3} of a turn in one sample, so its direction is ambiguous; log \
         it at a higher rate, or unwrapped"
    )]
    AmbiguousAngle {
        /// The step, in turns.
        turns: f64,
    },
    /// Two files of one run do not belong together sample by sample.
    #[error("{samples} samples, but {other} has {expected}; they must be sampled together")]
    UnequalLength {
        /// How many samples this file has.
        samples: usize,
        /// The other file.
        other: String,
        /// How many that has.
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
        /// The time without one \[s\].
        time: f64,
    },
    /// The log goes on after the table profile has ended.
    #[error("the log lasts {log:.3} s, the [table] profile only {profile:.3} s")]
    BeyondProfile {
        /// How long the log lasts \[s\].
        log: f64,
        /// How long the profile lasts \[s\].
        profile: f64,
    },
    /// The stated window or static interval holds none of the log.
    #[error(
        "[log] {key} is from {from} to {to} s, and the log from {first} to {last} s; times are those of its time column"
    )]
    OutsideLog {
        /// The key.
        key: &'static str,
        /// From when \[s\].
        from: f64,
        /// To when \[s\].
        to: f64,
        /// When the log begins \[s\].
        first: f64,
        /// When it ends \[s\].
        last: f64,
    },
    /// A binary file ends within a row.
    #[error("the last row is cut short: rows have {bytes} bytes")]
    PartOfARow {
        /// How many bytes a row has.
        bytes: usize,
    },
    /// A file says of few bytes that they are very many rows.
    #[error("more than {most} rows, the most that are read of a log of this size")]
    ManyRows {
        /// The most that are read.
        most: u64,
    },
    /// A file is not what its format demands.
    #[error("not a {format} file, or a damaged one: {message}")]
    Damaged {
        /// The format.
        format: &'static str,
        /// What is wrong.
        message: String,
    },
    /// Pages are compressed with a codec that is not read.
    #[error("compressed with {codec}; write it uncompressed, or with snappy or gzip")]
    Codec {
        /// The codec.
        codec: String,
    },
    /// The same row over and over, as where a file has a hole or a logger hangs.
    #[error("equal to the previous row, as are {times} rows after it; does the file have a gap?")]
    SameRow {
        /// How many more there are, at least.
        times: u64,
    },
    /// A column holds no numbers, or not one a row.
    #[error("column {column:?} is {found}, expected one number per row")]
    WrongColumn {
        /// The column.
        column: String,
        /// What it is.
        found: String,
    },
    /// None of a log's messages is one of the IMU's.
    #[error("no RAWIMUA, RAWIMUSA, RAWIMUXA or RAWIMUSXA message")]
    NoMessages,
    /// A message has no checksum.
    #[error("a message without a checksum; is the line cut short?")]
    NoChecksum,
    /// A message is not what was sent.
    #[error("the checksum is {found:08x}, but {stated:?} in the line; the line is damaged")]
    Checksum {
        /// What the message says it is.
        stated: String,
        /// What it is.
        found: u32,
    },
    /// A PSINS header's number makes no sense.
    #[error("the header's {name} is {value}, expected {expected}")]
    Header {
        /// What the number is.
        name: &'static str,
        /// The number.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// A PSINS log ends within its header.
    #[error("the header has {rows} of its 3 rows")]
    ShortHeader {
        /// How many rows there are.
        rows: usize,
    },
}

fn cut(got: usize, expected: usize) -> &'static str {
    if got < expected { "; is the line cut short?" } else { "" }
}

fn comma(text: &str) -> &'static str {
    let decimal_comma = text.contains(',') && text.replace(',', ".").parse::<f64>().is_ok();
    if decimal_comma { "; write decimals with a point" } else { "" }
}
