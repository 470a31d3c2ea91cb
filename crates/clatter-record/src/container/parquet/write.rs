//! Parquet files of doubles.

use super::{ARROW_SCHEMA, MAGIC, damaged};
use crate::Error;
use crate::container::{arrow, equal_length, refuse};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use polars_parquet_format::thrift::protocol::TCompactOutputProtocol;
use polars_parquet_format::{
    ColumnChunk, ColumnMetaData, CompressionCodec, DataPageHeader, Encoding, FieldRepetitionType, FileMetaData,
    KeyValue, PageHeader, PageType, RowGroup, SchemaElement, Type,
};

/// Numbers of a page: 1 MiB, as the documentation of the format recommends.
const PAGE: usize = 1 << 17;

/// A column to write.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Series<'a> {
    /// Its name, without the unit.
    pub name: &'a str,
    /// Its unit, such as `m/s2`.
    pub unit: &'a str,
    /// Its numbers.
    pub values: &'a [f64],
}

/// The bytes of a Parquet file with these columns, as `name [unit]`; the unit stands in the metadata of each as well, as
/// Arrow has them.
///
/// The numbers are doubles, to the bit, without compression, in one row group.
///
/// # Errors
/// [`Error::File`] where columns differ in length, two have one name, or there are none.
///
/// # Examples
/// ```
/// use clatter_record::{Kind, Series, Values, read, write_parquet};
/// let file = write_parquet(&[
///     Series { name: "time", unit: "s", values: &[0.0, 0.001] },
///     Series { name: "ax", unit: "m/s2", values: &[0.0, -9.81] },
/// ])?;
/// let table = read(Kind::of(&file)?, &file, 4)?;
/// assert_eq!(table.columns[1].name, "ax [m/s2]");
/// assert_eq!(table.columns[1].unit.as_deref(), Some("m/s2"));
/// assert_eq!(table.columns[1].values, Values::Float(vec![0.0, -9.81]));
/// # Ok::<(), clatter_record::Error>(())
/// ```
pub fn write(columns: &[Series<'_>]) -> Result<Vec<u8>, Error> {
    let values: Vec<&[f64]> = columns.iter().map(|column| column.values).collect();
    let rows = equal_length(&values)?;
    let named: Vec<(String, &str)> =
        columns.iter().map(|column| (format!("{} [{}]", column.name, column.unit), column.unit)).collect();
    let mut names: Vec<&str> = named.iter().map(|column| column.0.as_str()).collect();
    names.sort_unstable();
    if let Some([name, ..]) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(refuse(format!("two columns are named {name:?}; each needs a name of its own")));
    }
    let count = |number: usize| i64::try_from(number).map_err(damaged);
    let mut file = MAGIC.to_vec();
    let mut chunks = Vec::new();
    for ((name, _), values) in named.iter().zip(values) {
        let start = file.len();
        values.chunks(PAGE).try_for_each(|values| page(&mut file, values))?;
        let size = count(file.len() - start)?;
        chunks.push(chunk(name, [count(rows)?, count(start)?, size]));
    }
    let bytes = count(file.len() - MAGIC.len())?;
    let group = RowGroup {
        columns: chunks,
        total_byte_size: bytes,
        num_rows: count(rows)?,
        sorting_columns: None,
        file_offset: Some(count(MAGIC.len())?),
        total_compressed_size: Some(bytes),
        ordinal: Some(0),
    };
    let arrow = KeyValue::new(ARROW_SCHEMA.to_owned(), STANDARD.encode(arrow::schema_message(&named)));
    let mut schema = vec![element("schema", Some(i32::try_from(named.len()).map_err(damaged)?))];
    schema.extend(named.iter().map(|(name, _)| element(name, None)));
    let metadata =
        FileMetaData::new(2, schema, count(rows)?, vec![group], vec![arrow], "clatter".to_owned(), None, None, None);
    let start = file.len();
    metadata.write_to_out_protocol(&mut TCompactOutputProtocol::new(&mut file)).map_err(damaged)?;
    let length = u32::try_from(file.len() - start).map_err(damaged)?;
    file.extend_from_slice(&length.to_le_bytes());
    file.extend_from_slice(MAGIC);
    Ok(file)
}

/// A page: its head, then the numbers.
fn page(file: &mut Vec<u8>, values: &[f64]) -> Result<(), Error> {
    let size = i32::try_from(8 * values.len()).map_err(damaged)?;
    let count = i32::try_from(values.len()).map_err(damaged)?;
    let data = DataPageHeader::new(count, Encoding::PLAIN, Encoding::RLE, Encoding::RLE, None);
    let head = PageHeader::new(PageType::DATA_PAGE, size, size, None, data, None, None, None);
    head.write_to_out_protocol(&mut TCompactOutputProtocol::new(&mut *file)).map_err(damaged)?;
    file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    Ok(())
}

/// Where the pages of a column are.
fn chunk(name: &str, [rows, start, size]: [i64; 3]) -> ColumnChunk {
    let metadata = ColumnMetaData {
        type_: Type::DOUBLE,
        encodings: vec![Encoding::PLAIN],
        path_in_schema: vec![name.to_owned()],
        codec: CompressionCodec::UNCOMPRESSED,
        num_values: rows,
        total_uncompressed_size: size,
        total_compressed_size: size,
        key_value_metadata: None,
        data_page_offset: start,
        index_page_offset: None,
        dictionary_page_offset: None,
        statistics: None,
        encoding_stats: None,
        bloom_filter_offset: None,
        bloom_filter_length: None,
        size_statistics: None,
    };
    ColumnChunk {
        file_path: None,
        file_offset: start,
        meta_data: Some(metadata),
        offset_index_offset: None,
        offset_index_length: None,
        column_index_offset: None,
        column_index_length: None,
        crypto_metadata: None,
        encrypted_column_metadata: None,
    }
}

/// The root of the schema, with so many children, or a column of doubles.
fn element(name: &str, children: Option<i32>) -> SchemaElement {
    let leaf = children.is_none();
    SchemaElement {
        type_: leaf.then_some(Type::DOUBLE),
        type_length: None,
        repetition_type: leaf.then_some(FieldRepetitionType::REQUIRED),
        name: name.to_owned(),
        num_children: children,
        converted_type: None,
        scale: None,
        precision: None,
        field_id: None,
        logical_type: None,
    }
}
