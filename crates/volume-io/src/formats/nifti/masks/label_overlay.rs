//! Label map that masks are painted on, one after the other.

use super::super::super::samples::{ReadFault, alloc_zeroed};
use super::super::super::{LoadControl, LoadError};
use super::HELP;
use chiaroscuro_volume::{LoadContext, PIECE_VALUES, Samples, VoxelType, with_samples};

/// Label map of the masks until now.
#[derive(Debug)]
pub(super) struct LabelOverlay {
    labels: LabelVoxels,
    /// Number of masks that cover voxels of earlier ones.
    covering_masks: usize,
    /// Number of voxels of earlier masks that were covered, a voxel as often as it was.
    covered_voxels: u64,
}

/// Labels of all voxels, 0 where no mask is.
#[derive(Debug)]
enum LabelVoxels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

/// Reason why values were not painted.
#[derive(Debug)]
enum PaintError {
    /// There are two values other than 0.
    TwoValues([f64; 2]),
    /// Painting was cancelled.
    Stopped(LoadError),
}

impl LabelOverlay {
    /// Creates a label map of `count` voxels without labels, of 16 bits or of 8.
    pub(super) fn new(voxel_type: VoxelType, count: usize) -> Result<Self, ReadFault> {
        let labels = match voxel_type {
            VoxelType::U16 => LabelVoxels::Words(alloc_zeroed(count)?),
            _ => LabelVoxels::Bytes(alloc_zeroed(count)?),
        };
        Ok(Self { labels, covering_masks: 0, covered_voxels: 0 })
    }

    /// Gives the label to all voxels within a mask.
    ///
    /// # Errors
    /// `BadInput` where the values are not those of a mask: 0 and one other integer, or 0 and 1 among real numbers.
    pub(super) fn add(
        &mut self,
        context: LoadContext<'_>,
        label: u16,
        mask: &Samples,
        control: &LoadControl,
    ) -> Result<(), LoadError> {
        let painted = match &mut self.labels {
            LabelVoxels::Bytes(labels) => {
                with_samples!(mask, values => paint(labels, label as u8, values, control))
            }
            LabelVoxels::Words(labels) => {
                with_samples!(mask, values => paint(labels, label, values, control))
            }
        };
        let is_real = matches!(mask, Samples::F32(_) | Samples::F64(_));
        let found = match painted {
            Ok((Some(value), _)) if is_real && value != 1.0 => format!("{value}"),
            Ok((_, covered)) => {
                self.covering_masks += usize::from(covered > 0);
                self.covered_voxels += covered;
                return Ok(());
            }
            Err(PaintError::TwoValues([one, other])) => format!("{one} and {other}"),
            Err(PaintError::Stopped(error)) => return Err(error),
        };
        let expected = if is_real { "0 and 1" } else { "0 and one other number" };
        let why = format!("it is not a mask: {expected} were expected, {found} was found");
        Err(context.bad_input_error("data", why, HELP))
    }

    /// Remark for the user on masks that overlap.
    pub(super) fn remark(&self) -> Option<String> {
        let Self { covering_masks, covered_voxels, .. } = self;
        (*covered_voxels > 0).then(|| {
            format!(
                "masks overlap: {covering_masks} of them cover {covered_voxels} voxels of earlier ones; the last \
                 one by name is shown"
            )
        })
    }

    pub(super) fn into_samples(self) -> Samples {
        match self.labels {
            LabelVoxels::Bytes(labels) => Samples::U8(labels),
            LabelVoxels::Words(labels) => Samples::U16(labels),
        }
    }
}

/// Gives the label to all voxels where the mask is not 0. Returns the other value of the mask, if there is one, and
/// the number of voxels that had another label.
fn paint<L, M>(
    labels: &mut [L],
    label: L,
    mask: &[M],
    control: &LoadControl,
) -> Result<(Option<f64>, u64), PaintError>
where
    L: Copy + PartialEq + Default,
    M: Copy + PartialEq + Default + Into<f64>,
{
    let mut inside = None;
    let mut covered = 0;
    for (labels, mask) in labels.chunks_mut(PIECE_VALUES).zip(mask.chunks(PIECE_VALUES)) {
        control.check().map_err(PaintError::Stopped)?;
        for (voxel, &value) in labels.iter_mut().zip(mask) {
            if value == M::default() {
                continue;
            }
            let expected = *inside.get_or_insert(value);
            // Also where both are NaN.
            if value != expected {
                return Err(PaintError::TwoValues([expected.into(), value.into()]));
            }
            covered += u64::from(*voxel != L::default());
            *voxel = label;
        }
    }
    Ok((inside.map(Into::into), covered))
}
