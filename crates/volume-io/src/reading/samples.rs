//! Decoding of bytes into typed voxels, block by block.
//!
//! Only the voxels themselves and one block are in memory at a time. Allocation is fallible: a header that lies about
//! its size causes an error, not an abort. Readers are `dyn`: for each kind of reader apart, these functions would be
//! compiled some forty times, and a call for each block costs nothing.

use std::io::{self, Read};

use bytemuck::Pod;

use super::{Endian, LoadControl, LoadError};
use crate::huge_pages::advise_huge_pages;
use chiaroscuro_files::fault;
use chiaroscuro_volume::{GridExtent, LoadContext, Samples, VoxelType, human_bytes, quoted};

/// Bytes that are read and decoded at a time, between two checks for cancellation.
pub(crate) const BLOCK_BYTES: usize = 1 << 20;

/// Size, number type and byte order of stored voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct VoxelLayout {
    pub(crate) extent: GridExtent,
    pub(crate) voxel_type: VoxelType,
    pub(crate) endian: Endian,
}

/// Failure between a file and its voxels.
#[derive(Debug)]
pub(crate) enum ReadFault {
    /// The data end after `got` bytes (or numbers) of voxels.
    Short { got: u64 },
    /// There are more voxels than announced.
    Long,
    /// The compressed stream is corrupt.
    Corrupt(io::Error),
    /// Text where a number of the voxel type was expected.
    NotANumber { text: String },
    /// Allocation of the memory for the voxels failed.
    NoMemory,
    /// The operating system could not read the file.
    Io(io::Error),
    /// Reading was cancelled, or stopped by another error that is passed on.
    Stopped(LoadError),
}

impl From<LoadError> for ReadFault {
    fn from(stopped: LoadError) -> Self {
        Self::Stopped(stopped)
    }
}

impl ReadFault {
    /// Adds to `Short` the bytes of voxels that had been read before this part.
    pub(super) fn with_bytes_before(self, bytes: u64) -> Self {
        match self {
            Self::Short { got } => Self::Short { got: bytes + got },
            fault => fault,
        }
    }

    /// Reclassifies an I/O error as `Corrupt` where a decoder reported it: for streams that were read through one.
    pub(crate) fn into_decoder_fault(self) -> Self {
        match self {
            Self::Io(error) if is_corruption(&error) => Self::Corrupt(error),
            fault => fault,
        }
    }

    /// Converts to the error to report, with `help` for sizes that do not fit.
    pub(crate) fn into_error(
        self,
        context: LoadContext<'_>,
        layout: &VoxelLayout,
        unit: &str,
        help: &str,
    ) -> LoadError {
        let [x, y, z] = layout.extent.dims;
        let name = layout.voxel_type.name();
        let announced = if unit == "bytes" { layout.extent.bytes } else { layout.extent.voxels as u64 };
        let grid = format!("{x} x {y} x {z} voxels of {name}");
        match self {
            Self::Short { got } => context.bad_input_error(
                "data",
                format!("the data are truncated: {announced} {unit} expected for {grid}, {got} found"),
                help,
            ),
            Self::Long => context.bad_input_error(
                "data",
                format!("there is more data than the {announced} {unit} expected for {grid}"),
                help,
            ),
            Self::Corrupt(error) => context.bad_input_error(
                "data",
                match error.kind() {
                    io::ErrorKind::UnexpectedEof => {
                        "the gzip data are truncated: they end too early".to_owned()
                    }
                    _ => format!("the gzip data are broken: {error}"),
                },
                "copy or download the file again",
            ),
            Self::NotANumber { text } => context.bad_input_error(
                "data",
                format!("a number of type {name} was expected, {} was found", quoted(&text)),
                "check the type and that the data are plain numbers",
            ),
            Self::NoMemory => context.limit_error(
                "data",
                format!(
                    "there is not enough memory for {grid}: {}",
                    human_bytes(u128::from(layout.extent.bytes))
                ),
                "close other programs or load a smaller volume",
            ),
            Self::Io(error) => context.io_error(error),
            Self::Stopped(error) => error,
        }
    }
}

/// Number type of a voxel that can be decoded from bytes.
pub(crate) trait DecodeSample: Pod + Send {
    fn from_bytes(bytes: &[u8], endian: Endian) -> Self;

    /// Swaps the bytes of a number that was read in file order into machine order.
    fn to_native_order(self, endian: Endian) -> Self;
}

macro_rules! sample {
    ($($type:ty),*) => { $(
        impl DecodeSample for $type {
            fn from_bytes(bytes: &[u8], endian: Endian) -> Self {
                // Blocks hold whole voxels, so that the chunk always has the right length.
                let mut array = [0; size_of::<Self>()];
                array.copy_from_slice(bytes);
                match endian {
                    Endian::Little => Self::from_le_bytes(array),
                    Endian::Big => Self::from_be_bytes(array),
                }
            }

            fn to_native_order(self, endian: Endian) -> Self {
                match endian {
                    Endian::Little => Self::from_le_bytes(self.to_ne_bytes()),
                    Endian::Big => Self::from_be_bytes(self.to_ne_bytes()),
                }
            }
        }
    )* };
}
sample!(u8, i8, u16, i16, u32, i32, u64, i64, f32, f64);

