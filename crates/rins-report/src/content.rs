//! What a report says: sections of text, notes, tables and plots.

use super::plot::Plot;

/// A page, in the order in which it is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// What was done to what, such as "Calibration of run 7".
    pub title: String,
    /// The command, its model and its input files, in a line.
    pub subtitle: String,
    /// The result in plain words: the first sentence stands out, the others are listed below it.
    pub summary: Vec<String>,
    /// The evidence.
    pub sections: Vec<Section>,
}

/// One question and what answers it.
///
/// Plots that follow each other share a row of the page; those with the same abscissa label share a cursor and a zoom.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Section {
    /// The heading, also listed at the top of the page.
    pub heading: String,
    /// What the reader should look for; may be empty.
    pub intro: String,
    /// The contents, in reading order.
    pub items: Vec<Item>,
}

/// A piece of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
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
pub enum Tone {
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
pub struct Table {
    /// What the rows are.
    pub caption: String,
    /// The columns, left to right.
    pub columns: Vec<Column>,
    /// The rows; a row that is too short ends in empty cells.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// The heading, with the unit of the column if it has one.
    pub heading: String,
    /// What stands in it.
    pub kind: Kind,
}

/// How a column is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Words, at the left.
    Text,
    /// Numbers, at the right, with digits of equal width.
    Number,
    /// Identifiers, in a monospaced face.
    Id,
}

impl Column {
    /// A column of words.
    pub fn text(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), kind: Kind::Text }
    }

    /// A column of numbers.
    pub fn number(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), kind: Kind::Number }
    }

    /// A column of parameter ids or file names.
    pub fn id(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), kind: Kind::Id }
    }
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
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
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A badge.
    pub fn badge(tone: Tone, text: impl Into<String>) -> Self {
        Self::Badge(tone, text.into())
    }
}

/// A square matrix of coefficients between −1 and 1, such as correlations, shaded by their size.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Matrix {
    /// What the coefficients are.
    pub caption: String,
    /// The names of rows and columns.
    pub labels: Vec<String>,
    /// The rows of the matrix.
    pub values: Vec<Vec<f64>>,
}
