//! What the command line knows better than the file of a volume.

use std::path::Path;

use crate::cli::CliError;
use crate::data::{Corrections, Volume};
use crate::model::{Settings, assign};

/// The group of settings that are corrections.
const GROUP: &str = "volume";

/// Whether a single setting of the command line corrects the volume.
fn is_correction(assignment: &str) -> bool {
    let path = assignment.split('=').next().unwrap_or_default().trim();
    path.strip_prefix(GROUP).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Corrections with those laid over them that are among single settings.
pub(super) fn laid_over(before: Corrections, set: &[String]) -> Result<Corrections, CliError> {
    let mut settings = Settings { volume: before, ..Settings::default() };
    for assignment in set.iter().filter(|assignment| is_correction(assignment)) {
        // What is no assignment is refused when all are read.
        let Some((path, value)) = assignment.split_once('=') else { continue };
        (settings, _) = assign(&settings, path.trim(), value.trim())
            .map_err(|err| CliError::Usage(format!("--set: {err} (command line, {assignment:?})")))?;
        if let Some(expected) = impossible(path.trim(), value.trim(), &settings.volume) {
            return Err(CliError::Usage(format!(
                "--set: expected {expected}, found {:?} (command line, {assignment:?})",
                value.trim()
            )));
        }
    }
    Ok(settings.volume)
}

/// What was expected in place of a value that cannot be: of those that a session brings the file's own are taken, and
/// whoever types one is told.
fn impossible(path: &str, value: &str, taken: &Corrections) -> Option<&'static str> {
    let is_another = |taken: f64| value.parse::<f64>().is_ok_and(|number| number != taken);
    match path {
        "volume.spacing" if taken.spacing.is_none() && value != "null" => {
            Some("three distances above 0 that are not too unlike, as 0.5,0.5,2")
        }
        "volume.value_scale.slope" if is_another(taken.value_scale.slope) => Some("a factor other than 0"),
        "volume.value_scale.intercept" if is_another(taken.value_scale.intercept) => Some("a finite number"),
        _ => None,
    }
}

/// A volume that was opened, with corrections from the command line alone: nothing else can be set.
pub(in crate::cli) fn corrected_by(
    source: &Path,
    volume: Volume,
    set: &[String],
) -> Result<Volume, CliError> {
    if let Some(other) = set.iter().find(|assignment| !is_correction(assignment) || !assignment.contains('='))
    {
        return Err(CliError::Usage(format!(
            "--set: expected a correction of the volume, as volume.spacing=0.5,0.5,2, found {other:?} (command \
             line, --set)"
        )));
    }
    corrected(source, volume, &laid_over(Corrections::default(), set)?)
}

/// A volume that was opened, corrected.
pub(in crate::cli) fn corrected(source: &Path, volume: Volume, by: &Corrections) -> Result<Volume, CliError> {
    if by.is_none() {
        return Ok(volume);
    }
    let refused = |err: crate::data::VolumeError| CliError::Uncorrectable {
        path: source.display().to_string(),
        by: by.in_words().join(", "),
        why: err.to_string(),
    };
    volume.corrected(by).map_err(refused)
}
