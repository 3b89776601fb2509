//! Steps of a time series: those that one file holds, or files of a folder that are numbered.

use std::path::{Path, PathBuf};

use super::neighbour::files_of_folder;
use super::{LoadOptions, open};
use chiaroscuro_files::natural_sort_key;
use chiaroscuro_volume::{
    Dataset, FieldOrigin, FileContents, FileDimension, LoadContext, LoadControl, LoadError, StepError,
    ValueRanges, Volume, VolumeChoice, VolumeOffer,
};

/// Time steps of one object, at least two, in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimeSteps {
    source: StepSource,
    /// Choice in all other aspects, such as channel and resolution level.
    choice: VolumeChoice,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum StepSource {
    /// Steps of one file or folder.
    File { path: PathBuf, offers: Vec<VolumeOffer> },
    /// Files with one step each.
    Files(Vec<PathBuf>),
}

impl TimeSteps {
    /// Returns the time steps of a file that is open; `None` if it holds only one.
    pub fn from_contents(path: &Path, contents: &FileContents) -> Option<Self> {
        let offers = contents.alternatives_in(FileDimension::Frame)?.offers.clone();
        let source = StepSource::File { path: path.to_owned(), offers };
        Some(Self { source, choice: contents.choice() })
    }

    /// Returns the files of a folder whose names differ from that of `path` in one number alone, in the order of these
    /// numbers; `None` if there is no other. Of several such numbers, the last in the name counts. `choice` selects in each.
    pub fn from_numbered_files(path: &Path, choice: VolumeChoice) -> Option<Self> {
        let path = std::path::absolute(path).ok()?;
        let all = files_of_folder(path.parent()?);
        let mut files = NumberedName::all_of(&path).into_iter().find_map(|wanted| {
            let is_step = |file: &PathBuf| NumberedName::all_of(file).contains(&wanted);
            let files: Vec<PathBuf> = all.iter().filter(|file| is_step(file)).cloned().collect();
            (files.len() > 1).then_some(files)
        })?;
        files.sort_by_cached_key(|file| natural_sort_key(&file_name(file)));
        Some(Self { source: StepSource::Files(files), choice })
    }

    /// Returns the number of steps, at least two.
    pub fn count(&self) -> usize {
        match &self.source {
            StepSource::File { offers, .. } => offers.len(),
            StepSource::Files(files) => files.len(),
        }
    }

    /// Returns the index of the step that a volume shows, of its path and choice.
    pub fn index_of(&self, path: &Path, choice: &VolumeChoice) -> Option<usize> {
        match &self.source {
            StepSource::File { path: own, offers } => {
                let key = choice.selected_key(FileDimension::Frame).filter(|_| own == path)?;
                offers.iter().position(|offer| offer.key == key)
            }
            StepSource::Files(files) => {
                let path = std::path::absolute(path).ok()?;
                files.iter().position(|file| *file == path)
            }
        }
    }

    /// Returns the name of a step: that in the file, or the name of its file; empty if it has none.
    pub fn name(&self, index: usize) -> String {
        match &self.source {
            StepSource::File { offers, .. } => offers.get(index).map_or_else(String::new, |o| o.name.clone()),
            StepSource::Files(files) => files.get(index).map_or_else(String::new, |file| file_name(file)),
        }
    }

    /// Returns the file of a step; of a step that does not exist, that of the last.
    pub fn path(&self, index: usize) -> &Path {
        match &self.source {
            StepSource::File { path, .. } => path,
            StepSource::Files(files) => &files[index.min(files.len() - 1)],
        }
    }

    /// Returns the choice by which a step is opened.
    pub fn choice(&self, index: usize) -> VolumeChoice {
        match &self.source {
            StepSource::File { offers, .. } => match offers.get(index) {
                Some(offer) => self.choice.clone().with_selected(FileDimension::Frame, &offer.key),
                None => self.choice.clone(),
            },
            StepSource::Files(_) => self.choice.clone(),
        }
    }

    /// Opens the dataset of a step, with the look of the one that is shown: with its corrections, its ranges of values and
    /// its further fields, of which those that the same steps have are read as well ([`Dataset::with_step`]).
    ///
    /// # Errors
    /// Fails like [`open()`], and if the step cannot be shown in the place of the other.
    pub fn open_like(
        &self,
        index: usize,
        shown: &Dataset,
        by: &StepReadOptions<'_>,
    ) -> Result<Dataset, LoadError> {
        let mut volumes = Vec::new();
        for (field, choice) in self.fields_of(shown) {
            volumes.push((field, self.open_field(index, field, choice, by)?));
        }
        let (_, first) = volumes.remove(0);
        shown.with_step(&first, volumes).map_err(|err| self.not_shown(index, &err))
    }

