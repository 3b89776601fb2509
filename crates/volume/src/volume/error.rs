//! Errors of constructing a volume.

/// Reason why a grid and its values do not form a volume.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum VolumeError {
    #[error("the volume is empty ({dims:?} voxels): every dimension must be at least 1")]
    Empty { dims: [usize; 3] },
    #[error("{dims:?} voxels were expected, {found} were found")]
    WrongCount { dims: [usize; 3], found: usize },
    #[error("the spacing or orientation is unusable ({what}): it must be finite, with independent axes")]
    BadGeometry { what: String },
    #[error("the region is empty, or reaches beyond the {dims:?} voxels")]
    Outside { dims: [usize; 3] },
    #[error("no voxel has a finite value")]
    NothingFinite,
    #[error("the values reach {range}, beyond the range of 64-bit numbers: they must span less than 1.8e308")]
    TooWide { range: String },
    #[error("there is not enough memory for the converted values ({bytes} bytes): close other programs")]
    NoMemory { bytes: u64 },
}
