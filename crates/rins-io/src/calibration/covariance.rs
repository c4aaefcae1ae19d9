//! The covariance of the numbers that a calibration has estimated: `[covariance]`.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use nalgebra::DMatrix;

use crate::document::{Entry, Node, Value};
use crate::error::IoError;
use crate::section::{Section, quoted};

/// The largest absolute correlation coefficient that is accepted: one, with a margin for rounding.
const MOST_CORRELATION: f64 = 1.0 + 1e-6;

/// The accepted relative difference of a stated sigma from that of the covariance: it may be rounded to one or two digits.
const SIGMA_WITHIN: f64 = 0.1;

/// The covariance of the numbers that a calibration estimated, in their units.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// The ids of its rows and columns.
    pub ids: Vec<String>,
    /// The covariances, in the product of the units of row and column.
    pub matrix: DMatrix<f64>,
}

/// Reads `[covariance]`, whose ids must be in `known`, and which must agree with the `stated` sigmas in the same units.
pub(super) fn read(
    root: &Section<'_>,
    known: &[String],
    stated: &[(String, f64)],
) -> Result<Option<Covariance>, IoError> {
    let Some(section) = root.section("covariance", &["ids", "rows"])? else { return Ok(None) };
    let ids = section.list_of_texts("ids", "a list of ids of parameters")?;
    if ids.is_empty() {
        return Err(section.missing("ids", "a list of ids of parameters"));
    }
    if let Some(stray) = ids.iter().find(|id| !known.contains(id)) {
        let reason = format!("{stray:?} is no parameter of this calibration");
        return Err(section.conflict("ids", reason));
    }
    if ids.iter().collect::<BTreeSet<_>>().len() < ids.len() {
        return Err(section.conflict("ids", "an id is listed twice"));
    }
    let expected = "a list of rows of numbers, each one longer than the previous one";
    let Some(Entry { value, .. }) = section.get("rows") else {
        return Err(section.missing("rows", expected));
    };
    let wrong = |value: &Value| section.wrong_type("rows", value, expected.into());
    let Node::List(rows) = &value.node else { return Err(wrong(value)) };
    if rows.len() != ids.len() {
        let reason = format!("has {} rows for {} ids", rows.len(), ids.len());
        return Err(section.conflict("rows", reason));
    }
    let mut matrix = DMatrix::zeros(ids.len(), ids.len());
    for (row, value) in rows.iter().enumerate() {
        let Node::List(numbers) = &value.node else { return Err(wrong(value)) };
        if numbers.len() != row + 1 {
            let reason = format!("has {} numbers in row {}", numbers.len(), row + 1);
            return Err(section.conflict("rows", reason));
        }
        for (column, value) in numbers.iter().enumerate() {
            let number = match value.node {
                Node::Number(number) => number,
                Node::Integer(number) => number as f64,
                _ => return Err(wrong(value)),
            };
            matrix[(row, column)] = number;
            matrix[(column, row)] = number;
        }
    }
    if let Some((row, column)) = first_impossible(&matrix) {
        let pair = quoted([ids[row].as_str(), ids[column].as_str()]);
        let reason = format!("holds {} for {pair}, which cannot be", matrix[(row, column)]);
        return Err(section.conflict("rows", reason));
    }
    for (row, id) in ids.iter().enumerate() {
        let sigma = matrix[(row, row)].sqrt();
        let other = stated.iter().find(|(stated, _)| stated == id).map(|(_, sigma)| *sigma);
        if let Some(other) = other.filter(|other| (other / sigma - 1.0).abs() > SIGMA_WITHIN) {
            let reason = format!("holds a sigma of {sigma} for {id}, which is {other} beside it");
            return Err(section.conflict("rows", reason));
        }
    }
    Ok(Some(Covariance { ids, matrix }))
}

/// The first element whose variance is not positive, or whose covariance exceeds the limit of the variances.
fn first_impossible(matrix: &DMatrix<f64>) -> Option<(usize, usize)> {
    let places = (0..matrix.nrows()).flat_map(|row| (0..=row).map(move |column| (row, column)));
    places.into_iter().find(|&(row, column)| {
        let (a, b) = (matrix[(row, row)], matrix[(column, column)]);
        let most = MOST_CORRELATION * (a * b).sqrt();
        let possible =
            a > 0.0 && a.is_finite() && (row == column || matrix[(row, column)].abs() <= most);
        !possible
    })
}

/// The section as TOML.
pub(super) fn written(covariance: &Covariance) -> String {
    let ids = quoted(covariance.ids.iter().map(String::as_str));
    let mut text = format!(
        "\n# Of these parameters, in the products of their units; lower triangle, row by row.\n\
         [covariance]\nids = [{ids}]\nrows = [\n"
    );
    for (row, _) in covariance.ids.iter().enumerate() {
        let numbers = (0..=row).map(|column| format!("{:e}", covariance.matrix[(row, column)]));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "    [{}],", numbers.collect::<Vec<_>>().join(", "));
    }
    text + "]\n"
}
