//! Single settings given on the command line.

use super::LookArgs;
use super::option_values::{EngineArg, ShadowArg};
use crate::cli::CliError;
use chiaroscuro_scene::{QualityPreset, RenderEngine, Settings, ShadowAlgorithm, set_value};

impl LookArgs {
    /// Applies the single settings of the command line.
    pub(super) fn apply_single_settings(
        &self,
        mut settings: Settings,
        warn: impl Fn(&str),
    ) -> Result<Settings, CliError> {
        if let Some(level) = self.quality {
            QualityPreset::from(level).apply(&mut settings);
        }
        for assignment in &self.set {
            let (path, value) = assignment.split_once('=').ok_or_else(|| {
                CliError::Usage(format!(
                    "--set: expected PATH=VALUE, found {assignment:?} (command line, --set)"
                ))
            })?;
            let applied = set_value(&settings, path.trim(), value.trim())
                .map_err(|err| CliError::Usage(format!("--set: {err} (command line, {assignment:?})")))?;
            for warning in applied.warnings {
                warn(&format!("warning: --set: {warning}"));
            }
            settings = applied.settings;
        }
        match self.shadows {
            Some(ShadowArg::Off) => settings.shadows.algorithm = ShadowAlgorithm::Off,
            Some(ShadowArg::Splat) => settings.shadows.algorithm = ShadowAlgorithm::Splat,
            Some(ShadowArg::Raycast) => settings.shadows.algorithm = ShadowAlgorithm::Raycast,
            Some(ShadowArg::Direct) => settings.shadows.algorithm = ShadowAlgorithm::Direct,
            None => {}
        }
        match self.engine {
            Some(EngineArg::Gather) => settings.sampling.engine = RenderEngine::Gather,
            Some(EngineArg::Scatter) => settings.sampling.engine = RenderEngine::Scatter,
            None => {}
        }
        Ok(settings)
    }
}
