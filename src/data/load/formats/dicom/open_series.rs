//! Selection of one volume among the series of files, and reading it without unreadable slices.

use std::path::Path;

use super::super::input::stem;
use super::super::{LoadControl, LoadError, LoadOptions};
use super::groups::{Grouping, UnreadableFile, left_out};
use super::header::Header;
use super::layer::Slice;
use super::layers::Fault;
use super::series::Series;
use super::stack::{Stack, StackedVolume};
use super::voxels::{self, VolumeRequest};
use crate::data::attempt::{Attempt, Dimension};
use crate::data::{Volume, plain};

/// Maximum number of attempts to read a volume without its unreadable slices: all of them are found at the first
/// failure, so that more attempts are needed only if files change meanwhile.
const MOST_TRIES: usize = 3;

/// Files from which one volume is opened.
pub(super) struct OpenSeries<'a> {
    pub(super) attempt: Attempt<'a>,
    /// File or folder that the user named.
    pub(super) path: &'a Path,
    pub(super) headers: &'a [Header],
    /// Index of the header of the file that the user named; it selects the volume.
    pub(super) main: Option<usize>,
    pub(super) options: &'a LoadOptions,
    pub(super) control: &'a LoadControl,
}

impl OpenSeries<'_> {
    /// Reads the selected volume; `remarks` holds earlier remarks on the files.
    pub(super) fn load(&self, mut grouping: Grouping, mut remarks: Vec<String>) -> Result<Volume, LoadError> {
        let unreadable = std::mem::take(&mut grouping.unreadable);
        if grouping.groups.is_empty() {
            return Err(self.none_is_read(unreadable));
        }
        let mut series = Series::all(grouping, self.headers);
        let all: usize = series.iter().map(Series::pictures).sum();
        if let Some(main) = self.main {
            // The named file selects the volume, unless it was dropped for another at the same position.
            if series.iter().any(|series| series.volume_of(main).is_some()) {
                series.retain(|series| series.volume_of(main).is_some());
            }
        }
        let offers = series.iter().enumerate().map(|(number, series)| series.offer(number)).collect();
        let chosen = match self.main {
            Some(_) => 0,
            None => self.attempt.chosen(&self.options.choice, Dimension::Series, offers)?,
        };
        let series = series.swap_remove(chosen);
        // A single file may hold several slices of its own.
        if self.main.is_some() && self.headers.len() > 1 {
            remarks.extend(of_main(series.pictures(), all));
        }
        let of_series = series.first_file().map(|file| self.headers[file].found.series.as_str());
        remarks.extend(self.unreadable_remarks(&unreadable, of_series.unwrap_or_default()));
        remarks.extend(series.stack.remarks.iter().cloned());
        let mut choice = self.options.choice.clone();
        if let (Some(main), None) = (self.main, choice.frame)
            && let Some(volume) = series.volume_of(main)
        {
            choice = choice.with(Dimension::Frame, &volume.to_string());
        }
        let volume = self.attempt.chosen(&choice, Dimension::Frame, series.volume_offers())?;
        self.read(series, volume, remarks)
    }

    /// Reads a volume of a series, leaving out slices that cannot be read.
    fn read(&self, series: Series, volume: usize, mut remarks: Vec<String>) -> Result<Volume, LoadError> {
        let Series { shape, filling, has_masks, mut stack, .. } = series;
        let volume = stack.volumes.swap_remove(volume);
        let name = self.name(&volume.slices);
        let mut request = VolumeRequest { name, headers: self.headers, shape, filling, has_masks, volume };
        for _ in 0..MOST_TRIES {
            request.volume.placement.remarks.splice(0..0, remarks.iter().cloned());
            let (pictures, total, why) =
                match voxels::load(self.attempt, &request, self.options, self.control) {
                    Ok(volume) => return Ok(volume),
                    Err(Fault::Load(error)) => return Err(error),
                    Err(Fault::Unreadable { pictures, total, why }) => (pictures, total, why),
                };
            let is_main = |at: &usize| Some(request.volume.slices[*at].file) == self.main;
            if pictures.iter().any(is_main) {
                return Err(why);
            }
            if pictures.is_empty() || pictures.len() == total {
                return Err(counted(why, total, "slices"));
            }
            remarks.push(left_out(pictures.len(), total, "slices", &why));
            let slices = std::mem::take(&mut request.volume.slices);
            let left = slices.into_iter().enumerate().filter(|(at, _)| pictures.binary_search(at).is_err());
            let left: Vec<Slice> = left.map(|(_, slice)| slice).collect();
            let mut stack = Stack::new(left, filling, has_masks, &[]);
            let StackedVolume { slices, layers, placement, .. } = stack.volumes.swap_remove(0);
            request.volume = StackedVolume { slices, layers, placement, ..request.volume };
        }
        Err(self.attempt.bad_input("files", "they change while they are read", "open them again"))
    }

    /// Makes the error for a series without a single readable file.
    fn none_is_read(&self, mut unreadable: Vec<UnreadableFile>) -> LoadError {
        let count = unreadable.len();
        if unreadable.is_empty() {
            return self.attempt.bad_input("files", "they have no pictures", "copy or export them again");
        }
        counted(unreadable.swap_remove(0).why, count, "files")
    }

    /// Returns remarks for the user on unreadable files, of this series and of others.
    fn unreadable_remarks(&self, unreadable: &[UnreadableFile], series: &str) -> Vec<String> {
        let is_own = |file: usize| self.headers[file].found.series == series;
        let (own, others): (Vec<_>, Vec<_>) =
            unreadable.iter().partition(|unreadable| is_own(unreadable.file));
        let total = self.headers.iter().filter(|header| header.found.series == series).count();
        let own_remark = own.first().map(|first| left_out(own.len(), total, "slices", &first.why));
        let total = self.headers.len() - total;
        let others_remark =
            others.first().map(|first| left_out(others.len(), total, "files of other series", &first.why));
        own_remark.into_iter().chain(others_remark).collect()
    }

    /// Returns the description of the series for several slices, or else the name of the file or folder.
    fn name(&self, slices: &[Slice]) -> String {
        let first = slices.first().filter(|_| slices.len() > 1);
        let said = first.map(|slice| self.headers[slice.file].found.description());
        let said = said.filter(|description| !description.is_empty());
        said.map_or_else(|| stem(self.path), |description| plain(description, 120))
    }
}

/// Returns remarks for the user if one file was named: how many images of its series are shown.
fn of_main(count: usize, all: usize) -> Vec<String> {
    let shown =
        (count > 1).then(|| format!("the {count} slices of its series in the same folder are shown with it"));
    let left = (all > count)
        .then(|| format!("{} pictures of the series have another size or direction", all - count));
    shown.into_iter().chain(left).collect()
}

/// Adds to an error the number of items that it applies to.
fn counted(why: LoadError, count: usize, what: &str) -> LoadError {
    match why {
        LoadError::BadInput(mut explanation) if count > 1 => {
            explanation.why =
                format!("none of {count} {what} can be read; of the first: {}", explanation.why);
            LoadError::BadInput(explanation)
        }
        why => why,
    }
}
