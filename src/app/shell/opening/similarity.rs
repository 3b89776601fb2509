//! Similarity of volumes, on which it depends whether a look fits the next one.

use crate::app::common::volume_facts::VolumeFacts;
use chiaroscuro_volume::Volume;

/// Similarity of the next volume to the open one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum VolumeSimilarity {
    /// Same kind of data in the same grid: even the view is worth keeping.
    SameGrid,
    /// Same kind of data in another grid.
    SameKind,
    /// Different data, for which the look is useless.
    Different,
}

impl VolumeSimilarity {
    /// Compares the next volume with the open one. Looks refer to values: with another range, a look would show
    /// nothing of the next volume.
    pub(super) fn between(open: &VolumeFacts, next: &Volume) -> Self {
        let is_same_kind = std::mem::discriminant(&open.kind) == std::mem::discriminant(&next.kind().kind);
        let (a, b) = (open.ranges.robust, next.ranges().robust);
        let shared = a.high.min(b.high) - a.low.max(b.low);
        // Half of the longer range: usual between scans of one protocol, rare between scans of two protocols.
        let are_same_values = 2.0 * shared >= a.span().max(b.span());
        let spacing: [f64; 3] = next.spacing_mm().into();
        match is_same_kind && are_same_values {
            false => Self::Different,
            true if open.dims == next.dims() && open.spacing_mm == spacing => Self::SameGrid,
            true => Self::SameKind,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::app::worker::loader::ReadChoices;
    use chiaroscuro_volume::{Dataset, Samples};

    #[test]
    fn looks_are_kept_for_what_is_alike() {
        let volume = |dims: [usize; 3], high: u8| {
            let values = (0..dims.iter().product::<usize>()).map(|at| (at % usize::from(high)) as u8);
            Volume::with_spacing("t", dims, DVec3::ONE, Samples::U8(values.collect())).unwrap()
        };
        let open =
            VolumeFacts::new("a".into(), ReadChoices::default(), &Dataset::new(volume([8, 8, 8], 200)));
        assert_eq!(VolumeSimilarity::between(&open, &volume([8, 8, 8], 190)), VolumeSimilarity::SameGrid);
        assert_eq!(VolumeSimilarity::between(&open, &volume([9, 8, 8], 190)), VolumeSimilarity::SameKind);
        assert_eq!(
            VolumeSimilarity::between(&open, &volume([8, 8, 8], 60)),
            VolumeSimilarity::Different,
            "other values"
        );
    }
}
