//! Requests of the window to the render thread.

use std::path::PathBuf;

use super::quality::QualityLevel;
use chiaroscuro_render::{
    PictureOptions, Renderer,
    plan::{FrameKeys, RenderRequest},
};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{Dataset, DensityMapping, ValueRange, ValueRanges};
use chiaroscuro_volume_io::{FilePages, LoadOptions};

/// Single look, or two looks that are compared.
#[derive(Debug, Clone)]
pub(crate) struct ComparedLooks {
    /// The only look, or the one left of the divider.
    pub left: Settings,
    /// Look right of the divider.
    pub right: Option<Settings>,
}

impl ComparedLooks {
    /// Gives both looks one range of values for densities 0 to 1: the volume is uploaded for a range, and would
    /// otherwise be uploaded twice per picture.
    fn with_common_range(self, ranges: &ValueRanges) -> Self {
        let Some(right) = &self.right else { return self };
        let (DensityMapping::Range(a), DensityMapping::Range(b)) =
            (self.left.shown_content(ranges), right.shown_content(ranges))
        else {
            return self;
        };
        let both = ValueRange::new(a.low.min(b.low), a.high.max(b.high));
        Self {
            left: self.left.with_density_range(both, ranges),
            right: Some(right.with_density_range(both, ranges)),
        }
    }
}

/// Request for one picture of the window, or for the two of a comparison. Requests are equal if they need the same
/// products: names, and kept views and looks, do not count.
#[derive(Debug, Clone)]
pub(crate) struct FrameRequest {
    /// Counter of volumes, which distinguishes pictures of the present volume from those of an earlier one.
    pub generation: u64,
    /// Look, or two compared looks, to be rendered.
    pub looks: ComparedLooks,
    /// Size of the picture, in window pixels.
    pub size: [u32; 2],
    /// Keys of the products for the picture, or the left one of a comparison, at full quality.
    left_keys: FrameKeys,
    /// Keys of the products for the right picture at full quality.
    right_keys: Option<FrameKeys>,
}

impl PartialEq for FrameRequest {
    fn eq(&self, other: &Self) -> bool {
        self.generation == other.generation
            && self.left_keys == other.left_keys
            && self.right_keys == other.right_keys
    }
}

impl FrameRequest {
    /// Creates a request for looks at a volume.
    pub(crate) fn new(generation: u64, dataset: &Dataset, looks: ComparedLooks, size: [u32; 2]) -> Self {
        let volume = dataset.id();
        let looks = looks.with_common_range(&volume.ranges);
        let keys_of = |settings: &Settings| {
            let request =
                RenderRequest { volume, settings: settings.clone(), size, preview_resolution: None };
            let rays = settings.rays_per_pixel();
            FrameKeys::new(&request, &PictureOptions { rays, ..PictureOptions::default() }.into())
        };
        let (left_keys, right_keys) = (keys_of(&looks.left), looks.right.as_ref().map(keys_of));
        Self { generation, looks, size, left_keys, right_keys }
    }

    /// Returns the quality of the picture at rest.
    pub(crate) fn final_quality(&self) -> QualityLevel {
        let is_antialiased = |keys: &FrameKeys| keys.antialiased.is_some();
        if is_antialiased(&self.left_keys) || self.right_keys.as_ref().is_some_and(is_antialiased) {
            QualityLevel::ANTIALIASED
        } else {
            QualityLevel::FULL
        }
    }

    /// Returns the keys of the products for the picture, or the left one of a comparison, at full quality.
    pub(crate) fn keys(&self) -> &FrameKeys {
        &self.left_keys
    }
}

/// Volume and renderer of the render thread.
#[derive(Debug)]
pub(crate) struct RenderScene {
    /// Renderer, whose device is separate from the window's.
    pub renderer: Renderer,
    /// Dataset of the volume.
    pub dataset: Dataset,
    /// File of the volume, of which finer levels are read where pictures show them.
    pub file: Option<VolumeFile>,
}

/// File of a volume, by which other resolution levels of it are read.
#[derive(Debug, Clone)]
pub(crate) struct VolumeFile {
    pub path: PathBuf,
    /// Options with which the volume was read.
    pub options: LoadOptions,
    /// Content ID of the volume as it was opened.
    pub opened_id: u64,
}

impl VolumeFile {
    /// Returns true if a dataset is the volume of the file, and not another one, such as another time step.
    pub(crate) fn has_volume_of(&self, dataset: &Dataset) -> bool {
        dataset.volume().opened_id() == self.opened_id
    }

    /// Returns a reader of the levels that are finer than a dataset, whose blocks take at most `cache_bytes`; `None` if they
    /// cannot be shown, or the dataset is another one.
    pub(crate) fn pages(&self, dataset: &Dataset, cache_bytes: u64) -> Option<FilePages> {
        if !self.has_volume_of(dataset) {
            return None;
        }
        let pages = FilePages::new(&self.path, &self.options, dataset, cache_bytes);
        pages
            .inspect_err(|why| log::info!("finer levels of {} are not shown: {why}", self.path.display()))
            .ok()
    }
}

impl RenderScene {
    /// Returns the renderer's request for a look at a quality level.
    pub(super) fn request(
        &self,
        settings: &Settings,
        size: [u32; 2],
        quality: QualityLevel,
    ) -> RenderRequest {
        RenderRequest {
            volume: self.dataset.id(),
            settings: quality.settings(settings, &self.dataset.volume().scene(), size),
            size: quality.size(size),
            preview_resolution: quality.light_resolution,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::DensityRange;
    use chiaroscuro_volume::synthetic::builtin;

    #[test]
    fn looks_that_are_compared_share_an_upload() {
        let dataset = Dataset::new(builtin("sphere", Some(8)).expect("a volume"));
        let all = dataset.volume().value_range();
        let typed =
            |low: f64, high: f64| DensityRange::Typed(ValueRange::new(all.value_at(low), all.value_at(high)));
        let look = |range| {
            let mut look = Settings::default().with_range(range);
            look.layer_mut().transfer.points.clear();
            look
        };
        let [left, right] = [look(typed(0.0, 0.5)), look(typed(0.25, 1.0))];
        let alone = FrameRequest::new(1, &dataset, ComparedLooks { left: left.clone(), right: None }, [8; 2]);
        assert_eq!(alone.looks.left, left);
        let both = FrameRequest::new(1, &dataset, ComparedLooks { left, right: Some(right) }, [8; 2]);
        let right_keys = both.right_keys.as_ref().expect("two looks");
        assert_eq!(both.left_keys.volume, right_keys.volume);
        assert_eq!(
            both.left_keys.volume.density_mapping,
            ValueRange::new(all.value_at(0.0), all.value_at(1.0)).into()
        );
    }
}
