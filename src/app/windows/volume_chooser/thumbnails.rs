//! Thumbnails of the volumes of a file: the middle slice of each, made one after another on a background thread. If
//! the size of a volume is known, only that slice is read where the format allows it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};
use image::RgbImage;
use image::imageops::{self, FilterType};

use crate::app::windows::slices::plane::SlicePlane;
use crate::app::windows::slices::slice_image::{GreyWindow, color_table, render_slice};
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_volume::{LoadControl, Portion, Volume, VolumeChoice, VoxelRegion, VoxelSpan};
use chiaroscuro_volume_io::{LoadOptions, open};

/// Longer edge of a thumbnail, in pixels: twice the points, for high-density screens.
const THUMBNAIL_PIXELS: f64 = 96.0;

/// Largest number of cached thumbnails: 10 MB on the graphics adapter.
const MAX_THUMBNAILS: usize = 256;

/// Size in bytes of the largest volume that is read for a thumbnail: seconds from a slow disk, and little beside the
/// open volume.
const MAX_VOLUME_BYTES: u64 = 256 << 20;

/// Cached thumbnails, and the one in progress.
#[derive(Default)]
pub(super) struct VolumeThumbnails {
    /// File or folder that the thumbnails belong to.
    source: PathBuf,
    /// Open files of a folder, if the source is one.
    open_files: Option<Arc<[PathBuf]>>,
    /// Finished thumbnails, the latest last; `None` where it could not be made.
    finished: Vec<(VolumeChoice, Option<TextureHandle>)>,
    /// Thumbnail of a volume in progress.
    task: JobSlot<Option<ColorImage>, VolumeChoice>,
}

/// State of one volume's thumbnail.
#[derive(Clone, Copy)]
pub(super) enum ThumbnailState<'a> {
    /// Not made yet: other thumbnails come first.
    Pending,
    /// Could not be made, and is not retried.
    Failed,
    /// Finished, as a texture on the GPU.
    Ready(&'a TextureHandle),
}

impl VolumeThumbnails {
    /// Forgets the thumbnails if the file is another.
    pub(super) fn set_source(&mut self, source: &Path, among: Option<&Arc<[PathBuf]>>) {
        if self.source != source || self.open_files.as_ref() != among {
            *self = Self { source: source.to_owned(), open_files: among.cloned(), ..Self::default() };
        }
    }

    /// Stops making thumbnails; the finished ones stay.
    pub(super) fn stop(&mut self) {
        self.task.discard();
    }

    /// Returns the thumbnail of a volume, or its state.
    pub(super) fn get(&self, choice: &VolumeChoice) -> ThumbnailState<'_> {
        match self.finished.iter().find(|(known, _)| known == choice) {
            None => ThumbnailState::Pending,
            Some((_, None)) => ThumbnailState::Failed,
            Some((_, Some(picture))) => ThumbnailState::Ready(picture),
        }
    }

    fn is_known(&self, choice: &VolumeChoice) -> bool {
        !matches!(self.get(choice), ThumbnailState::Pending)
    }

    /// Collects the finished thumbnail, and starts that of the first listed volume that has none. Each volume is
    /// listed with its grid size, if that is known.
    pub(super) fn update(
        &mut self,
        wanted: &[(VolumeChoice, Option<[usize; 3]>)],
        options: &LoadOptions,
        ctx: &egui::Context,
    ) {
        if let Some((choice, made)) = self.task.take_ended() {
            let picture = made.ok().flatten();
            let texture = picture.map(|picture| ctx.load_texture("preview", picture, TextureOptions::LINEAR));
            if self.finished.len() == MAX_THUMBNAILS {
                self.finished.remove(0);
            }
            self.finished.push((choice, texture));
        }
        // A thumbnail that has scrolled out of view is cancelled.
        if self.task.inputs().is_some_and(|making| wanted.iter().all(|(choice, _)| choice != making)) {
            self.task.discard();
        }
        let Some((choice, grid)) = wanted.iter().find(|(choice, _)| !self.is_known(choice)) else { return };
        if self.task.is_running() {
            return;
        }
        let memory_budget_bytes = options.memory_budget_bytes.min(MAX_VOLUME_BYTES);
        let (choice_of, among) = (choice.clone(), self.open_files.clone());
        let options =
            LoadOptions { choice: choice_of, only_files: among, memory_budget_bytes, ..options.clone() };
        let source = self.source.clone();
        // A choice that is a portion already stays as it is.
        let slice = grid.filter(|_| options.choice.portion.is_none()).map(middle_slice_portion);
        let task = move |job: &JobControl| {
            let control = LoadControl::with_token(job.token().clone());
            let of_slice = slice.and_then(|portion| {
                let choice = VolumeChoice { portion: Some(portion), ..options.choice.clone() };
                open(&source, &LoadOptions { choice, ..options.clone() }, &control).ok()
            });
            let volume = of_slice.or_else(|| open(&source, &options, &control).ok())?;
            render_middle_slice(&volume)
        };
        // Without a thread there is no thumbnail.
        self.task.start(JobKind::VolumeThumbnail, ctx, choice.clone(), task).ok();
    }
}

