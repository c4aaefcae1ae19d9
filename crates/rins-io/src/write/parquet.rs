//! Recordings as Parquet (‹parquet›).

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use rins_motion::Recording;

use super::failure::Failure;
use super::signals::{COLUMNS, channel, others};
use crate::error::WriteProblem;

/// The number of rows in a row group, of which two copies are in memory.
const GROUP: usize = 1 << 20;

/// Writes one double column for each signal, with the names of the CSV columns.
pub(super) fn write(recording: &Recording, out: &mut (dyn Write + Send)) -> Result<(), Failure> {
    encode(recording, out).map_err(|error| match error {
        ParquetError::External(inner) => match inner.downcast::<std::io::Error>() {
            Ok(error) => Failure::System(*error),
            Err(other) => refused(&other.to_string()),
        },
        other => refused(&other.to_string()),
    })
}

fn refused(message: &str) -> Failure {
    WriteProblem::Encoder { format: "parquet", message: message.into() }.into()
}

fn encode(recording: &Recording, out: &mut (dyn Write + Send)) -> Result<(), ParquetError> {
    let others = others(recording);
    let names = std::iter::once("time").chain(COLUMNS).chain(others.iter().map(|(name, _)| *name));
    let fields = names.map(|name| {
        let field = Type::primitive_type_builder(name, Physical::DOUBLE);
        field.with_repetition(Repetition::REQUIRED).build().map(Arc::new)
    });
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("run").with_fields(fields).build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::Chunk);
    let properties = Arc::new(properties.build());
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), properties)?;
    let mut first = 0;
    while first < recording.len() {
        let end = (first + GROUP).min(recording.len());
        let mut group = writer.next_row_group()?;
        let mut signals = Vec::with_capacity(end - first);
        for signal in 0..7 + others.len() {
            signals.clear();
            match signal {
                0 => signals.extend_from_slice(&recording.times[first..end]),
                1..7 => {
                    signals.extend(channel(recording, signal - 1).skip(first).take(end - first));
                }
                _ => signals.extend_from_slice(&others[signal - 7].1[first..end]),
            }
            let mut column = group
                .next_column()?
                .ok_or_else(|| ParquetError::General("a column is missing".into()))?;
            column.typed::<DoubleType>().write_batch(&signals, None, None)?;
            column.close()?;
        }
        group.close()?;
        first = end;
    }
    writer.close()?;
    Ok(())
}
