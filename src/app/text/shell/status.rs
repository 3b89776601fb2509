//! Texts of the status bar.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_render::RenderStage;
use chiaroscuro_volume::human_bytes;

pub(crate) const NO_VOLUME: &str = "No volume";
/// State of the picture: full quality, preview or failure.
pub(crate) const FULL_QUALITY: &str = "Sharp";
pub(crate) const PREVIEW: &str = "Preview";
pub(crate) const NOT_RENDERED: &str = "Not rendered";
pub(crate) const DEVICE_LOST: &str = "Graphics device lost";

/// Phase of opening a file, with the bytes read so far and in total.
pub(crate) fn opening_progress(phase: &str, bytes: Option<[u64; 2]>, source: &str) -> String {
    match bytes {
        Some([done, total]) => {
            let [done, total] = [done, total].map(|bytes| human_bytes(bytes.into()));
            format!("{phase} {done} of {total}: {source}")
        }
        None => format!("{phase}: {source}"),
    }
}

/// Name of the work of a render stage.
fn stage_name(stage: RenderStage) -> &'static str {
    match stage {
        RenderStage::Upload | RenderStage::Pyramid => "Preparing volume",
        RenderStage::LightMarch | RenderStage::LightBackproject | RenderStage::LightRaycast => {
            "Filling light"
        }
        RenderStage::Sky => "Filling sky light",
        RenderStage::ScatteredLight => "Scattering light",
        RenderStage::Eye | RenderStage::Display => "Refining",
    }
}

/// Current stage of a full-quality picture, with its overall progress from 0 to 1.
pub(crate) fn refinement_progress(share: f32, stage: RenderStage) -> String {
    format!("{} {:.0} %", stage_name(stage), share * 100.0)
}

/// Finest resolution level of the picture, with the number of its parts that have yet to be read.
pub(crate) fn finer_levels(finest: &str, missing: usize, is_substituted: bool) -> String {
    let level = format!("Level {finest}");
    let substituted = if is_substituted { ", a finer one does not fit" } else { "" };
    match missing {
        0 => format!("{level}{substituted}"),
        1 => format!("{level}{substituted}: 1 part missing"),
        _ => format!("{level}{substituted}: {missing} parts missing"),
    }
}

pub(crate) const FINER_LEVELS_TIP: &str = "The finest resolution level of the file is too large for the memory: what the picture shows of it is read part by part";

/// Reading of a finer level that has failed; the tooltip has the cause.
pub(crate) const FINER_LEVELS_FAILED: &str = "A finer level could not be read; a moved camera tries again";

/// Background tasks beside the rendering of pictures.
pub(crate) const CORRECTING: &str = "Correcting volume";
pub(crate) const PREPARING_LOOK: &str = "Preparing look";
pub(crate) const PLACING_LIGHTS: &str = "Placing lights";
pub(crate) const BALANCING: &str = "Balancing lights";

/// Tooltip of the most recent undo or redo.
pub(crate) const HISTORY_TIP: &str = "Shows the list of all steps";

pub(crate) const EXPORTING_TIP: &str = "Shows the window of the export";

/// Progress of an export, in pictures or parts of one.
pub(crate) fn export_progress(done: u32, total: u32) -> String {
    if total > 1 { format!("Exporting, {done} of {total}") } else { "Exporting".to_owned() }
}

/// Button that shows the render statistics.
pub(crate) const PERFORMANCE: ControlText =
    control_text("Performance", "Shows how long pictures take, their memory, and the graphics device");

/// Statistics of the renderer for display.
pub(crate) struct RenderStatisticsText<'a> {
    /// Duration of the last full-quality picture, in ms.
    pub full_ms: Option<f64>,
    /// Duration of the last preview, in ms.
    pub preview_ms: Option<f64>,
    /// Number of footprints splatted, or 0 when gathering.
    pub splats: u64,
    /// Number of light volumes in the cache.
    pub cached_light_volumes: usize,
    /// Number of times light volumes were filled.
    pub light_rebuilds: u64,
    /// Memory of GPU textures, in MiB.
    pub gpu_mebibytes: f64,
    /// Name of the graphics adapter.
    pub adapter: &'a str,
    /// Driver and graphics API of the adapter.
    pub driver: &'a str,
    /// True if the adapter is a software rasteriser.
    pub is_software: bool,
}

/// Rows of the statistics, each a name and a formatted value.
pub(crate) fn statistics(figures: &RenderStatisticsText<'_>) -> Vec<(&'static str, String)> {
    let ms = |ms: Option<f64>| ms.map_or_else(|| "–".to_owned(), |ms| format!("{ms:.0} ms"));
    let software = if figures.is_software { " (software)" } else { "" };
    let mut rows = vec![
        ("Full quality", ms(figures.full_ms)),
        ("Preview", ms(figures.preview_ms)),
        (
            "Light volumes",
            format!("{} cached, filled {} times", figures.cached_light_volumes, figures.light_rebuilds),
        ),
        ("Graphics memory", format!("{:.0} MiB", figures.gpu_mebibytes)),
        ("Graphics device", format!("{}{software}", figures.adapter)),
        ("Driver", figures.driver.to_owned()),
    ];
    if figures.splats > 0 {
        rows.insert(2, ("Footprints", format!("{:.1} million", figures.splats as f64 * 1e-6)));
    }
    rows
}
