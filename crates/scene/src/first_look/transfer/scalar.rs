//! Transfer functions for scalar data in which higher values mean more material: the object begins above the
//! background.

use super::super::domain::DataDomain;
use super::super::isosurfaces::IsosurfaceStatistics;
use super::super::palette::DomainPalette;
use super::super::threshold::{ObjectThreshold, object_threshold};
use super::box_filling::fills_box;
use super::{FirstTransfer, PaletteStop, opacity_ramp, sample_values, transfer_through_stops};
use crate::TransferFunction;
use chiaroscuro_volume::{Histogram, ValueMeaning, Volume};

/// Contour level of density maps in root mean squares of their deviations from the mean: crystallographers draw
/// between 1 and 2.
const CONTOUR_DEVIATIONS: f64 = 1.5;

/// Returns the edge of molecules in a density map that fills its box, as those of crystals do: their solvent is not
/// empty, and half of the voxels are above zero. `None` for other volumes, and for maps with a margin.
fn density_map_threshold(volume: &Volume) -> Option<ObjectThreshold> {
    if volume.metadata().meaning != ValueMeaning::PositiveDensity {
        return None;
    }
    let values = sample_values(volume, Some);
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
    let start = volume.density_of(mean + CONTOUR_DEVIATIONS * deviation);
    let is_within = (0.0..1.0).contains(&start) && deviation > 0.0;
    let slope = || IsosurfaceStatistics::measure(volume).slope(start).unwrap_or_default();
    (is_within && fills_box(volume, mean)).then(|| ObjectThreshold { start, slope: slope() })
}

/// Builds a function that shows the object and hides the background.
pub(crate) fn find_scalar(volume: &Volume, histogram: &Histogram) -> FirstTransfer {
    let edge = density_map_threshold(volume).unwrap_or_else(|| object_threshold(volume, histogram));
    let domain = DataDomain::detect(volume, edge.start);
    FirstTransfer::from_values(transfer_in_domain_colors(domain, volume, histogram, edge), domain)
}

/// Builds a function for an object that begins at a given edge, in the colours of its domain.
pub(crate) fn transfer_from_edge(
    volume: &Volume,
    histogram: &Histogram,
    edge: ObjectThreshold,
) -> TransferFunction {
    transfer_in_domain_colors(DataDomain::detect(volume, edge.start), volume, histogram, edge)
}

fn transfer_in_domain_colors(
    domain: DataDomain,
    volume: &Volume,
    histogram: &Histogram,
    edge: ObjectThreshold,
) -> TransferFunction {
    let stops = opacity_ramp(histogram, edge).map(|stop| PaletteStop {
        // There are no values beyond the range.
        value: volume.value_of(stop.value.min(1.0)),
        ..stop
    });
    transfer_through_stops(stops, DomainPalette::for_domain(domain))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::first_look::first_settings;
    use chiaroscuro_volume::{Samples, ValueMetadata};

    /// Returns chains of molecules, of which a share of the box is full.
    fn map(radius: f64, meaning: ValueMeaning) -> Volume {
        const N: usize = 32;
        let value = |at: usize| {
            let p = DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 15.5));
            let chains = (0.8 * p.x).sin() + (0.9 * p.y + 0.3 * p.x).sin() + (0.7 * p.z).cos();
            if p.length() < radius { 0.1 * chains as f32 } else { 0.0 }
        };
        let samples = Samples::F32((0..N * N * N).map(value).collect());
        let volume = Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap();
        let mut metadata = ValueMetadata::default();
        metadata.meaning = meaning;
        volume.with_metadata(metadata)
    }

    /// Returns the lowest visible value in root mean squares of the map, whose mean is about 0.
    fn start(volume: &Volume) -> f64 {
        let values = sample_values(volume, Some);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        let settings = first_settings(volume, &Histogram::from_volume(volume));
        (settings.layer().transfer.points[0].value - mean) / square.sqrt()
    }

    #[test]
    fn maps_of_crystals_begin_where_their_contours_are_drawn() {
        let crystal = start(&map(100.0, ValueMeaning::PositiveDensity));
        assert!((crystal - CONTOUR_DEVIATIONS).abs() < 0.02, "{crystal}");
        assert!(density_map_threshold(&map(100.0, ValueMeaning::Unknown)).is_none(), "no map of densities");
        assert!(
            density_map_threshold(&map(11.0, ValueMeaning::PositiveDensity)).is_none(),
            "it has a margin"
        );
    }
}
