//! Rule for the resolution level that is read of an image.

/// Rule for the resolution level that is read where the user has chosen none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LevelRule {
    /// Finest level that fits into memory and on the graphics adapter.
    #[default]
    Finest,
    /// Finest level of all if it fits; otherwise a level of at most this number of voxels, because parts of the finer ones are
    /// read where pictures show them.
    BesidePages(u64),
    /// Level of at most this number of voxels that is not the finest, even where that one fits.
    AlwaysBesidePages(u64),
}

impl LevelRule {
    /// Number of voxels in memory beside pages on a graphics card: 512³, of which light volumes are quick.
    pub const CARD_VOXELS: u64 = 1 << 27;
    /// Number of voxels in memory beside pages on a software adapter: 256³, whose first picture takes seconds.
    pub const SOFTWARE_VOXELS: u64 = 1 << 24;

    /// Returns the rule for a level beside pages, for a software adapter or a graphics card, unless this one is for some already.
    #[must_use]
    pub fn or_beside_pages(self, is_software: bool) -> Self {
        match self {
            Self::Finest if is_software => Self::BesidePages(Self::SOFTWARE_VOXELS),
            Self::Finest => Self::BesidePages(Self::CARD_VOXELS),
            Self::BesidePages(_) | Self::AlwaysBesidePages(_) => self,
        }
    }
}
