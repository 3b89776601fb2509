//! Arrays of a file: shape, type, and where their elements are stored.

mod box_copy;
mod chunk_index;
mod filters;
mod layout;
mod slab_reader;

use super::container::{
    Dataspace, FieldCursor, Hdf5File, Hdf5Object, Hdf5Type, MessageKind, ParseResult, parse_dataspace,
};
use chiaroscuro_volume::LoadError;
use filters::FilterPipeline;
use layout::DataLayout;
pub(super) use slab_reader::{ArrayView, contiguous_start, read_view};

/// Array of a file.
#[derive(Debug, Clone)]
pub(super) struct Hdf5Array {
    /// Lengths of the dimensions, slowest first; none of a single element.
    pub(super) shape: Vec<u64>,
    /// Lengths to which the dimensions may grow; `None` without a limit.
    limits: Vec<Option<u64>>,
    pub(super) element_type: Hdf5Type,
    /// Bytes of an element.
    pub(super) element_bytes: usize,
    layout: DataLayout,
    filters: FilterPipeline,
    /// Element where nothing was written, if not zeros.
    fill: Option<Vec<u8>>,
}

impl Hdf5Array {
    /// Reads the description of an array; `name` is for messages.
    pub(super) fn open(file: &Hdf5File<'_>, object: &Hdf5Object, name: &str) -> Result<Self, LoadError> {
        let required = |kind, what: &str| {
            let found = object.message(file, kind)?;
            found.ok_or_else(|| file.broken(name, format!("its {what} is missing")))
        };
        let dataspace = required(MessageKind::DATASPACE, "dataspace")?;
        let Dataspace { shape, limits } = file.parse(&dataspace, name, parse_dataspace)?;
        let datatype = required(MessageKind::DATATYPE, "datatype")?;
        let (element_type, element_bytes) = file.parse(&datatype, name, Hdf5Type::parse)?;
        if object.has(MessageKind::EXTERNAL_FILES) {
            return Err(file.context().bad_input_error(
                name,
                "its elements are stored in other files, which are not followed",
                "write it into one file: h5repack -l NAME:CONTI IN OUT",
            ));
        }
        let layout = required(MessageKind::LAYOUT, "layout")?;
        let layout =
            file.parse(&layout, name, |cursor| DataLayout::parse(cursor, (&shape, element_bytes)))?;
        let filters = match object.message(file, MessageKind::FILTERS)? {
            Some(message) => file.parse(&message, name, FilterPipeline::parse)?,
            None => FilterPipeline::default(),
        };
        let layout = layout.with_filters(!filters.is_empty());
        let fill = fill_value(file, object, name)?.filter(|fill| fill.len() == element_bytes);
        Ok(Self { shape, limits, element_type, element_bytes, layout, filters, fill })
    }

    /// Reason why the elements cannot be read, with what helps; `None` if they can.
    pub(super) fn refusal(&self) -> Option<(String, String)> {
        self.layout.refusal().or_else(|| self.filters.refusal())
    }

    /// Shape of the blocks in which elements are stored.
    fn block_shape(&self) -> Vec<u64> {
        match &self.layout {
            DataLayout::Chunks { shape, .. } => shape.clone(),
            DataLayout::Compact(_) => self.shape.clone(),
            _ => layout::row_block(&self.shape, self.element_bytes),
        }
    }
}

/// Fill value of an array (section IV.A.2.e and f), if one is defined.
fn fill_value(file: &Hdf5File<'_>, object: &Hdf5Object, name: &str) -> Result<Option<Vec<u8>>, LoadError> {
    let sized = |cursor: &mut FieldCursor<'_>| {
        let size = cursor.number(4)?;
        ParseResult::Ok(Some(cursor.take_stored(size)?.to_vec()))
    };
    if let Some(message) = object.message(file, MessageKind::FILL_VALUE)? {
        return file.parse(&message, name, |cursor| {
            let version = cursor.byte()?;
            if version == 3 {
                return if cursor.byte()? & 0x20 == 0 { Ok(None) } else { sized(cursor) };
            }
            cursor.take(2)?;
            if cursor.byte()? == 0 && version > 1 { Ok(None) } else { sized(cursor) }
        });
    }
    let old = object.message(file, MessageKind::OLD_FILL_VALUE)?;
    old.map_or(Ok(None), |message| file.parse(&message, name, sized))
}