    /// Returns a dataset, which shows the step `shown_index`, with the ranges of values that all steps have together: at most
    /// `most` of them are read, which are spread evenly and include the first and the last. `progress` is called with the
    /// number of steps that are done, and their total.
    ///
    /// # Errors
    /// Fails like [`Self::open_like`], and names the step.
    pub fn with_series_ranges(
        &self,
        (shown, shown_index): (&Dataset, usize),
        most: usize,
        by: &StepReadOptions<'_>,
        mut progress: impl FnMut(usize, usize),
    ) -> Result<Dataset, StepReadError> {
        let mut ranges: Vec<ValueRanges> =
            shown.fields().iter().map(|field| field.volume().ranges()).collect();
        let (last, count) = (self.count() - 1, self.count().min(most.max(2)));
        let fields = self.fields_of(shown);
        for done in 0..count {
            let index = done * last / (count - 1);
            let failure = |source: LoadError| StepReadError { index, source };
            for (field, choice) in fields.iter().filter(|_| index != shown_index) {
                let mut volume = self.open_field(index, *field, choice.clone(), by).map_err(failure)?;
                if *field == 0 {
                    let corrected = volume.corrected(shown.volume().corrections());
                    volume = corrected.map_err(|err| failure(self.not_shown(index, &err.into())))?;
                }
                ranges[*field] = ranges[*field].union(volume.ranges());
            }
            progress(done + 1, count);
        }
        let ranges = ranges.into_iter().enumerate();
        Ok(ranges.fold(shown.clone(), |dataset, (field, ranges)| dataset.with_ranges_of(field, ranges)))
    }

    /// Returns the fields of a dataset that the steps have, by their index, each with the choice that selects it. Fields of
    /// other files, and of another time, stay as they are.
    fn fields_of(&self, shown: &Dataset) -> Vec<(usize, VolumeChoice)> {
        let choice = shown.volume().contents().choice();
        let is_step = |origin: &&FieldOrigin| {
            origin.choice.frame == choice.frame
                && match &self.source {
                    StepSource::File { path, .. } => is_same_file(path, &origin.source),
                    StepSource::Files(files) => files.iter().any(|file| is_same_file(file, &origin.source)),
                }
        };
        let further = shown.fields().iter().enumerate().skip(1).filter_map(|(index, field)| {
            let origin = field.origin().filter(is_step)?;
            Some((index, origin.choice.clone()))
        });
        std::iter::once((0, self.choice.clone())).chain(further).collect()
    }

    /// Opens the volume of one field of a step. The first one is changed to fit on the adapter, and the others are placed on
    /// its grid.
    fn open_field(
        &self,
        index: usize,
        field: usize,
        choice: VolumeChoice,
        by: &StepReadOptions<'_>,
    ) -> Result<Volume, LoadError> {
        let choice = VolumeChoice { frame: self.choice(index).frame, ..choice };
        let whole = open(self.path(index), &LoadOptions { choice, ..by.load.clone() }, by.control)?;
        Ok(if field == 0 { (by.fit)(whole) } else { whole })
    }

    /// Error for a step that cannot be shown in the place of another.
    fn not_shown(&self, index: usize, err: &StepError) -> LoadError {
        let context = LoadContext { operation: "show the time step", path: self.path(index) };
        context.bad_input_error("time step", err.to_string(), "open it as a volume of its own")
    }
}

/// Options for reading time steps.
pub struct StepReadOptions<'a> {
    /// Options by which the volume that is shown was read.
    pub load: &'a LoadOptions,
    /// Control for progress and cancellation.
    pub control: &'a LoadControl,
    /// Function that changes a volume as the one that is shown was changed to fit on the graphics adapter.
    pub fit: &'a dyn Fn(Volume) -> Volume,
}

impl std::fmt::Debug for StepReadOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("StepReadOptions").field("load", self.load).finish_non_exhaustive()
    }
}

/// Reason why a time step of a series was not read.
#[derive(Debug, thiserror::Error)]
#[error("time step {index}: {source}")]
pub struct StepReadError {
    /// Index of the step, from 0.
    pub index: usize,
    /// Cause of the failure.
    pub source: LoadError,
}

/// Returns true if two paths lead to the same file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Name of a file around its last number.
#[derive(Debug, PartialEq, Eq)]
struct NumberedName {
    before: String,
    after: String,
}

