//! What a report says: sections of text, notes, tables and plots.

use super::plot::Plot;

/// A page, in the order in which it is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Report {
    /// What was done to what, such as "Calibration of run 7".
    pub(crate) title: String,
    /// The command, its model and its input files, in a line.
    pub(crate) subtitle: String,
    /// The result in plain words: the first sentence stands out, the others are listed below it.
    pub(crate) summary: Vec<String>,
    /// The evidence.
    pub(crate) sections: Vec<Section>,
}

/// One question and what answers it.
///
/// Plots that follow each other share a row of the page; those with the same abscissa label share a cursor and a zoom.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Section {
    /// The heading, also listed at the top of the page.
    pub(crate) heading: String,
    /// What the reader should look for; may be empty.
    pub(crate) intro: String,
    /// The contents, in reading order.
    pub(crate) items: Vec<Item>,
}

/// A piece of a section.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Item {
    /// A paragraph.
    Text(String),
    /// A remark set apart, with its weight.
    Note(Tone, String),
    /// A table.
    Table(Table),
    /// Coefficients between −1 and 1 of each pair of quantities.
    Matrix(Matrix),
    /// Curves over a common abscissa.
    Plot(Plot),
}

/// How good the news is; the page adds a word to it, never colour alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    /// A fact.
    Neutral,
    /// As it should be.
    Good,
    /// Read this before you use the numbers.
    Warning,
    /// The numbers cannot be used as they are.
    Bad,
}

/// A table with a heading over each column.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Table {
    /// What the rows are.
    pub(crate) caption: String,
    /// The columns, left to right.
    pub(crate) columns: Vec<Column>,
    /// The rows; a row that is too short ends in empty cells.
    pub(crate) rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Column {
    /// The heading, with the unit of the column if it has one.
    pub(crate) heading: String,
    /// What stands in it.
    pub(crate) kind: Kind,
}

/// How a column is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Words, at the left.
    Text,
    /// Numbers, at the right, with digits of equal width.
    Number,
    /// Identifiers, in a monospaced face.
    Id,
}

impl Column {
    /// A column of words.
    pub(crate) fn text(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), kind: Kind::Text }
    }

    /// A column of numbers.
    pub(crate) fn number(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), kind: Kind::Number }
    }

    /// A column of parameter ids or file names.
    pub(crate) fn id(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), kind: Kind::Id }
    }
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cell {
    /// Nothing to say.
    Empty,
    /// Words.
    Text(String),
    /// A number with that many decimals; one that they would show as zero is written with a power of ten.
    Number {
        /// The number, in the unit of its column.
        value: f64,
        /// The decimals shown.
        decimals: usize,
    },
    /// A value ± its standard deviation, both to the second digit of the latter.
    Estimate {
        /// The estimate, in the unit of its column.
        value: f64,
        /// Its standard deviation, in the same unit.
        sigma: f64,
    },
    /// A value and its standard deviation drawn to a scale that is the column's; beyond −1 and 1 they are cut.
    Bar {
        /// The value.
        value: f64,
        /// Its standard deviation.
        sigma: f64,
    },
    /// A word or two that stand out, such as "identifiable".
    Badge(Tone, String),
}

impl Cell {
    /// A cell of words.
    pub(crate) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A badge.
    pub(crate) fn badge(tone: Tone, text: impl Into<String>) -> Self {
        Self::Badge(tone, text.into())
    }
}

/// A square matrix of coefficients between −1 and 1, such as correlations, shaded by their size.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Matrix {
    /// What the coefficients are.
    pub(crate) caption: String,
    /// The names of rows and columns.
    pub(crate) labels: Vec<String>,
    /// The rows of the matrix.
    pub(crate) values: Vec<Vec<f64>>,
}