/// Calls a generic reader with the voxel type, and wraps its vector in `Samples`.
macro_rules! read_as {
    ($voxel_type:expr, $read:ident($($argument:expr),*)) => {
        match $voxel_type {
            VoxelType::U8 => $read($($argument),*).map(Samples::U8),
            VoxelType::I8 => $read($($argument),*).map(Samples::I8),
            VoxelType::U16 => $read($($argument),*).map(Samples::U16),
            VoxelType::I16 => $read($($argument),*).map(Samples::I16),
            VoxelType::U32 => $read($($argument),*).map(Samples::U32),
            VoxelType::I32 => $read($($argument),*).map(Samples::I32),
            VoxelType::F32 => $read($($argument),*).map(Samples::F32),
            VoxelType::F64 => $read($($argument),*).map(Samples::F64),
        }
    };
}

pub(super) use read_as;

/// Reads all binary voxels of a grid; bytes after them are not touched.
pub(crate) fn read_binary(
    reader: &mut dyn Read,
    layout: &VoxelLayout,
    control: &LoadControl,
) -> Result<Samples, ReadFault> {
    read_as!(layout.voxel_type, read_blocks(reader, layout, control))
}

/// Returns true if a decoder complains about the data (rather than the disk about the file).
pub(crate) fn is_corruption(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof
    )
}

/// Fills `block` until it is full or the reader ends; returns the number of bytes read.
pub(crate) fn read_until_full(
    reader: &mut dyn Read,
    block: &mut [u8],
    control: &LoadControl,
) -> Result<usize, ReadFault> {
    let mut filled = 0;
    while filled < block.len() {
        control.check().map_err(ReadFault::Stopped)?;
        if fault::is_due(fault::FaultEvent::BlockRead, fault::InjectedFault::ReadError) {
            return Err(ReadFault::Io(io::Error::other("a fault was injected")));
        }
        // In blocks, so that cancellation is noticed in between.
        let end = block.len().min(filled + BLOCK_BYTES);
        match reader.read(&mut block[filled..end]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(ReadFault::Io(error)),
        }
    }
    Ok(filled)
}

/// Reads and discards up to `count` bytes; returns how many there were.
pub(crate) fn skip_bytes(reader: &mut dyn Read, count: u64, control: &LoadControl) -> Result<u64, ReadFault> {
    let mut block = vec![0; BLOCK_BYTES.min(usize::try_from(count).unwrap_or(BLOCK_BYTES))];
    let mut skipped = 0;
    while skipped < count {
        let want = block.len().min(usize::try_from(count - skipped).unwrap_or(block.len()));
        let got = read_until_full(reader, &mut block[..want], control)?;
        skipped += got as u64;
        if got < want {
            break;
        }
    }
    Ok(skipped)
}

fn read_blocks<T: DecodeSample>(
    reader: &mut dyn Read,
    layout: &VoxelLayout,
    control: &LoadControl,
) -> Result<Vec<T>, ReadFault> {
    let mut values = alloc_zeroed::<T>(layout.extent.voxels)?;
    let mut done = 0;
    for block in values.chunks_mut(BLOCK_BYTES / size_of::<T>()) {
        done += read_block(reader, block, layout.endian, control)
            .map_err(|fault| fault.with_bytes_before(done))?;
    }
    Ok(values)
}

/// Reads voxels until `block` is full; returns their number of bytes in the file.
pub(super) fn read_block<T: DecodeSample>(
    reader: &mut dyn Read,
    block: &mut [T],
    endian: Endian,
    control: &LoadControl,
) -> Result<u64, ReadFault> {
    let bytes: &mut [u8] = bytemuck::cast_slice_mut(block);
    let wanted = bytes.len();
    let got = read_until_full(reader, bytes, control)?;
    control.advance(got as u64);
    if got < wanted {
        return Err(ReadFault::Short { got: got as u64 });
    }
    // In machine order this is the identity, which the compiler optimises away.
    match endian {
        Endian::Little => block.iter_mut().for_each(|value| *value = value.to_native_order(Endian::Little)),
        Endian::Big => block.iter_mut().for_each(|value| *value = value.to_native_order(Endian::Big)),
    }
    Ok(got as u64)
}

/// Allocates `count` zeros, or returns an error where memory is exhausted. Pages are committed as they are written
/// to.
pub(crate) fn alloc_zeroed<T: Pod>(count: usize) -> Result<Vec<T>, ReadFault> {
    let mut values = bytemuck::allocation::try_zeroed_vec(count).map_err(|()| ReadFault::NoMemory)?;
    advise_huge_pages(values.as_mut_ptr(), count);
    Ok(values)
}

/// Allocates an empty vector of capacity `count`, or returns an error where memory is exhausted.
pub(crate) fn alloc_with_capacity<T>(count: usize) -> Result<Vec<T>, ReadFault> {
    let mut values = Vec::new();
    match values.try_reserve_exact(count) {
        Ok(()) => {
            advise_huge_pages::<T>(values.as_mut_ptr(), count);
            Ok(values)
        }
        Err(_) => Err(ReadFault::NoMemory),
    }
}
