//! Pre-classification: voxels are classified before kernels spread them.

use super::pyramid::Pyramid;
use super::{BorderMode, DensityField, Rounding};
use chiaroscuro_scene::BakedTransfer;

/// Transfer function by which voxels are classified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TransferSide {
    /// Transfer function of the eye.
    Eye,
    /// Transfer function of lights, for the colour channel that is followed.
    Lighting,
    /// Transfer function of indirect light, which attenuates all colours alike.
    Indirect,
}

/// All transfer functions, in the order of their declaration.
pub(crate) const ALL_TRANSFER_SIDES: [TransferSide; 3] =
    [TransferSide::Eye, TransferSide::Lighting, TransferSide::Indirect];

/// Voxels after classification by a transfer function.
#[derive(Debug, Clone)]
pub(crate) struct ClassifiedVoxels {
    /// Extinction as a share of the largest, in place of a density.
    pub field: DensityField,
    /// Pyramid of the shares of extinction.
    pub shares: Pyramid,
    /// Pyramids of colours times shares, one for each channel.
    pub colors: [Pyramid; 3],
    /// Table that converts a share to extinction.
    pub table: BakedTransfer,
}

impl ClassifiedVoxels {
    /// Classifies the densities of voxels. If some are missing, `presence` is their presence pyramid: missing voxels
    /// have substitute values, and the spread values are multiplied by presence. Edges are made steep if `is_crisp`.
    pub(crate) fn classify(
        densities: &DensityField,
        (table, is_crisp): (&BakedTransfer, bool),
        presence: Option<&Pyramid>,
        width: f64,
        rounding: Option<Rounding>,
    ) -> Self {
        let largest = f64::from(table.max_extinction()).max(1e-20);
        let beyond = if presence.is_some() { BorderMode::Clamp } else { BorderMode::Zero };
        let field_of = |channel: usize| {
            let share = |&density: &f64| associated(table.sample(density))[channel] / largest;
            let shares = densities.densities.iter().map(share).collect();
            DensityField { dims: densities.dims, densities: shares, border: beyond }
        };
        let field = DensityField { border: BorderMode::Zero, ..field_of(3) };
        if is_crisp {
            let fields = [3, 0, 1, 2].map(field_of);
            let pyramids = Pyramid::with_wide_outskirts(fields.each_ref(), width, rounding, presence);
            let [shares, r, g, b] = pyramids;
            return Self { field, shares, colors: [r, g, b], table: table.crisp_ramp() };
        }
        let spread = |channel: usize| Pyramid::with_presence(&field_of(channel), width, rounding, presence);
        Self {
            field,
            shares: spread(3),
            colors: [0, 1, 2].map(spread),
            table: BakedTransfer::linear_ramp(table.max_extinction()),
        }
    }
}

impl ClassifiedVoxels {
    /// Spreads voxels of which colour times extinction, and extinction, are known, as shares of the largest extinction,
    /// or of the opacity that it has over a length. If a mask hides some, `presence` is their presence pyramid, by which
    /// the spread values are multiplied.
    pub(crate) fn from_matter(
        dims: [usize; 3],
        matter: &[[f64; 4]],
        (largest, opacity_length): (f64, Option<f64>),
        presence: Option<&Pyramid>,
        width: f64,
        rounding: Option<Rounding>,
    ) -> Self {
        // A share of the largest extinction, or of the opacity that it has over a length.
        let share = |extinction: f64| match opacity_length {
            None => extinction / largest.max(1e-20),
            Some(length) => (-extinction * length).exp_m1() / (-largest * length).exp_m1().min(-1e-20),
        };
        let field_of = |channel: usize| {
            let shares = matter.iter().map(|matter| {
                let [.., extinction] = *matter;
                if channel == 3 {
                    share(extinction)
                } else {
                    matter[channel] * share(extinction) / extinction.max(1e-20)
                }
            });
            let border = if presence.is_some() { BorderMode::Clamp } else { BorderMode::Zero };
            DensityField { dims, densities: shares.collect(), border }
        };
        let spread = |channel: usize| Pyramid::with_presence(&field_of(channel), width, rounding, presence);
        Self {
            field: DensityField { border: BorderMode::Zero, ..field_of(3) },
            shares: spread(3),
            colors: [0, 1, 2].map(spread),
            table: match opacity_length {
                None => BakedTransfer::linear_ramp(largest as f32),
                Some(length) => BakedTransfer::opacity_ramp(largest as f32, length),
            },
        }
    }
}

/// Multiplies the colours of a material by its extinction.
pub(crate) fn associated([r, g, b, extinction]: [f64; 4]) -> [f64; 4] {
    [r * extinction, g * extinction, b * extinction, extinction]
}

/// Divides the colours of a material by its extinction, the inverse of [`associated`].
pub(crate) fn unassociated([r, g, b, extinction]: [f64; 4]) -> [f64; 4] {
    if extinction <= 0.0 { [0.0; 4] } else { [r / extinction, g / extinction, b / extinction, extinction] }
}
