//! The covariance of the numbers that a calibration has estimated: `[covariance]`.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use nalgebra::{DMatrix, DVector};

use crate::document::{Entry, Node, Value};
use crate::error::IoError;
use crate::section::{Section, quoted};

/// The largest absolute correlation coefficient that is accepted: one, with a margin for rounding.
const MOST_CORRELATION: f64 = 1.0 + 1e-6;

/// The accepted relative difference of a stated sigma from that of the covariance: it may be rounded to one or two digits.
const SIGMA_WITHIN: f64 = 0.1;

/// The keys of the section.
const KEYS: &[&str] = &["ids", "rows", "references", "shifts"];

/// The covariance of the numbers that a calibration estimated, in their units.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// The ids of its rows and columns.
    pub ids: Vec<String>,
    /// The covariances, in the product of the units of row and column.
    pub matrix: DMatrix<f64>,
    /// The parts of it that references add: for the key that states the accuracy of a reference, the change of each parameter by one
    /// standard uncertainty of it. The error of a reference is the same in all calibrations with it.
    pub references: Vec<(String, DVector<f64>)>,
}

/// Reads `[covariance]`, whose ids must be in `known`, and which must agree with the `stated` sigmas in the same units.
pub(super) fn read(
    root: &Section<'_>,
    known: &[String],
    stated: &[(String, f64)],
) -> Result<Option<Covariance>, IoError> {
    let Some(section) = root.section("covariance", KEYS)? else { return Ok(None) };
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
            let number = number(value).ok_or_else(|| wrong(value))?;
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
    let references = references(&section, &ids, &matrix)?;
    Ok(Some(Covariance { ids, matrix, references }))
}

fn number(value: &Value) -> Option<f64> {
    match value.node {
        Node::Number(number) => Some(number),
        Node::Integer(number) => Some(number as f64),
        _ => None,
    }
}

/// The parts of the matrix that references add; the variance of a part is at most that of the whole.
fn references(
    section: &Section<'_>,
    ids: &[String],
    matrix: &DMatrix<f64>,
) -> Result<Vec<(String, DVector<f64>)>, IoError> {
    let names = section.list_of_texts("references", "a list of references")?;
    let expected = "a list of rows of numbers: for each reference a number for each id";
    let rows = match section.get("shifts") {
        None if names.is_empty() => return Ok(Vec::new()),
        None => return Err(section.missing("shifts", expected)),
        Some(Entry { value, .. }) => match &value.node {
            Node::List(rows) => rows,
            _ => return Err(section.wrong_type("shifts", value, expected.into())),
        },
    };
    if rows.len() != names.len() {
        let reason = format!("has {} rows for {} references", rows.len(), names.len());
        return Err(section.conflict("shifts", reason));
    }
    let mut all = Vec::with_capacity(names.len());
    for (name, row) in names.into_iter().zip(rows) {
        let numbers = match &row.node {
            Node::List(numbers) => numbers.iter().map(number).collect::<Option<Vec<f64>>>(),
            _ => None,
        };
        let Some(numbers) = numbers else {
            return Err(section.wrong_type("shifts", row, expected.into()));
        };
        if numbers.len() != ids.len() {
            let reason = format!("has {} numbers for {} ids", numbers.len(), ids.len());
            return Err(section.conflict("shifts", reason));
        }
        let is_part =
            |place: usize| numbers[place].abs() <= MOST_CORRELATION * matrix[(place, place)].sqrt();
        if let Some(place) = (0..ids.len()).find(|&place| !is_part(place)) {
            let reason =
                format!("holds {} for {}, which is beyond its sigma", numbers[place], ids[place]);
            return Err(section.conflict("shifts", reason));
        }
        all.push((name, DVector::from_vec(numbers)));
    }
    Ok(all)
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
    text.push_str("]\n");
    if !covariance.references.is_empty() {
        let names = quoted(covariance.references.iter().map(|(name, _)| name.as_str()));
        let _ = write!(
            text,
            "# Parts of it: changes of the parameters by one standard uncertainty of a reference.\n\
             references = [{names}]\nshifts = [\n"
        );
        for (_, shifts) in &covariance.references {
            let numbers: Vec<String> = shifts.iter().map(|shift| format!("{shift:e}")).collect();
            let _ = writeln!(text, "    [{}],", numbers.join(", "));
        }
        text.push_str("]\n");
    }
    text
}