/// Portion that contains only the middle slice of a grid.
fn middle_slice_portion([_, _, count]: [usize; 3]) -> Portion {
    let all = VoxelSpan { first: 0, end: None };
    let middle = VoxelSpan { first: count / 2, end: Some(count / 2 + 1) };
    Portion { region: Some(VoxelRegion([all, all, middle])), ..Portion::default() }
}

/// Renders the middle slice in greys, at thumbnail size and with its physical proportions.
fn render_middle_slice(volume: &Volume) -> Option<ColorImage> {
    let shown = volume.shown_range();
    let table = color_table(volume, GreyWindow { black: shown.low, white: shown.high }, None);
    let dims = volume.dims();
    let whole = render_slice(volume, &SlicePlane::across_axis(2), dims[2] / 2, &table);
    let bytes = whole.pixels.iter().flat_map(|color| [color.r(), color.g(), color.b()]).collect();
    let [width, height] = [dims[0], dims[1]].map(|n| u32::try_from(n).ok());
    let whole = RgbImage::from_raw(width?, height?, bytes)?;
    let spacing = volume.spacing_mm();
    let edges = [dims[0] as f64 * spacing.x, dims[1] as f64 * spacing.y];
    let longest = edges[0].max(edges[1]);
    let [width, height] = edges.map(|edge| (edge / longest * THUMBNAIL_PIXELS).round().max(1.0) as u32);
    let small = imageops::resize(&whole, width, height, FilterType::Triangle);
    Some(ColorImage::from_rgb([width as usize, height as usize], &small))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use chiaroscuro_volume::Samples;

    #[test]
    fn pictures_show_the_middle_in_its_proportions() {
        // Bright in the middle slice only; pixels twice as high as wide.
        let values = (0..3 * 4 * 4).map(|at| if at / 16 == 1 { 9 } else { 0 }).collect();
        let spacing = DVec3::new(1.0, 2.0, 1.0);
        let volume = Volume::with_spacing("t", [4, 4, 3], spacing, Samples::U8(values)).unwrap();
        let picture = render_middle_slice(&volume).unwrap();
        assert_eq!(picture.size, [48, 96]);
        assert!(picture.pixels.iter().all(|pixel| pixel.r() == 255), "{:?}", picture.pixels[0]);
    }

    #[test]
    fn what_is_read_for_a_picture_is_its_slice() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.npy");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (5, 2, 3), }\n";
        bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(0..30);
        std::fs::write(&file, bytes).unwrap();
        let choice =
            VolumeChoice { portion: Some(middle_slice_portion([3, 2, 5])), ..VolumeChoice::default() };
        let options = LoadOptions { choice, ..LoadOptions::default() };
        let volume = open(&file, &options, &LoadControl::new()).unwrap();
        assert_eq!(volume.dims(), [3, 2, 1]);
        assert_eq!((volume.value(0, 0, 0), volume.value(2, 1, 0)), (12.0, 17.0));
    }

    #[test]
    fn one_picture_is_made_at_a_time_and_none_after_the_window_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.npy");
        let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (3, 2, 2, 2), }\n";
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend((0..24).map(|at| at * 10));
        std::fs::write(&file, bytes).unwrap();
        let ctx = egui::Context::default();
        // The last time step does not exist, and the size of another one is wrong.
        let step = |step| VolumeChoice { frame: Some(step), ..VolumeChoice::default() };
        let steps = [0, 1, 2, 3].map(|at| (step(at), Some([2, 2, if at == 1 { 9 } else { 2 }])));
        let mut previews = VolumeThumbnails::default();
        previews.set_source(&file, None);
        let start = std::time::Instant::now();
        while !steps.iter().all(|(step, _)| previews.is_known(step)) {
            previews.update(&steps, &LoadOptions::default(), &ctx);
            assert!(previews.finished.len() <= 4 && start.elapsed().as_secs() < 60);
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        let get = |at: usize| previews.get(&steps[at].0);
        assert!(matches!(get(1), ThumbnailState::Ready(_)) && matches!(get(2), ThumbnailState::Ready(_)));
        assert!(matches!(get(3), ThumbnailState::Failed), "there is no such time step");
        previews.update(&[(VolumeChoice::default(), None)], &LoadOptions::default(), &ctx);
        let token = previews.task.token().unwrap().clone();
        previews.stop();
        assert!(token.is_cancelled() && previews.is_known(&steps[0].0), "what there is stays");
        previews.set_source(Path::new("other"), None);
        assert!(!previews.is_known(&steps[0].0));
    }
}
