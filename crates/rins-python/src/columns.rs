//! Columns of numbers from Python: arrays and Arrow tables in, Arrow tables out.

use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{
    Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, TimestampMicrosecondType,
    TimestampMillisecondType, TimestampNanosecondType, TimestampSecondType, UInt8Type, UInt16Type,
    UInt32Type, UInt64Type,
};
use arrow_array::{
    Array, ArrayRef, ArrowPrimitiveType, BooleanArray, Float64Array, Int64Array, RecordBatch,
    StringArray,
};
use arrow_schema::{DataType, TimeUnit};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3_arrow::PyTable;
use rins::io::{ColumnNumbers, LogColumns};

use crate::error::data_error;

/// Columns in memory from arrays of `float64` or `int64` with one dimension, which are read where they lie.
pub(crate) fn log_columns(
    log: &str,
    arrays: Vec<(String, Bound<'_, PyAny>)>,
) -> PyResult<LogColumns> {
    let mut columns = LogColumns::new(log);
    for (name, array) in arrays {
        let numbers = match array.extract::<PyReadonlyArray1<'_, f64>>() {
            Ok(array) => ColumnNumbers::Real(array.as_array().iter().copied().collect()),
            Err(_) => {
                let array: PyReadonlyArray1<'_, i64> = array.extract()?;
                ColumnNumbers::Whole(array.as_array().iter().copied().collect())
            }
        };
        columns.push(name, numbers);
    }
    Ok(columns)
}

/// The columns of numbers of an object with `__arrow_c_stream__`; columns of another type are left out.
pub(crate) fn log_columns_of_stream(
    py: Python<'_>,
    log: &str,
    data: &Bound<'_, PyAny>,
) -> PyResult<LogColumns> {
    let (batches, schema) = data.extract::<PyTable>()?.into_inner();
    let mut columns = LogColumns::new(log);
    for (place, field) in schema.fields().iter().enumerate() {
        let Some(read) = Read::of(field.data_type()) else { continue };
        let chunks = batches.iter().map(|batch| batch.column(place));
        let numbers = read.numbers(chunks).map_err(|row| {
            let name = field.name();
            let message =
                format!("{log}: row {row}: column {name:?}: empty, expected a whole number");
            data_error(py, message, log, name)
        })?;
        columns.push(field.name(), numbers);
    }
    Ok(columns)
}

/// The reading of a column of an Arrow type.
enum Read {
    Real(fn(&ArrayRef, &mut Vec<f64>)),
    /// Returns the first row without a number, or with one that is too large.
    Whole(fn(&ArrayRef, &mut Vec<i64>) -> Option<usize>),
}

impl Read {
    /// The reading; `None` for a type that has no numbers. A time stamp is a number of nanoseconds.
    fn of(kind: &DataType) -> Option<Self> {
        Some(match kind {
            DataType::Float64 => Self::Real(real::<Float64Type>),
            DataType::Float32 => Self::Real(real::<Float32Type>),
            DataType::Int8 => Self::Whole(whole::<Int8Type, 1>),
            DataType::Int16 => Self::Whole(whole::<Int16Type, 1>),
            DataType::Int32 => Self::Whole(whole::<Int32Type, 1>),
            DataType::Int64 => Self::Whole(whole::<Int64Type, 1>),
            DataType::UInt8 => Self::Whole(whole::<UInt8Type, 1>),
            DataType::UInt16 => Self::Whole(whole::<UInt16Type, 1>),
            DataType::UInt32 => Self::Whole(whole::<UInt32Type, 1>),
            DataType::UInt64 => Self::Whole(whole::<UInt64Type, 1>),
            DataType::Timestamp(unit, _) => Self::Whole(match unit {
                TimeUnit::Second => whole::<TimestampSecondType, 1_000_000_000>,
                TimeUnit::Millisecond => whole::<TimestampMillisecondType, 1_000_000>,
                TimeUnit::Microsecond => whole::<TimestampMicrosecondType, 1_000>,
                TimeUnit::Nanosecond => whole::<TimestampNanosecondType, 1>,
            }),
            _ => return None,
        })
    }

    /// The numbers of all chunks.
    ///
    /// # Errors
    /// The row, from 1, without a number.
    fn numbers<'a>(
        self,
        chunks: impl Iterator<Item = &'a ArrayRef>,
    ) -> Result<ColumnNumbers, usize> {
        match self {
            Self::Real(read) => {
                let mut list = Vec::new();
                chunks.for_each(|chunk| read(chunk, &mut list));
                Ok(ColumnNumbers::Real(list))
            }
            Self::Whole(read) => {
                let mut list = Vec::new();
                for chunk in chunks {
                    let before = list.len();
                    if let Some(row) = read(chunk, &mut list) {
                        return Err(before + row + 1);
                    }
                }
                Ok(ColumnNumbers::Whole(list))
            }
        }
    }
}

/// Appends numbers, NaN where one is missing.
fn real<T: ArrowPrimitiveType<Native: Into<f64>>>(chunk: &ArrayRef, list: &mut Vec<f64>) {
    let chunk = chunk.as_primitive::<T>();
    if chunk.null_count() == 0 {
        list.extend(chunk.values().iter().map(|number| (*number).into()));
    } else {
        list.extend(chunk.iter().map(|number| number.map_or(f64::NAN, Into::into)));
    }
}

/// Appends integers in units of `UNIT`; returns the first row without one.
fn whole<T: ArrowPrimitiveType<Native: TryInto<i64>>, const UNIT: i64>(
    chunk: &ArrayRef,
    list: &mut Vec<i64>,
) -> Option<usize> {
    let chunk = chunk.as_primitive::<T>();
    for (row, number) in chunk.iter().enumerate() {
        let number = number.and_then(|number| number.try_into().ok());
        match number.and_then(|number: i64| number.checked_mul(UNIT)) {
            Some(number) => list.push(number),
            None => return Some(row),
        }
    }
    None
}

/// A column of a table that is made from Python lists; `None` is a missing value.
#[derive(FromPyObject)]
pub(crate) enum List {
    Flags(Vec<Option<bool>>),
    Integers(Vec<Option<i64>>),
    Numbers(Vec<Option<f64>>),
    Texts(Vec<Option<String>>),
}

impl List {
    fn array(self) -> ArrayRef {
        match self {
            Self::Flags(list) => Arc::new(BooleanArray::from(list)),
            Self::Integers(list) => Arc::new(Int64Array::from(list)),
            Self::Numbers(list) => Arc::new(Float64Array::from(list)),
            Self::Texts(list) => Arc::new(StringArray::from(list)),
        }
    }
}

/// An Arrow table of columns: pairs of a name and a list.
#[pyfunction]
pub(crate) fn table(columns: Vec<(String, List)>) -> PyResult<PyTable> {
    let arrays = columns.into_iter().map(|(name, list)| (name, list.array(), true));
    let batch = RecordBatch::try_from_iter_with_nullable(arrays)
        .map_err(|error| PyValueError::new_err(error.to_string()))?;
    let schema = batch.schema();
    PyTable::try_new(vec![batch], schema)
}
