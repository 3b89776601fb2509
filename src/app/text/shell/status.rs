//! The status bar.

use crate::app::text::{Named, named};
use crate::data::load::human_bytes;
use crate::gpu::Stage;

pub(crate) const NO_VOLUME: &str = "No volume";
/// The picture at full quality is on screen.
pub(crate) const SHARP: &str = "Sharp";
pub(crate) const PREVIEW: &str = "Preview";
pub(crate) const NOT_RENDERED: &str = "Not rendered";
pub(crate) const DEVICE_LOST: &str = "Graphics device lost";

/// What is done to a file that is being opened, and how many of its bytes have been read.
pub(crate) fn opening(phase: &str, bytes: Option<[u64; 2]>, source: &str) -> String {
    match bytes {
        Some([done, total]) => {
            let [done, total] = [done, total].map(|bytes| human_bytes(bytes.into()));
            format!("{phase} {done} of {total}: {source}")
        }
        None => format!("{phase}: {source}"),
    }
}

/// What is waited for.
fn name_of(stage: Stage) -> &'static str {
    match stage {
        Stage::Upload | Stage::Pyramid => "Preparing volume",
        Stage::LightMarch | Stage::LightBackproject | Stage::LightRaycast => "Filling light",
        Stage::Sky => "Filling sky light",
        Stage::Bounces => "Scattering light",
        Stage::Eye | Stage::Display => "Refining",
    }
}

/// What is done now for the picture at full quality, and the share of all that is done.
pub(crate) fn refining(share: f32, stage: Stage) -> String {
    format!("{} {:.0} %", name_of(stage), share * 100.0)
}

/// What is made beside pictures.
pub(crate) const CORRECTING: &str = "Correcting volume";
pub(crate) const MAKING_LOOK: &str = "Preparing look";
pub(crate) const PLACING_LIGHTS: &str = "Placing lights";
pub(crate) const BALANCING: &str = "Balancing lights";

/// Over the last step back or forward.
pub(crate) const WENT_TIP: &str = "Shows the list of all steps";

pub(crate) const EXPORTING_TIP: &str = "Shows the window of the export";

/// How many pictures, or parts of one, of an export are done.
pub(crate) fn exporting(done: u32, total: u32) -> String {
    if total > 1 { format!("Exporting, {done} of {total}") } else { "Exporting".to_owned() }
}

/// The button behind which the costs of pictures are.
pub(crate) const PERFORMANCE: Named =
    named("Performance", "Shows how long pictures take, their memory, and the graphics device");

/// What is known of the renderer's work.
pub(crate) struct Figures<'a> {
    /// Milliseconds of the last picture at full quality.
    pub full_ms: Option<f64>,
    /// Milliseconds of the last preview.
    pub preview_ms: Option<f64>,
    /// Footprints that were splatted.
    pub splats: u64,
    /// Light volumes that are kept.
    pub cached_light_volumes: usize,
    /// How often light volumes were filled.
    pub light_rebuilds: u64,
    /// Mebibytes of textures.
    pub gpu_mebibytes: f64,
    /// Name of the adapter.
    pub adapter: &'a str,
    /// Driver and interface of the adapter.
    pub driver: &'a str,
    /// Whether the adapter is the CPU.
    pub is_software: bool,
}

/// How fast, with how much memory, and on what: names and what is said of each.
pub(crate) fn figures(figures: &Figures<'_>) -> Vec<(&'static str, String)> {
    let ms = |ms: Option<f64>| ms.map_or_else(|| "–".to_owned(), |ms| format!("{ms:.0} ms"));
    let software = if figures.is_software { " (software)" } else { "" };
    let mut rows = vec![
        ("Full quality", ms(figures.full_ms)),
        ("Preview", ms(figures.preview_ms)),
        (
            "Light volumes",
            format!("{} kept, filled {} times", figures.cached_light_volumes, figures.light_rebuilds),
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
