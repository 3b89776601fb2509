//! Selection of one volume among the series of files, and reading it without unreadable slices.

use std::path::Path;

use super::super::input::stem;
use super::super::{LoadControl, LoadError, LoadOptions};
use super::header::DicomHeader;
use super::image_groups::{ImageGroups, UnreadableFile, omission_remark};
use super::layer_reader::VolumeReadError;
use super::series::DicomSeries;
use super::slice_layer::DicomSlice;
use super::stack::{SliceStack, StackedVolume};
use super::volume_reader::{self, VolumeRequest};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{FileDimension, LoadContext, Volume};

/// Maximum number of attempts to read a volume without its unreadable slices: all of them are found at the first
/// failure, so that more attempts are needed only if files change meanwhile.
const MAX_ATTEMPTS: usize = 3;

/// Files from which one volume is opened.
pub(super) struct SeriesSelection<'a> {
    pub(super) context: LoadContext<'a>,
    /// File or folder that the user named.
    pub(super) path: &'a Path,
    pub(super) headers: &'a [DicomHeader],
    /// Index of the header of the file that the user named; it selects the volume.
    pub(super) named_file: Option<usize>,
    pub(super) options: &'a LoadOptions,
    pub(super) control: &'a LoadControl,
}

impl SeriesSelection<'_> {
    /// Reads the selected volume; `remarks` holds earlier remarks on the files.
    pub(super) fn load(
        &self,
        mut grouping: ImageGroups,
        mut remarks: Vec<String>,
    ) -> Result<Volume, LoadError> {
        let unreadable = std::mem::take(&mut grouping.unreadable);
        if grouping.groups.is_empty() {
            return Err(self.no_readable_file_error(unreadable));
        }
        let mut series = DicomSeries::from_groups(grouping, self.headers);
        let all: usize = series.iter().map(DicomSeries::image_count).sum();
        if let Some(main) = self.named_file {
            // The named file selects the volume, unless it was dropped for another at the same position.
            if series.iter().any(|series| series.volume_with_file(main).is_some()) {
                series.retain(|series| series.volume_with_file(main).is_some());
            }
        }
        let offers = series.iter().enumerate().map(|(number, series)| series.offer(number)).collect();
        let chosen = match self.named_file {
            Some(_) => 0,
            None => self.context.resolve_choice(&self.options.choice, FileDimension::Series, offers)?,
        };
        let series = series.swap_remove(chosen);
        // A single file may hold several slices of its own.
        if self.named_file.is_some() && self.headers.len() > 1 {
            remarks.extend(named_file_remarks(series.image_count(), all));
        }
        let of_series = series.first_file().map(|file| self.headers[file].values.series_uid.as_str());
        remarks.extend(self.unreadable_remarks(&unreadable, of_series.unwrap_or_default()));
        remarks.extend(series.stack.remarks.iter().cloned());
        let mut choice = self.options.choice.clone();
        if let (Some(main), None) = (self.named_file, choice.frame)
            && let Some(volume) = series.volume_with_file(main)
        {
            choice = choice.with_selected(FileDimension::Frame, &volume.to_string());
        }
        let volume = self.context.resolve_choice(&choice, FileDimension::Frame, series.volume_offers())?;
        self.read(series, volume, remarks)
    }

    /// Reads a volume of a series, leaving out slices that cannot be read.
    fn read(
        &self,
        series: DicomSeries,
        volume: usize,
        mut remarks: Vec<String>,
    ) -> Result<Volume, LoadError> {
        let DicomSeries { layout: shape, gap_fill: filling, has_masks, mut stack, .. } = series;
        let volume = stack.volumes.swap_remove(volume);
        let name = self.name(&volume.slices);
        let mut request = VolumeRequest { name, headers: self.headers, shape, filling, has_masks, volume };
        for _ in 0..MAX_ATTEMPTS {
            request.volume.placement.remarks.splice(0..0, remarks.iter().cloned());
            let (pictures, total, why) =
                match volume_reader::load_volume(self.context, &request, self.options, self.control) {
                    Ok(volume) => return Ok(volume),
                    Err(VolumeReadError::Load(error)) => return Err(error),
                    Err(VolumeReadError::Unreadable { pictures, total, why }) => (pictures, total, why),
                };
            let is_named_file = |at: &usize| Some(request.volume.slices[*at].file) == self.named_file;
            if pictures.iter().any(is_named_file) {
                return Err(why);
            }
            if pictures.is_empty() || pictures.len() == total {
                return Err(with_count(why, total, "slices"));
            }
            remarks.push(omission_remark(pictures.len(), total, "slices", &why));
            let slices = std::mem::take(&mut request.volume.slices);
            let remaining =
                slices.into_iter().enumerate().filter(|(at, _)| pictures.binary_search(at).is_err());
            let left: Vec<DicomSlice> = remaining.map(|(_, slice)| slice).collect();
            let mut stack = SliceStack::new(left, filling, has_masks, &[]);
            let StackedVolume { slices, layers, placement, .. } = stack.volumes.swap_remove(0);
            request.volume = StackedVolume { slices, layers, placement, ..request.volume };
        }
        Err(self.context.bad_input_error("files", "its files change while they are read", "open them again"))
    }

    /// Makes the error for a series without a single readable file.
    fn no_readable_file_error(&self, mut unreadable: Vec<UnreadableFile>) -> LoadError {
        let count = unreadable.len();
        if unreadable.is_empty() {
            return self.context.bad_input_error(
                "files",
                "its files have no images",
                "copy or export them again",
            );
        }
        with_count(unreadable.swap_remove(0).error, count, "files")
    }

    /// Returns remarks for the user on unreadable files, of this series and of others.
    fn unreadable_remarks(&self, unreadable: &[UnreadableFile], series: &str) -> Vec<String> {
        let is_own = |file: usize| self.headers[file].values.series_uid == series;
        let (own, others): (Vec<_>, Vec<_>) =
            unreadable.iter().partition(|unreadable| is_own(unreadable.file));
        let total = self.headers.iter().filter(|header| header.values.series_uid == series).count();
        let own_remark = own.first().map(|first| omission_remark(own.len(), total, "slices", &first.error));
        let total = self.headers.len() - total;
        let others_remark = others
            .first()
            .map(|first| omission_remark(others.len(), total, "files of other series", &first.error));
        own_remark.into_iter().chain(others_remark).collect()
    }

    /// Returns the description of the series for several slices, or else the name of the file or folder.
    fn name(&self, slices: &[DicomSlice]) -> String {
        let first = slices.first().filter(|_| slices.len() > 1);
        let said = first.map(|slice| self.headers[slice.file].values.description());
        let said = said.filter(|description| !description.is_empty());
        said.map_or_else(|| stem(self.path), |description| sanitised(description, 120))
    }
}

/// Returns remarks for the user if one file was named: how many images of its series are shown.
fn named_file_remarks(count: usize, all: usize) -> Vec<String> {
    let shown =
        (count > 1).then(|| format!("the {count} slices of its series in the same folder are shown with it"));
    let left = (all > count).then(|| {
        format!("{} images of the series are not shown: their size or direction differs", all - count)
    });
    shown.into_iter().chain(left).collect()
}

/// Adds to an error the number of items that it applies to.
fn with_count(why: LoadError, count: usize, what: &str) -> LoadError {
    match why {
        LoadError::BadInput(mut explanation) if count > 1 => {
            explanation.why =
                format!("none of {count} {what} can be read; error of the first: {}", explanation.why);
            LoadError::BadInput(explanation)
        }
        why => why,
    }
}