impl NumberedName {
    /// Splits the name of a file at each of its numbers that are not part of the extension, the last one first.
    fn all_of(path: &Path) -> Vec<Self> {
        let name = file_name(path);
        // Extensions such as `.h5`, `.nii.gz` and `.v3draw` begin at the first dot after which there is a letter.
        let extension = name
            .match_indices('.')
            .find(|(at, _)| *at > 0 && name[at + 1..].starts_with(|c: char| c.is_ascii_alphabetic()));
        let mut end = extension.map_or(name.len(), |(at, _)| at);
        let mut names = Vec::new();
        while let Some(last) = name[..end].rfind(|c: char| c.is_ascii_digit()) {
            let begin = name[..=last].trim_end_matches(|c: char| c.is_ascii_digit()).len();
            names.push(Self { before: name[..begin].to_owned(), after: name[last + 1..].to_owned() });
            end = begin;
        }
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nrrd(values: &[u8]) -> Vec<u8> {
        let header =
            format!("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 {}\nencoding: raw\n\n", values.len());
        [header.as_bytes(), values].concat()
    }

    #[test]
    fn names_are_split_at_their_numbers() {
        let split = |name: &str| -> Vec<(String, String)> {
            NumberedName::all_of(Path::new(name)).into_iter().map(|name| (name.before, name.after)).collect()
        };
        let wanted = |before: &str, after: &str| (before.to_owned(), after.to_owned());
        assert_eq!(split("t001.nrrd"), [wanted("t", ".nrrd")]);
        assert_eq!(
            split("fish2_t12_raw.nii.gz"),
            [wanted("fish2_t", "_raw.nii.gz"), wanted("fish", "_t12_raw.nii.gz")]
        );
        assert_eq!(split("t1.v3draw"), [wanted("t", ".v3draw")]);
        assert_eq!(split("0.5ns_7.h5")[0], wanted("0.5ns_", ".h5"));
        assert_eq!(split("\u{e9}3"), [wanted("\u{e9}", "")]);
        assert_eq!(split("2024"), [wanted("", "")]);
        assert!(split("head.h5").is_empty());
    }

    #[test]
    fn the_number_that_differs_counts() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["t1_8x8x8_uint8.raw", "t2_8x8x8_uint8.raw", "t2_8x8x9_int16.raw"] {
            std::fs::write(folder.path().join(name), [0; 512]).unwrap();
        }
        let open = folder.path().join("t1_8x8x8_uint8.raw");
        let steps = TimeSteps::from_numbered_files(&open, VolumeChoice::default()).unwrap();
        assert_eq!((steps.count(), steps.name(1)), (2, "t2_8x8x8_uint8.raw".to_owned()));
    }

    #[test]
    fn numbered_files_are_steps_in_the_order_of_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        for (name, value) in
            [("t10.nrrd", 30), ("t2.nrrd", 20), ("t1.nrrd", 10), ("u1.nrrd", 99), ("t1.txt", 0)]
        {
            std::fs::write(folder.path().join(name), nrrd(&[value, value + 1])).unwrap();
        }
        let open = folder.path().join("t2.nrrd");
        let steps = TimeSteps::from_numbered_files(&open, VolumeChoice::default()).unwrap();
        assert_eq!(
            (0..steps.count()).map(|at| steps.name(at)).collect::<Vec<_>>(),
            ["t1.nrrd", "t2.nrrd", "t10.nrrd"]
        );
        assert_eq!(steps.index_of(&open, &VolumeChoice::default()), Some(1));
        let (load, control) = (LoadOptions::default(), LoadControl::new());
        let by = StepReadOptions { load: &load, control: &control, fit: &|volume| volume };
        let shown = Dataset::new(crate::open(&open, &load, &control).unwrap());
        let third = steps.open_like(2, &shown, &by).unwrap();
        assert_eq!(third.volume().samples().value(0), 30.0);
        let mut counts = Vec::new();
        let count = |done, of| counts.push((done, of));
        let all = steps.with_series_ranges((&shown, 1), 9, &by, count).unwrap().volume().ranges().all;
        assert_eq!((all.low, all.high), (10.0, 31.0));
        assert_eq!(counts, [(1, 3), (2, 3), (3, 3)]);
        std::fs::write(folder.path().join("t1.nrrd"), "torn").unwrap();
        let read = |most| steps.with_series_ranges((&shown, 1), most, &by, |_, _| ());
        assert_eq!(read(2).unwrap_err().index, 0);
        assert!(
            TimeSteps::from_numbered_files(&folder.path().join("u1.nrrd"), VolumeChoice::default()).is_none()
        );
    }

    #[test]
    fn steps_of_a_file_keep_its_other_choices() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("steps.nrrd");
        let header = "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 2 2 3\nencoding: raw\nkinds: domain domain domain time\n\n";
        let values: Vec<u8> = (0..24).collect();
        std::fs::write(&file, [header.as_bytes(), &values].concat()).unwrap();
        let choice = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
        let (options, control) = (LoadOptions { choice, ..LoadOptions::default() }, LoadControl::new());
        let volume = open(&file, &options, &control).unwrap();
        let steps = TimeSteps::from_contents(&file, volume.contents()).unwrap();
        assert_eq!((steps.count(), steps.index_of(&file, &volume.contents().choice())), (3, Some(1)));
        let single = LoadOptions { choice: steps.choice(0), ..options.clone() };
        let single = open(&file, &single, &control).unwrap();
        assert_eq!(single.value_range().high, 7.0);
        assert_eq!(TimeSteps::from_contents(&file, &FileContents::default()), None);
        let shown = Dataset::new(volume);
        let by = StepReadOptions { load: &options, control: &control, fit: &|volume| volume };
        let like = steps.open_like(2, &shown, &by).unwrap();
        assert_eq!(like.volume().ranges(), shown.volume().ranges());
        let choice = like.volume().contents().choice();
        assert_eq!((like.volume().samples().value(0), choice.frame), (16.0, Some(2)));
        assert_eq!(steps.index_of(&file, &choice), Some(2));
    }
}
