//! Job of the loader's thread: opens a volume, and asks for what it cannot know.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{LoadOutcome, OpenedVolume, PHASES, ReadChoices, RememberedFileSettings};
use crate::app::persistence::{CorrectedFile, FileStamp};
use crate::app::text;
use crate::app::worker::jobs::JobControl;
use crate::app::worker::memory_estimate::PendingMemoryDecision;
use chiaroscuro_files::fault::{FaultThread, panic_if_injected};
use chiaroscuro_render::{
    GpuContext, GpuError, Renderer, ShaderLibrary, downsample_to_fit, first_look_upright,
};
use chiaroscuro_volume::{Dataset, FileDimension, LoadControl, LoadError, Volume, VolumeAlternatives};
use chiaroscuro_volume_io::{LoadOptions, RawLayout};

/// File name extensions of headerless volumes.
const RAW_EXTENSIONS: [&str; 8] = [".raw", ".raw.gz", ".bin", ".dat", ".vol", ".img", ".bytes", ".u8"];

/// Returns an outcome that asks for the voxel format, if the file is headerless and could be opened with it.
fn ask_for_raw_format(source: &Path, err: &LoadError) -> Option<LoadOutcome> {
    let LoadError::BadInput(explanation) = err else { return None };
    let name = source.to_string_lossy().to_lowercase();
    let guess = RawLayout::guess(source).ok()??;
    let is_bare = RAW_EXTENSIONS.iter().any(|ending| name.ends_with(ending));
    if is_bare && guess.file_bytes == 0 {
        let short = text::opening::empty_file(source);
        return Some(LoadOutcome::Failed { details: short.clone(), short });
    }
    is_bare.then(|| LoadOutcome::UnknownRawFormat {
        path: source.to_owned(),
        why: explanation.why.clone(),
        guess,
    })
}

/// Input of the loader's thread for one volume.
pub(super) struct LoadJob {
    pub(super) source: PathBuf,
    pub(super) reading: ReadChoices,
    pub(super) known: RememberedFileSettings,
    pub(super) options: LoadOptions,
    pub(super) context: GpuContext,
    pub(super) shaders: ShaderLibrary,
    pub(super) control: Arc<LoadControl>,
    /// Memory estimate that requires a decision of the user before the volume is read.
    pub(super) question: PendingMemoryDecision,
}

/// Opens a volume. Of several, it opens the first unless the user has chosen one, and adds a remark about that; of levels the
/// reader has chosen one, and says so.
fn open_first(source: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let options = LoadOptions { choice: options.choice.clone().with_first_as_fallback(), ..options.clone() };
    let volume = chiaroscuro_volume_io::open(source, &options, control)?;
    let is_unsaid = |several: &&VolumeAlternatives| {
        let is_silent = several.dimension != FileDimension::Level
            && options.choice.selected_key(several.dimension).is_none();
        several.unmatched_selection.is_some() || is_silent
    };
    let told = volume.contents().alternatives.iter().filter(is_unsaid).map(text::opening::first_of_several);
    let remarks = volume.remarks().iter().cloned().chain(told).collect();
    Ok(volume.with_remarks(remarks))
}

/// Applies the remembered corrections to a volume, if it is still the same.
fn apply_remembered_corrections(volume: Volume, known: Option<&CorrectedFile>, stamp: FileStamp) -> Volume {
    let by = known.and_then(|known| known.corrections_for(stamp, volume.opened_id()));
    match by.map(|by| volume.corrected(&by)) {
        Some(Ok(corrected)) => corrected,
        Some(Err(err)) => {
            log::warn!("the corrections of the last time could not be applied: {err}");
            volume
        }
        None => volume,
    }
}

/// Opens a volume, uploads it and finds its first look.
pub(super) fn open(opening: LoadJob, job: &JobControl) -> LoadOutcome {
    let LoadJob { source, reading, known, options, context, shaders, control, question } = opening;
    let begin_phase = |index: u32| job.set_progress(index, PHASES.len() as u32);
    panic_if_injected(FaultThread::Loader);
    let stamp = FileStamp::read(&source);
    let volume = match open_first(&source, &options, &control) {
        Ok(volume) => volume,
        Err(LoadError::Cancelled) => {
            let Some(weighed) = question.take() else { return LoadOutcome::Cancelled };
            return LoadOutcome::NeedsMemoryDecision { source, reading: Box::new(reading), weighed };
        }
        Err(err) => {
            if let Some(asked) = ask_for_raw_format(&source, &err) {
                return asked;
            }
            let short =
                err.explanation().map_or_else(|| err.to_string(), |why| format!("{}: {}", why.what, why.why));
            return LoadOutcome::Failed { short, details: err.to_string() };
        }
    };
    begin_phase(1);
    let not_shown = |err: &GpuError| LoadOutcome::Failed {
        short: text::opening::not_shown(&source),
        details: err.to_string(),
    };
    let dims = volume.dims();
    let fit = downsample_to_fit(&context, volume);
    if control.is_cancelled() {
        return LoadOutcome::Cancelled;
    }
    let volume = match fit {
        Ok(volume) => volume,
        Err(err) => return not_shown(&err),
    };
    let original_dims = (volume.dims() != dims).then_some(dims);
    // The resulting choice is stored, so that reloading reads the same volume.
    let reading = ReadChoices { choice: Some(volume.contents().choice()), ..reading };
    begin_phase(2);
    let dataset = Dataset::new(apply_remembered_corrections(volume, known.corrections.as_ref(), stamp));
    if control.is_cancelled() {
        return LoadOutcome::Cancelled;
    }
    begin_phase(3);
    let look = Renderer::with_shaders(&context, shaders).and_then(|mut renderer| {
        begin_phase(4);
        let settings = first_look_upright(&mut renderer, &dataset, known.up)?;
        Ok((renderer, settings))
    });
    if control.is_cancelled() {
        return LoadOutcome::Cancelled;
    }
    match look {
        Ok((renderer, settings)) => {
            let opened = OpenedVolume { source, reading, dataset, original_dims, renderer, settings, stamp };
            LoadOutcome::Opened(Box::new(opened))
        }
        Err(err) => not_shown(&err),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::VolumeChoice;

    #[test]
    fn the_user_hears_which_of_several_is_shown_unless_it_was_chosen() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("steps.nrrd");
        let header = "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 2 2 3\nencoding: raw\nkinds: domain domain domain time\n\n";
        std::fs::write(&file, format!("{header}{}", "abcd".repeat(6))).unwrap();
        let first = "The first of 3 time steps is shown";
        let cases = [(None, 0, first), (Some(2), 2, ""), (Some(7), 0, "7 is none of the 3 time steps")];
        for (frame, shown, words) in cases {
            let choice = VolumeChoice { frame, ..VolumeChoice::default() };
            let options = LoadOptions { choice, ..LoadOptions::default() };
            let volume = open_first(&file, &options, &LoadControl::new()).unwrap();
            let said = volume.remarks().join("; ");
            assert_eq!(volume.contents().choice().frame, Some(shown));
            assert!(said.contains(words) && said.contains("time steps") != words.is_empty(), "{said}");
        }
    }
}
