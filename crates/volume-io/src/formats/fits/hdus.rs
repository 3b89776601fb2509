//! Header and data units (HDUs) of a FITS file: which of them are images, and where their data begin.

use super::super::content::FileContent;
use super::super::samples::ReadFault;
use super::super::{LoadControl, LoadError, VolumeOffer};
use super::header::{BLOCK_BYTES, FitsHeader, header_read_error};
use super::layout::FitsLayout;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::LoadContext;

/// Maximum number of units examined in a file: spectrographs and mosaics have some hundred.
const MAX_UNITS: usize = 1024;

/// Content type of a header and data unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FitsUnitKind {
    /// Array of pixels, which may be empty.
    Image,
    /// Array in compressed tiles, stored as a table.
    CompressedImage,
    Table,
    /// Random groups (`GROUPS`): visibilities of an interferometer.
    RandomGroups,
    Other,
}

/// Image unit: an array that is a volume, or several.
#[derive(Debug)]
pub(super) struct FitsImage {
    /// Index of the unit in the file; the primary unit is 0.
    number: usize,
    pub(super) header: FitsHeader,
    /// Byte offset of the data in the uncompressed content.
    pub(super) data_start: u64,
    pub(super) layout: FitsLayout,
}

impl FitsImage {
    /// Returns the image as an item to choose from, by its unit number as in other programs, or by its name.
    pub(super) fn offer(&self) -> VolumeOffer {
        let name = match (self.header.text("EXTNAME"), self.number) {
            ("", 0) => "PRIMARY".to_owned(),
            (name, _) => sanitised(name, 80),
        };
        VolumeOffer { key: self.number.to_string(), name, dims: Some(self.layout.dims), color: None }
    }
}

/// All units of a file, and the images among them.
#[derive(Debug, Default)]
pub(super) struct FitsUnits {
    pub(super) images: Vec<FitsImage>,
    /// Reason why the first unusable array is no volume.
    first_error: Option<LoadError>,
    kinds: Vec<FitsUnitKind>,
}

impl FitsUnits {
    /// Scans all units of a file, from its beginning.
    ///
    /// # Errors
    /// `BadInput` for an invalid first header and for corrupt gzip data, `Limit` for a header without an end. Other
    /// errors behind the first unit end the list.
    pub(super) fn read(
        context: LoadContext<'_>,
        content: &mut FileContent,
        is_gzip: bool,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        let mut units = Self::default();
        let mut at = 0u64;
        while units.kinds.len() < MAX_UNITS {
            let is_first = units.kinds.is_empty();
            let Some(header) = FitsHeader::read(context, content, is_first, control)? else { break };
            // Trailing bytes behind the last unit, which are no extension.
            if !is_first && header.first_keyword() != "XTENSION" {
                break;
            }
            let data_start = at.saturating_add(header.bytes);
            let data_bytes = match data_bytes(context, &header) {
                Ok(bytes) => bytes,
                Err(error) if is_first => return Err(error),
                Err(_) => break,
            };
            units.add(context, header, data_start);
            at = data_start.saturating_add(data_bytes.div_ceil(BLOCK_BYTES).saturating_mul(BLOCK_BYTES));
            match content.seek_forward(at, control).map_err(ReadFault::into_decoder_fault) {
                Ok(()) => {}
                // The next unit would begin beyond the end of the file, or of the range of offsets: the list ends.
                Err(ReadFault::Short { .. }) => break,
                Err(ReadFault::Corrupt(_)) if !is_gzip => break,
                Err(fault) => return Err(header_read_error(context, fault)),
            }
        }
        Ok(units)
    }

    fn add(&mut self, context: LoadContext<'_>, header: FitsHeader, data_start: u64) {
        let number = self.kinds.len();
        let kind = kind_of(&header);
        self.kinds.push(kind);
        if kind != FitsUnitKind::Image {
            return;
        }
        match FitsLayout::new(context, &header) {
            Ok(Some(layout)) => self.images.push(FitsImage { number, header, data_start, layout }),
            Ok(None) => {}
            Err(error) => {
                self.first_error.get_or_insert(error);
            }
        }
    }

    /// Makes the error that explains why no unit is a volume.
    pub(super) fn no_image_error(self, context: LoadContext<'_>) -> LoadError {
        let has = |kind| self.kinds.contains(&kind);
        if let Some(error) = self.first_error {
            error
        } else if has(FitsUnitKind::CompressedImage) {
            context.bad_input_error(
                "ZIMAGE",
                "its images are compressed in tiles (as by fpack), which is not supported",
                "unpack it: funpack -O OUT.fits IN.fits.fz",
            )
        } else if has(FitsUnitKind::RandomGroups) {
            context.bad_input_error(
                "GROUPS",
                "it holds visibilities of an interferometer (random groups), not an image",
                "make an image of them first, for example with CASA's tclean, and export it with exportfits",
            )
        } else if has(FitsUnitKind::Table) {
            context.bad_input_error(
                "XTENSION",
                "it holds tables and no image",
                "open a file with an image of two axes or more; TOPCAT shows tables",
            )
        } else {
            context.bad_input_error(
                "NAXIS",
                "it holds no image: no header and data unit (HDU) has two axes or more",
                "open a file with an image of two to four axes",
            )
        }
    }

    /// Returns a remark for the user on units that cannot be chosen.
    pub(super) fn remark(&self) -> Option<&'static str> {
        let is_packed = self.kinds.contains(&FitsUnitKind::CompressedImage);
        is_packed.then_some("images that are compressed in tiles are left out: funpack unpacks them")
    }
}

fn kind_of(header: &FitsHeader) -> FitsUnitKind {
    match (header.first_keyword(), header.text("XTENSION")) {
        ("XTENSION", "BINTABLE" | "A3DTABLE") if header.is_true("ZIMAGE") => FitsUnitKind::CompressedImage,
        ("XTENSION", "BINTABLE" | "A3DTABLE" | "TABLE") => FitsUnitKind::Table,
        ("XTENSION", "IMAGE" | "IUEIMAGE") => FitsUnitKind::Image,
        ("XTENSION", _) => FitsUnitKind::Other,
        _ if header.is_true("GROUPS") && header.text("NAXIS1") == "0" => FitsUnitKind::RandomGroups,
        _ => FitsUnitKind::Image,
    }
}

/// Returns the size of a unit's data in bytes, without the fill of the last block (section 4.4.1.2).
fn data_bytes(context: LoadContext<'_>, header: &FitsHeader) -> Result<u64, LoadError> {
    let bits = header.required_int(context, "BITPIX")?.unsigned_abs();
    let mut axes = header.axes(context)?;
    let is_grouped = kind_of(header) == FitsUnitKind::RandomGroups;
    if is_grouped {
        axes.remove(0);
    }
    if axes.is_empty() {
        return Ok(0);
    }
    let count = |keyword, otherwise: u64| {
        let said = header.int(context, keyword)?;
        Ok::<_, LoadError>(said.map_or(otherwise, |n| u64::try_from(n).unwrap_or(0)))
    };
    let (parameters, groups) = (count("PCOUNT", 0)?, count("GCOUNT", 1)?);
    let elements = axes.into_iter().fold(1u64, u64::saturating_mul);
    Ok(elements.saturating_add(parameters).saturating_mul(groups).saturating_mul(bits / 8))
}
