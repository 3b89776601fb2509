//! Looks of further layers: what tells the fields of a picture apart.

use crate::{
    ControlPoint, DensityRange, LayerBlend, LayerVisibility, LightingTransfer, Settings, TransferFunction,
    VolumeLayer,
};
use chiaroscuro_volume::{
    DataKind, Dataset, DatasetField, DefaultComponent, FileDimension, Modality, ValueRange, Volume,
    VoxelComponents, VoxelType,
};

use super::DomainPalette;
use super::covering_layers::thin_covering_layers;
use super::empty_channel::is_only_noise;
use crate::first_look::ObjectOutline;
use crate::first_look::domain::DataDomain;
use crate::first_look::first_settings;

/// Colours of channels, in the order of microscopes: green, magenta, cyan and yellow, which stay apart for most people
/// with reduced colour vision, and whose mixtures are pale.
const CHANNELS: [DomainPalette; 4] = [
    DomainPalette(&[[0.82, 0.17, 148.0]]),
    DomainPalette(&[[0.68, 0.2, 340.0]]),
    DomainPalette(&[[0.82, 0.11, 205.0]]),
    DomainPalette(&[[0.9, 0.14, 100.0]]),
];

/// Colours of measurements over a scan: glowing iron, from dark red over orange to a yellowish white.
const HOT: DomainPalette =
    DomainPalette(&[[0.5, 0.16, 28.0], [0.66, 0.18, 42.0], [0.82, 0.15, 75.0], [0.96, 0.06, 100.0]]);

/// Share of the voxels below the value at which a measurement over a scan begins to be seen.
const SEEN_MEASUREMENT_SHARE: f64 = 0.97;

/// Smallest value of the brightest channel of a colour that is seen on black: a fifth of the light of white.
const DARKEST_CHANNEL: u8 = 124;

/// Smallest difference in one channel between colours that are told apart at a glance: a quarter of the range.
const LEAST_COLOR_DIFFERENCE: u8 = 64;

/// Relation of further volumes to the first one, which decides their colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FieldRelation {
    /// Red, green and blue of a volume of colours, whose luminance is the first one.
    Colors,
    /// Channels of a microscope, all of which have colours of channels.
    Channels,
    /// Measurements over a scan of a body, which glow.
    Measurements,
    /// Anything else: the first volume keeps its colours.
    Others,
}

/// Adds layers to a look, one for each field of a dataset for which it has none.
///
/// Labels tint the first field, channels have the colours of a microscope, and measurements over a scan glow. Layers
/// that would hide others are thinned, and the camera is moved so that all are in its frame.
pub fn add_layers(settings: &mut Settings, dataset: &Dataset) {
    if settings.layers.count() >= dataset.fields().len() {
        return;
    }
    let (relation, count) = (FieldRelation::detect(dataset), settings.layers.count());
    if relation == FieldRelation::Channels && count == 1 && dataset.fields().len() > 1 {
        color_channel(&mut settings.layer_mut().transfer, dataset, 0);
    }
    for (index, field) in dataset.fields().iter().enumerate().skip(count) {
        settings.layers.push(further_layer(dataset, index, field, relation));
    }
    thin_covering_layers(settings, dataset);
    if settings.layers.iter().skip(count).any(|layer| layer.blend == LayerBlend::Add) {
        ObjectOutline::from_dataset(settings, dataset).frame(&mut settings.camera);
    }
}

/// Returns the look of a further field of a dataset, as a layer over the first one; `None` if it has no such field.
pub fn layer_of_field(dataset: &Dataset, index: usize) -> Option<VolumeLayer> {
    let field = dataset.fields().get(index)?;
    Some(further_layer(dataset, index, field, FieldRelation::detect(dataset)))
}

fn further_layer(
    dataset: &Dataset,
    index: usize,
    field: &DatasetField,
    relation: FieldRelation,
) -> VolumeLayer {
    let volume = field.volume();
    let component = field.origin().and_then(|origin| origin.choice.component);
    if relation == FieldRelation::Colors
        && let Some(&blend) = component.and_then(|component| LayerBlend::CHANNELS.get(component))
    {
        let range = DensityRange::Typed(color_range(volume));
        return VolumeLayer { range, blend, ..VolumeLayer::default() };
    }
    let mut layer = first_settings(volume, field.histogram()).layer().clone();
    if matches!(volume.kind().kind, DataKind::LabelMap { .. } | DataKind::Mask) {
        if !dataset.volume().is_label_map() {
            layer.blend = LayerBlend::Tint;
        }
    } else if relation == FieldRelation::Measurements {
        show_measurement(&mut layer, field);
    } else {
        color_channel(&mut layer.transfer, dataset, index);
        // A curve spreads over whatever there is, and would show noise as a block.
        if relation == FieldRelation::Channels && is_only_noise(volume) {
            layer.visibility = LayerVisibility::Hidden;
        }
    }
    layer
}

