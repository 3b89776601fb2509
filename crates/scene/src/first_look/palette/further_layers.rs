//! Looks of further layers: what tells the fields of a picture apart.

use crate::{LayerBlend, LightingTransfer, Settings, TransferFunction, VolumeLayer, srgb_from_lch};
use chiaroscuro_volume::{DataKind, Dataset, DatasetField, FieldOrigin};

use super::Lch;
use crate::first_look::first_settings;

/// Colours of channels, in the order of microscopes: green, magenta, cyan and yellow, which stay apart for most people
/// with reduced colour vision, and whose mixtures are pale.
const CHANNELS: [Lch; 4] =
    [[0.82, 0.17, 148.0], [0.68, 0.2, 340.0], [0.82, 0.11, 205.0], [0.9, 0.14, 100.0]];

/// Colours of measurements over a scan: glowing iron, from dark red over orange to a yellowish white.
const HOT: [Lch; 4] = [[0.5, 0.16, 28.0], [0.66, 0.18, 42.0], [0.82, 0.15, 75.0], [0.96, 0.06, 100.0]];

/// Share of the voxels below the value at which a measurement over a scan begins to be seen.
const SEEN_MEASUREMENT_SHARE: f64 = 0.97;

/// Adds layers to a look of the first field, one for each further field of a dataset: labels tint it, channels of the
/// same file have the colours of a microscope, and other volumes glow.
pub fn add_layers(settings: &mut Settings, dataset: &Dataset) {
    let further = &dataset.fields()[1..];
    let origins: Vec<_> = further.iter().filter_map(DatasetField::origin).collect();
    let has_labels_first = dataset.volume().is_label_map();
    let are_channels = are_channels(dataset, &origins);
    if are_channels && !has_labels_first {
        colorize(&mut settings.layer_mut().transfer, &[CHANNELS[0]]);
    }
    for (index, field) in (1..).zip(further) {
        let volume = field.volume();
        let mut layer = first_settings(volume, field.histogram()).layer().clone();
        match volume.kind().kind {
            DataKind::LabelMap { .. } | DataKind::Mask { .. } if !has_labels_first => {
                layer.blend = LayerBlend::Tint;
            }
            DataKind::LabelMap { .. } => {}
            _ if are_channels => colorize(&mut layer.transfer, &[CHANNELS[index % CHANNELS.len()]]),
            _ => show_measurement(&mut layer, field),
        }
        settings.layers.push(layer);
    }
}

/// Returns true if all fields are of one file, or are fields of the same kind and size of numbers.
fn are_channels(dataset: &Dataset, origins: &[&FieldOrigin]) -> bool {
    let one_file = origins.windows(2).all(|pair| pair[0].source == pair[1].source);
    let name = dataset.volume().contents();
    let has_channels = name.choice().channel.is_some() || origins.iter().any(|origin| origin.choice.channel.is_some());
    let kinds = || dataset.fields().iter().map(|field| std::mem::discriminant(&field.volume().kind().kind));
    let is_one_kind = kinds().zip(kinds().skip(1)).all(|(a, b)| a == b);
    (one_file && has_channels) || is_one_kind
}

/// Gives a curve the colours of a scale, from its first point to its last; opacities stay.
fn colorize(transfer: &mut TransferFunction, scale: &[Lch]) {
    let last = transfer.points.len().saturating_sub(1).max(1) as f64;
    for (at, point) in transfer.points.iter_mut().enumerate() {
        let place = at as f64 / last * (scale.len() - 1) as f64;
        let low = (place as usize).min(scale.len() - 1);
        let high = (low + 1).min(scale.len() - 1);
        let t = place - low as f64;
        point.color = srgb_from_lch(std::array::from_fn(|i| scale[low][i] + (scale[high][i] - scale[low][i]) * t));
    }
}

/// Shows the largest values of a measurement over a scan, in which they do not hide it and cast hardly any shadow.
fn show_measurement(layer: &mut VolumeLayer, field: &DatasetField) {
    let volume = field.volume();
    let (first, last) = (volume.quantile(SEEN_MEASUREMENT_SHARE), volume.ranges().robust.high);
    if last > first {
        let places = [0.0, 0.25, 0.6, 1.0];
        let opacities = [0.0, 0.08, 0.3, 0.6];
        let point = |(place, opacity): (f64, f64)| {
            crate::ControlPoint::new(first + (last - first) * place, [1.0; 3], opacity)
        };
        layer.transfer.points = places.into_iter().zip(opacities).map(point).collect();
    }
    colorize(&mut layer.transfer, &HOT);
    layer.lighting = LightingTransfer { scale: 0.25, ..LightingTransfer::default() };
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::{Samples, Volume};
    use glam::DVec3;

    const EDGE: usize = 24;

    fn volume(value: impl Fn(f64) -> f64) -> Volume {
        let values = (0..EDGE.pow(3)).map(|at| {
            let place = DVec3::new((at % EDGE) as f64, (at / EDGE % EDGE) as f64, (at / EDGE / EDGE) as f64);
            value(place.distance(DVec3::splat(12.0))) as i16
        });
        Volume::with_spacing("v", [EDGE; 3], DVec3::ONE, Samples::I16(values.collect())).unwrap()
    }

    fn look(first: Volume, further: &Volume) -> Settings {
        let dataset = Dataset::new(first).with_field(further, "b").unwrap();
        let mut settings = first_settings(dataset.volume(), dataset.histogram());
        add_layers(&mut settings, &dataset);
        assert_eq!(settings.layers.count(), 2);
        settings
    }

    #[test]
    fn labels_tint_a_scan_and_channels_have_colors_of_their_own() {
        let scan = || volume(|r| 1000.0 - 70.0 * r);
        let labels = volume(|r| if r < 4.0 { 2.0 } else { f64::from(u8::from(r < 9.0)) });
        let tinted = look(scan(), &labels);
        assert_eq!(tinted.layers.get(1).map(|layer| layer.blend), Some(LayerBlend::Tint));
        assert!(!tinted.layers.get(1).unwrap().labels.is_empty());
        let channels = look(scan(), &volume(|r| 800.0 - 90.0 * (r - 6.0).abs()));
        let hue = |index: usize| channels.layers.get(index).unwrap().transfer.points.last().unwrap().color;
        assert!(hue(0)[1] > hue(0)[0] && hue(1)[0] > hue(1)[1], "green and magenta: {:?} {:?}", hue(0), hue(1));
        assert!(channels.layers.iter().all(|layer| layer.blend == LayerBlend::Add));
    }
}
