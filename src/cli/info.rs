//! Command `chiaroscuro info`: prints what is known about a volume, as text or JSON.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use super::CliError;
use super::output::print_line;
use super::scene::{LoadArgs, NO_TABLE, apply_command_line_corrections, open_for_overview};
use chiaroscuro_render::{bytes_with_one_light, downsampled_volume};
use chiaroscuro_scene::first_look;
use chiaroscuro_volume::{
    CountedLabel, DataKind, Dataset, SpacingUnit, ValueMetadata, ValueRange, Volume, VolumeAlternatives,
    VolumeOffer,
};

/// Percentiles of the values that are listed.
const PERCENTILES: [u32; 7] = [1, 5, 25, 50, 75, 95, 99];

/// Maximum number of volumes of a file that are listed in the text output; JSON has all of them.
const LISTED_ALTERNATIVES: usize = 8;

/// Maximum number of labels in the text output; JSON has all of them.
const LISTED_LABELS: usize = 20;

/// Arguments of `info`.
#[derive(Debug, Args)]
pub(super) struct InfoArgs {
    #[arg(help = "Volume: a file, or builtin:NAME[:N]")]
    file: PathBuf,
    /// Print a JSON object instead of lines of text
    #[arg(long)]
    json: bool,
    /// Correct a property of the volume by its path, for instance volume.spacing=0.5,0.5,2; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    load: LoadArgs,
}

/// Prints the properties of a volume.
pub(super) fn run(args: &InfoArgs) -> Result<(), CliError> {
    let volume = open_for_overview(&args.file, &args.load.load_options()?)?;
    let volume = apply_command_line_corrections(&args.file, volume, &args.set)?;
    let ValueRange { low, high } = volume.value_range();
    let shown = volume.shown_range();
    let percentile = |p: u32| volume.quantile(f64::from(p) / 100.0);
    let percentiles: serde_json::Map<_, _> =
        PERCENTILES.iter().map(|&p| (format!("p{p}"), json!(percentile(p)))).collect();
    let spacing = volume.spacing_mm();
    let voxels = volume.voxel_count() as u64;
    let gpu_bytes = bytes_with_one_light(volume.dims());
    let portion = volume.contents().portion;
    let facts = json!({
        "name": volume.name(),
        "format": volume.contents().format,
        "alternatives": volume.contents().alternatives.iter().map(alternatives_json).collect::<Vec<_>>(),
        "dims": volume.dims(),
        "file_dims": volume.contents().grid.unwrap_or_else(|| volume.file_dims()),
        "portion": portion,
        "type": volume.samples().voxel_type().name(),
        "spacing_mm": [spacing.x, spacing.y, spacing.z],
        "range": [low, high],
        "robust_range": [shown.low, shown.high],
        "has_unknown_scale": volume.has_unknown_scale(),
        "is_anatomical": volume.is_anatomical(),
        "world_from_index": volume.world_from_index().to_cols_array(),
        "corrections": volume.corrections(),
        "remarks": volume.remarks(),
        "non_finite_voxels": volume.non_finite_voxels(),
        "kind": kind_json(&volume.kind().kind),
        "kind_why": volume.kind().reason,
        "hints": hints_json(volume.metadata()),
        "labels": label_infos(&volume).iter().map(LabelInfo::json).collect::<Vec<_>>(),
        "percentiles": percentiles,
        "cpu_bytes": voxels * volume.samples().voxel_type().bytes() as u64,
        "gpu_bytes_with_one_light": gpu_bytes,
    });
    if args.json {
        let mut facts = facts;
        facts["looks"] = looks_json(&Dataset::new(volume))?;
        print_line(&format!("{facts:#}"))?;
        return Ok(());
    }
    let [nx, ny, nz] = volume.dims();
    print_line(volume.name())?;
    if let Some(format) = volume.contents().format {
        print_line(&format!("  format       {format}"))?;
    }
    print_line(&format!("  voxels       {nx} × {ny} × {nz}, {}", volume.samples().voxel_type().name()))?;
    if let Some([x, y, z]) = volume.contents().grid.filter(|_| !portion.is_whole()) {
        print_line(&format!("  read         {} {x} × {y} × {z}", portion.in_words()))?;
    }
    for line in volume.contents().alternatives.iter().filter_map(alternatives_line) {
        print_line(&line)?;
    }
    print_line(&spacing_line(&volume))?;
    print_line(&format!("  values       {low} … {high}"))?;
    print_line(&format!("  robust range {} … {}", shown.low, shown.high))?;
    let listed: Vec<_> = PERCENTILES.iter().map(|&p| format!("{p} %: {:.4}", percentile(p))).collect();
    print_line(&format!("  percentiles  {}", listed.join(", ")))?;
    print_line(&format!("  kind         {}: {}", volume.kind().kind.name().key(), volume.kind().reason))?;
    for line in hint_lines(volume.metadata()) {
        print_line(&line)?;
    }
    for correction in volume.corrections().in_words() {
        print_line(&format!("  corrected    {correction}"))?;
    }
    if volume.lacks_table() {
        print_line(&format!("  note         {NO_TABLE}"))?;
    }
    for remark in volume.remarks() {
        print_line(&format!("  note         {remark}"))?;
    }
    for line in label_lines(&volume) {
        print_line(&line)?;
    }
    if volume.non_finite_voxels() > 0 {
        print_line(&format!("  not finite   {} voxels", volume.non_finite_voxels()))?;
    }
    print_line(&format!("  memory       {} MiB on the GPU with one light", gpu_bytes >> 20))?;
    Ok(())
}