/// Gives a curve the colour of a channel: that of the file where it tells all fields apart, else one of our own.
fn color_channel(transfer: &mut TransferFunction, dataset: &Dataset, index: usize) {
    let recorded = recorded_colors(dataset);
    if let Some(&[red, green, blue]) = recorded.as_ref().and_then(|colors| colors.get(index)) {
        let color = [red, green, blue].map(|channel| f32::from(channel) / 255.0);
        transfer.points.iter_mut().for_each(|point| point.color = color);
    } else {
        colorize(transfer, &CHANNELS[index % CHANNELS.len()]);
    }
}

/// Returns the colours that the files give their channels, if all fields have one that can be seen and told from the
/// others.
fn recorded_colors(dataset: &Dataset) -> Option<Vec<[u8; 3]>> {
    let color = |field: &DatasetField| {
        let contents = field.volume().contents();
        let channels = contents.alternatives_in(FileDimension::Channel)?;
        channels.offers.get(channels.selected)?.color
    };
    let colors: Vec<[u8; 3]> = dataset.fields().iter().map(color).collect::<Option<_>>()?;
    let is_seen = |color: &[u8; 3]| color.iter().any(|&channel| channel >= DARKEST_CHANNEL);
    let differs = |a: &[u8; 3], b: &[u8; 3]| {
        std::iter::zip(a, b).any(|(&a, &b)| a.abs_diff(b) >= LEAST_COLOR_DIFFERENCE)
    };
    let is_apart = (0..colors.len()).all(|at| colors[..at].iter().all(|other| differs(other, &colors[at])));
    (is_apart && colors.iter().all(is_seen)).then_some(colors)
}

impl FieldRelation {
    fn detect(dataset: &Dataset) -> Self {
        let first = dataset.volume();
        // Time steps shown together are seldom of time: a file of four dimensions has no other word for contrasts.
        let has_frames = first.contents().alternatives_in(FileDimension::Frame).is_some();
        let is_chosen = |field: &DatasetField| {
            field.origin().is_some_and(|origin| {
                origin.choice.channel.is_some() || (has_frames && origin.choice.frame.is_some())
            })
        };
        let is_microscopy = first.metadata().modality == Modality::LightMicroscopy
            || DataDomain::from_channels(first) == Some(DataDomain::Fluorescence);
        let is_color = |part: &VoxelComponents| {
            part.is_color && part.selected.is_none() && part.default_component == DefaultComponent::Luminance
        };
        if first.contents().components.as_ref().is_some_and(is_color) {
            Self::Colors
        } else if is_microscopy || dataset.fields().iter().any(is_chosen) {
            Self::Channels
        } else if first.is_anatomical() || matches!(first.kind().kind, DataKind::HounsfieldCt { .. }) {
            Self::Measurements
        } else {
            Self::Others
        }
    }
}

/// Returns the numbers for the absence and the full amount of a channel of colour.
fn color_range(volume: &Volume) -> ValueRange {
    let largest = match volume.samples().voxel_type() {
        VoxelType::U8 => f64::from(u8::MAX),
        VoxelType::U16 => f64::from(u16::MAX),
        _ => volume.ranges().all.high.max(1.0),
    };
    ValueRange::new(0.0, largest)
}

/// Gives a curve the colours of a palette, from its first point to its last; opacities stay.
fn colorize(transfer: &mut TransferFunction, palette: &DomainPalette) {
    let last = transfer.points.len().saturating_sub(1).max(1) as f64;
    for (at, point) in transfer.points.iter_mut().enumerate() {
        point.color = palette.color_at(at as f64 / last);
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
            ControlPoint::new(first + (last - first) * place, [1.0; 3], opacity)
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
        let color = channels.layers.get(1).unwrap().transfer.points.last().unwrap().color;
        assert!(color[0] > color[1] && color[2] > color[1], "magenta: {color:?}");
        assert!(channels.layers.iter().all(|layer| layer.blend == LayerBlend::Add));
    }
}
