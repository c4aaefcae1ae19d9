//! The content of a report: sections of text, notes, tables and plots.

use super::plot::Plot;

/// A page, in the order in which it is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// The title, such as "Calibration of run 7".
    pub title: String,
    /// The command, its model and its input files, in one line.
    pub subtitle: String,
    /// The result in sentences: the first is emphasized, the others are listed below it.
    pub summary: Vec<String>,
    /// The evidence.
    pub sections: Vec<Section>,
}

/// One question with its answer.
///
/// Consecutive plots share a row of the page; those with the same abscissa label share a cursor and a zoom.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Section {
    /// The heading, also listed at the top of the page.
    pub heading: String,
    /// What the reader should look for; empty if there is no introduction.
    pub intro: String,
    /// The contents, in reading order.
    pub items: Vec<Item>,
}

/// A piece of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A paragraph.
    Text(String),
    /// A remark in a box, with its weight.
    Note(Tone, String),
    /// A table.
    Table(Table),
    /// Coefficients between −1 and 1 of each pair of quantities.
    Matrix(Matrix),
    /// Curves over a common abscissa.
    Plot(Plot),
}

/// The severity of a statement; the page expresses it by a word in addition to the color.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// A fact.
    Neutral,
    /// As expected.
    Good,
    /// A limitation to be read before the numbers are used.
    Warning,
    /// An error: the numbers cannot be used as they are.
    Bad,
}

/// A table with a heading above each column.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// The meaning of the rows.
    pub caption: String,
    /// The columns, left to right.
    pub columns: Vec<Column>,
    /// The rows; empty cells are added to a row that is too short.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// The heading, with the unit of the column if it has one.
    pub heading: String,
    /// The kind of its cells.
    pub kind: Kind,
}

/// The format of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Text, aligned left.
    Text,
    /// Numbers, aligned right, with digits of equal width.
    Number,
    /// Identifiers, in a monospaced font.
    Id,
}

impl Column {
    /// A text column.
    pub fn text(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), kind: Kind::Text }
    }

    /// A number column.
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
    /// An empty cell.
    Empty,
    /// Text.
    Text(String),
    /// A number with this number of decimals; with a power of ten if it would be rounded to zero.
    Number {
        /// The number, in the unit of its column.
        value: f64,
        /// The decimals shown.
        decimals: usize,
    },
    /// A value ± its standard deviation, both rounded to the second digit of the latter.
    Estimate {
        /// The estimate, in the unit of its column.
        value: f64,
        /// Its standard deviation, in the same unit.
        sigma: f64,
    },
    /// A bar of a value and its standard deviation, in the scale of the column; values beyond −1 and 1 are clipped.
    Bar {
        /// The value.
        value: f64,
        /// Its standard deviation.
        sigma: f64,
    },
    /// One or two emphasized words, such as "identifiable".
    Badge(Tone, String),
}

impl Cell {
    /// A text cell.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A badge.
    pub fn badge(tone: Tone, text: impl Into<String>) -> Self {
        Self::Badge(tone, text.into())
    }
}

/// A square matrix of coefficients between −1 and 1, such as correlations, shaded by their magnitude.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Matrix {
    /// The meaning of the coefficients.
    pub caption: String,
    /// The names of rows and columns.
    pub labels: Vec<String>,
    /// The rows of the matrix.
    pub values: Vec<Vec<f64>>,
}