/// Formats the volumes of a file among which one was opened, for the text output.
fn alternatives_line(several: &VolumeAlternatives) -> Option<String> {
    let name = several.dimension.option().trim_start_matches('-');
    let opened = several.offers.get(several.selected)?;
    let mut listed: Vec<String> =
        several.offers.iter().take(LISTED_ALTERNATIVES).map(VolumeOffer::to_string).collect();
    if several.offers.len() > LISTED_ALTERNATIVES {
        listed.push(format!("and {} more", several.offers.len() - LISTED_ALTERNATIVES));
    }
    Some(format!("  {name:<12} {opened} of: {}", listed.join(", ")))
}

/// Returns the volumes of a file among which one was opened, for machine-readable output.
fn alternatives_json(several: &VolumeAlternatives) -> Value {
    let offer = |offer: &VolumeOffer| json!({"key": offer.key, "name": offer.name, "dims": offer.dims});
    json!({
        "option": several.dimension.option(),
        "selected": several.selected,
        "offers": several.offers.iter().map(offer).collect::<Vec<_>>(),
    })
}

/// Formats the voxel spacing in a suitable unit, for the text output.
fn spacing_line(volume: &Volume) -> String {
    let spacing: [f64; 3] = volume.spacing_mm().into();
    let (unit, symbol) = if volume.has_unknown_scale() {
        (SpacingUnit::Voxels, "(unit unknown)")
    } else {
        let unit = SpacingUnit::suiting_spacing(spacing);
        (unit, unit.symbol())
    };
    let [x, y, z] = spacing.map(|length| length_in_unit(length, unit));
    format!("  spacing      {x} × {y} × {z} {symbol}")
}

/// Converts a length to another unit without adding digits: conversion errors are rounded off.
fn length_in_unit(length_mm: f64, unit: SpacingUnit) -> f64 {
    if unit.mm() == 1.0 {
        return length_mm;
    }
    let length = length_mm / unit.mm();
    // Numbers of 64 bits are accurate to 15 digits.
    format!("{length:.14e}").parse().unwrap_or(length)
}

/// Returns the kind of data as JSON.
fn kind_json(kind: &DataKind) -> Value {
    let name = kind.name().key();
    match kind {
        DataKind::LabelMap { count } => json!({ "name": name, "labels": count }),
        DataKind::HounsfieldCt { water } => json!({ "name": name, "water": water }),
        DataKind::Mask | DataKind::Signed | DataKind::DarkOnBright | DataKind::Scalar => {
            json!({ "name": name })
        }
    }
}

