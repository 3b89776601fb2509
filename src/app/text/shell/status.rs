//! The status bar.

use crate::data::load::human_bytes;
use crate::gpu::Stage;

pub(crate) const NO_VOLUME: &str = "No volume";
pub(crate) const FULL_QUALITY: &str = "Full quality";
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

/// What the renderer is doing.
fn name_of(stage: Stage) -> &'static str {
    match stage {
        Stage::Upload => "uploading the volume",
        Stage::Pyramid => "preparing the volume",
        Stage::LightMarch | Stage::LightBackproject | Stage::LightRaycast => "filling the light volume",
        Stage::Sky => "following the light of the sky",
        Stage::Bounces => "letting light bounce",
        Stage::Eye | Stage::Display => "drawing the picture",
    }
}

/// The share of the picture at full quality that is done, and what is done now.
pub(crate) fn refining(share: f32, stage: Stage) -> String {
    format!("Refining {:.0} %, {}", share * 100.0, name_of(stage))
}

/// Over the last step back or forward.
pub(crate) const WENT_TIP: &str = "Shows the list of all steps";

pub(crate) const EXPORTING_TIP: &str = "Shows the window of the export";

/// How many pictures, or parts of one, of an export are done.
pub(crate) fn exporting(done: u32, total: u32) -> String {
    if total > 1 { format!("Exporting, {done} of {total}") } else { "Exporting".to_owned() }
}

/// What the status bar says of the renderer.
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
    /// Whether the adapter is the CPU.
    pub is_software: bool,
}

/// How fast, with how much memory, and on what.
pub(crate) fn figures(figures: &Figures<'_>) -> String {
    let ms = |ms: Option<f64>| ms.map_or_else(|| "–".to_owned(), |ms| format!("{ms:.0} ms"));
    let software = if figures.is_software { " (software)" } else { "" };
    let splats = if figures.splats > 0 {
        format!("{:.1} million splats · ", figures.splats as f64 * 1e-6)
    } else {
        String::new()
    };
    format!(
        "{splats}Full {} · preview {} · light volumes {} cached, {} filled · {:.0} MiB · {}{software}",
        ms(figures.full_ms),
        ms(figures.preview_ms),
        figures.cached_light_volumes,
        figures.light_rebuilds,
        figures.gpu_mebibytes,
        figures.adapter,
    )
}
