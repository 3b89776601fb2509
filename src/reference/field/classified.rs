//! What the voxels mean, where they are classified before kernels spread them.

use super::pyramid::Pyramid;
use super::{Beyond, Field, Rounding};
use crate::model::BakedTransfer;

/// Whose transfer function classifies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::reference) enum Side {
    /// What the eye sees.
    Eye,
    /// What attenuates light, or the colour of it that is followed.
    Lighting,
    /// What attenuates light from all around, of which all colours are attenuated alike.
    Around,
}

/// All of them.
pub(in crate::reference) const SIDES: [Side; 3] = [Side::Eye, Side::Lighting, Side::Around];

/// Voxels as a transfer function classifies them.
#[derive(Debug, Clone)]
pub(in crate::reference) struct Classified {
    /// The extinction as a share of the largest, in place of a density.
    pub field: Field,
    /// The same, spread.
    pub shares: Pyramid,
    /// Colours times shares, spread.
    pub colors: [Pyramid; 3],
    /// How much extinction a share is.
    pub table: BakedTransfer,
}

impl Classified {
    /// Classifies the densities of voxels. `presence` is what is there where some are missing: others stand in for these,
    /// and what is spread fades with what is there.
    pub(in crate::reference) fn of(
        densities: &Field,
        table: &BakedTransfer,
        presence: Option<&Pyramid>,
        width: f64,
        rounding: Option<Rounding>,
    ) -> Self {
        let largest = f64::from(table.most_extinction()).max(1e-20);
        let beyond = if presence.is_some() { Beyond::Border } else { Beyond::Nothing };
        let field_of = |channel: usize| {
            let share = |&density: &f64| associated(table.sample(density))[channel] / largest;
            let shares = densities.densities.iter().map(share).collect();
            Field { dims: densities.dims, densities: shares, beyond }
        };
        let spread = |channel: usize| Pyramid::faded(&field_of(channel), width, rounding, presence);
        Self {
            field: Field { beyond: Beyond::Nothing, ..field_of(3) },
            shares: spread(3),
            colors: [0, 1, 2].map(spread),
            table: BakedTransfer::of_shares(table.most_extinction()),
        }
    }
}

/// A material with its colours weighted by its extinction.
pub(in crate::reference) fn associated([r, g, b, extinction]: [f64; 4]) -> [f64; 4] {
    [r * extinction, g * extinction, b * extinction, extinction]
}

/// The reverse.
pub(in crate::reference) fn straight([r, g, b, extinction]: [f64; 4]) -> [f64; 4] {
    if extinction <= 0.0 { [0.0; 4] } else { [r / extinction, g / extinction, b / extinction, extinction] }
}
