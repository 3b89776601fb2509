//! `chiaroscuro info`.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::CliError;
use super::outputs::print_line;
use super::scene::LoadArgs;
use crate::data::load::LoadControl;
use crate::data::{ValueRange, open};

/// Percentiles that are listed.
const PERCENTILES: [u32; 7] = [1, 5, 25, 50, 75, 95, 99];

/// Arguments of `info`.
#[derive(Debug, Args)]
pub(super) struct InfoArgs {
    #[arg(help = "Volume: a file, or builtin:NAME[:N]")]
    file: PathBuf,
    /// As JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    load: LoadArgs,
}

/// Prints what is known about a volume.
pub(super) fn run(args: &InfoArgs) -> Result<(), CliError> {
    let volume = open(&args.file, &args.load.load_options()?, &LoadControl::new())?;
    let ValueRange { low, high } = volume.value_range();
    let shown = volume.shown_range();
    let percentile = |p: u32| volume.quantile(f64::from(p) / 100.0);
    let percentiles: serde_json::Map<_, _> =
        PERCENTILES.iter().map(|&p| (format!("p{p}"), json!(percentile(p)))).collect();
    let spacing = volume.spacing_mm();
    let voxels = volume.voxel_count() as u64;
    // Density 2 bytes, pyramid 2 and a seventh, one attenuation volume 2.
    let gpu_bytes = voxels * 44 / 7;
    let facts = json!({
        "name": volume.name(),
        "dims": volume.dims(),
        "type": volume.samples().voxel_type().name(),
        "spacing_mm": [spacing.x, spacing.y, spacing.z],
        "range": [low, high],
        "robust_range": [shown.low, shown.high],
        "non_finite_voxels": volume.non_finite_voxels(),
        "percentiles": percentiles,
        "cpu_bytes": voxels * volume.samples().voxel_type().bytes() as u64,
        "gpu_bytes_with_one_light": gpu_bytes,
    });
    if args.json {
        print_line(&format!("{facts:#}"))?;
        return Ok(());
    }
    let [nx, ny, nz] = volume.dims();
    print_line(volume.name())?;
    print_line(&format!("  voxels       {nx} × {ny} × {nz}, {}", volume.samples().voxel_type().name()))?;
    print_line(&format!("  spacing      {} × {} × {} mm", spacing.x, spacing.y, spacing.z))?;
    print_line(&format!("  values       {low} … {high}"))?;
    print_line(&format!("  robust       {} … {}", shown.low, shown.high))?;
    let listed: Vec<_> = PERCENTILES.iter().map(|&p| format!("{p} %: {:.4}", percentile(p))).collect();
    print_line(&format!("  percentiles  {}", listed.join(", ")))?;
    if volume.non_finite_voxels() > 0 {
        print_line(&format!("  not finite   {} voxels", volume.non_finite_voxels()))?;
    }
    print_line(&format!("  memory       {} MiB on the GPU with one light", gpu_bytes >> 20))?;
    Ok(())
}
