//! Tables as Parquet: a column of numbers or texts each, units in the metadata of the file.
//!
//! Columns are split into streams of equal bytes and deflated: numbers of a history share their first bytes.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnPath, Type};
use serde_json::{Map, Value};

use super::cells::{Cell, Column};

/// [-] values that are kept until they are written together.
const VALUES_OF_GROUP: usize = 1 << 20;

/// Values of a column that are not written yet; empty cells have no value and level 0.
#[derive(Default)]
struct Pending {
    levels: Vec<i16>,
    numbers: Vec<f64>,
    texts: Vec<ByteArray>,
}

/// A table being written; not readable before its end.
pub struct ParquetWriter {
    columns: Vec<Column>,
    pending: Vec<Pending>,
    rows: usize,
    file: SerializedFileWriter<File>,
}

impl ParquetWriter {
    /// Begins a table.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn create(path: &Path, columns: Vec<Column>) -> io::Result<Self> {
        let mut fields = Vec::with_capacity(columns.len());
        for column in &columns {
            let (physical, logical) = match column.unit {
                Some(_) => (Physical::DOUBLE, None),
                None => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            };
            let field = Type::primitive_type_builder(&column.name, physical)
                .with_repetition(Repetition::OPTIONAL)
                .with_logical_type(logical);
            fields.push(Arc::new(field.build().map_err(failed)?));
        }
        let schema = Type::group_type_builder("roulement").with_fields(fields).build().map_err(failed)?;
        let units = columns
            .iter()
            .filter_map(|column| Some((column.name.clone(), Value::from(column.unit.clone()?))));
        let units = Value::Object(units.collect::<Map<_, _>>()).to_string();
        let mut properties = WriterProperties::builder()
            .set_created_by("roulement".into())
            .set_compression(Compression::GZIP(Default::default()))
            .set_key_value_metadata(Some(vec![KeyValue::new("units".to_string(), units)]));
        for column in columns.iter().filter(|column| column.unit.is_some()) {
            let path = ColumnPath::new(vec![column.name.clone()]);
            properties = properties
                .set_column_dictionary_enabled(path.clone(), false)
                .set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT);
        }
        let file =
            SerializedFileWriter::new(File::create(path)?, Arc::new(schema), Arc::new(properties.build()))
                .map_err(failed)?;
        let pending = columns.iter().map(|_| Pending::default()).collect();
        Ok(Self { columns, pending, rows: 0, file })
    }

    /// Adds a row: as many cells as there are columns, of their kinds; others are left empty.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn push(&mut self, cells: impl Iterator<Item = Cell>) -> io::Result<()> {
        let mut cells = cells.fuse();
        for (column, pending) in self.columns.iter().zip(&mut self.pending) {
            let level = match (cells.next(), &column.unit) {
                (Some(Cell::Number(number)), Some(_)) => {
                    pending.numbers.push(number);
                    1
                }
                (Some(Cell::Text(text)), None) => {
                    pending.texts.push(text.into_bytes().into());
                    1
                }
                _ => 0,
            };
            pending.levels.push(level);
        }
        self.rows += 1;
        if self.rows * self.columns.len() >= VALUES_OF_GROUP { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.rows == 0 {
            return Ok(());
        }
        let mut group = self.file.next_row_group().map_err(failed)?;
        for (column, pending) in self.columns.iter().zip(&mut self.pending) {
            let Some(mut writer) = group.next_column().map_err(failed)? else { break };
            let pending = std::mem::take(pending);
            match column.unit {
                Some(_) => {
                    writer.typed::<DoubleType>().write_batch(&pending.numbers, Some(&pending.levels), None)
                }
                None => {
                    writer.typed::<ByteArrayType>().write_batch(&pending.texts, Some(&pending.levels), None)
                }
            }
            .map_err(failed)?;
            writer.close().map_err(failed)?;
        }
        group.close().map_err(failed)?;
        self.rows = 0;
        Ok(())
    }

    /// Writes what is left, and the end of the file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        self.file.finish().map_err(failed)?;
        self.file.inner().sync_data()
    }
}

fn failed(why: ParquetError) -> io::Error {
    io::Error::other(why)
}