/// Returns the file's metadata about the values as JSON.
fn hints_json(hints: &ValueMetadata) -> Value {
    let labels: Vec<Value> = hints
        .labels
        .iter()
        .map(|(number, label)| json!({ "number": number, "name": label.name, "color": label.color }))
        .collect();
    json!({
        "modality": hints.modality.key(),
        "meaning": hints.meaning.key(),
        "unit": hints.unit(),
        "is_rescaled": hints.is_rescaled,
        "padding": hints.padding,
        "window": hints.window,
        "acquisition": hints.acquisition(),
        "labels": labels,
    })
}

/// Formats the file's metadata about the values, for the text output.
fn hint_lines(hints: &ValueMetadata) -> Vec<String> {
    let mut lines = Vec::new();
    let mut add = |name: &str, text: Option<&str>| {
        if let Some(text) = text {
            lines.push(format!("  {name:<12} {text}"));
        }
    };
    add("modality", hints.modality.key());
    add("meaning", hints.meaning.key());
    add("unit", hints.unit());
    add("rescaled", hints.is_rescaled.then_some("yes"));
    add("padding", hints.padding.map(|value| value.to_string()).as_deref());
    add("window", hints.window.map(|[low, high]| format!("{low} … {high}")).as_deref());
    add("acquisition", hints.acquisition());
    lines
}

/// Properties of one label of a label map.
struct LabelInfo {
    number: i64,
    /// Name of the label in the file; empty if there is none.
    name: String,
    voxels: u64,
}

impl LabelInfo {
    fn json(&self) -> Value {
        json!({ "number": self.number, "name": self.name, "voxels": self.voxels })
    }

    fn line(&self) -> String {
        let name = if self.name.is_empty() { "" } else { &format!(": {}", self.name) };
        format!("  label        {}{name}, {} voxels", self.number, self.voxels)
    }
}

/// Returns the labels of a label map; empty for other data.
fn label_infos(volume: &Volume) -> Vec<LabelInfo> {
    let is_label_map = matches!(volume.kind().kind, DataKind::LabelMap { .. });
    let counted = volume.labels().filter(|_| is_label_map).map_or(&[][..], |labels| labels.labels());
    let facts = |label: &CountedLabel| LabelInfo {
        number: label.number,
        name: volume.metadata().labels.get(label.number).map_or_else(String::new, |known| known.name.clone()),
        voxels: label.voxels,
    };
    counted.iter().map(facts).collect()
}

/// Formats the labels of a label map, for the text output.
fn label_lines(volume: &Volume) -> Vec<String> {
    let all = label_infos(volume);
    let more = all.len().saturating_sub(LISTED_LABELS);
    let rest = (more > 0).then(|| format!("  label        and {more} more"));
    all.iter().take(LISTED_LABELS).map(LabelInfo::line).chain(rest).collect()
}

/// Returns the suggested looks as JSON; `--look` selects one by number.
fn looks_json(loaded: &Dataset) -> Result<Value, CliError> {
    let first = first_look::first_settings(loaded.volume(), loaded.histogram());
    let small = downsampled_volume(loaded)?;
    let looks = first_look::propose_looks(&first, small.volume(), small.histogram()).into_iter().enumerate();
    let listed =
        looks.map(|(at, look)| json!({"number": at + 1, "name": look.name, "differs": look.description}));
    Ok(listed.collect())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use chiaroscuro_volume::Samples;

    #[test]
    fn lengths_are_said_in_units_that_suit_them() {
        let line = |spacing: [f64; 3]| {
            let samples = Samples::U8(vec![1, 2, 3, 4, 5, 6, 7, 8]);
            spacing_line(&Volume::with_spacing("t", [2, 2, 2], DVec3::from(spacing), samples).unwrap())
        };
        assert_eq!(line([0.661468, 0.661468, 5.0]), "  spacing      0.661468 × 0.661468 × 5 mm");
        assert_eq!(line([0.0003, 0.0003, 0.0011]), "  spacing      0.3 × 0.3 × 1.1 µm");
        assert_eq!(line([3.25e-6; 3]), "  spacing      3.25 × 3.25 × 3.25 nm");
    }
}
