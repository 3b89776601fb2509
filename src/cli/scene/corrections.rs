//! Corrections of a volume that are given on the command line.

use std::path::Path;

use crate::cli::CliError;
use chiaroscuro_scene::{Settings, set_value};
use chiaroscuro_volume::{Corrections, Volume};

/// Settings group that contains the corrections.
const CORRECTIONS_GROUP: &str = "volume";

/// Returns true if an assignment of the command line is a correction of the volume.
fn is_correction(assignment: &str) -> bool {
    let path = assignment.split('=').next().unwrap_or_default().trim();
    path.strip_prefix(CORRECTIONS_GROUP).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Applies the corrections among the assignments of the command line to earlier ones.
pub(super) fn with_assignments(before: Corrections, set: &[String]) -> Result<Corrections, CliError> {
    let mut settings = Settings { volume: before, ..Settings::default() };
    for assignment in set.iter().filter(|assignment| is_correction(assignment)) {
        // Malformed assignments are rejected later, when all of them are parsed.
        let Some((path, value)) = assignment.split_once('=') else { continue };
        settings = set_value(&settings, path.trim(), value.trim())
            .map_err(|err| CliError::Usage(format!("--set: {err} (command line, {assignment:?})")))?
            .settings;
        if let Some(expected) = rejected_value(path.trim(), value.trim(), &settings.volume) {
            return Err(CliError::Usage(format!(
                "--set: expected {expected}, found {:?} (command line, {assignment:?})",
                value.trim()
            )));
        }
    }
    Ok(settings.volume)
}

/// Returns the expected kind of value if the given one was not accepted. Sessions fall back to the file's own value
/// in that case; on the command line it is an error.
fn rejected_value(path: &str, value: &str, taken: &Corrections) -> Option<&'static str> {
    let is_another = |taken: f64| value.parse::<f64>().is_ok_and(|number| number != taken);
    match path {
        "volume.spacing" if taken.spacing.is_none() && value != "null" => {
            Some("three positive spacings within a factor of 10000 of each other, such as 0.5,0.5,2")
        }
        "volume.value_scale.slope" if is_another(taken.value_scale.slope) => Some("a factor other than 0"),
        "volume.value_scale.intercept" if is_another(taken.value_scale.intercept) => Some("a finite number"),
        _ => None,
    }
}

/// Applies corrections from the command line to an opened volume; other settings are rejected.
pub(crate) fn apply_command_line_corrections(
    source: &Path,
    volume: Volume,
    set: &[String],
) -> Result<Volume, CliError> {
    if let Some(other) = set.iter().find(|assignment| !is_correction(assignment) || !assignment.contains('='))
    {
        return Err(CliError::Usage(format!(
            "--set: expected a correction of the volume, such as volume.spacing=0.5,0.5,2, found {other:?} (command \
             line, --set)"
        )));
    }
    apply_corrections(source, volume, &with_assignments(Corrections::default(), set)?)
}

/// Applies corrections to an opened volume.
pub(crate) fn apply_corrections(source: &Path, volume: Volume, by: &Corrections) -> Result<Volume, CliError> {
    if by.is_none() {
        return Ok(volume);
    }
    let refused = |err: chiaroscuro_volume::VolumeError| CliError::InvalidCorrection {
        path: source.display().to_string(),
        by: by.in_words().join(", "),
        why: err.to_string(),
    };
    volume.corrected(by).map_err(refused)
}
