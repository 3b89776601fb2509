//! Detection of a volume's domain (CT, MR, microscopy, simulation …) from its file's hints and its values, to choose
//! colours.

use std::ops::Range;

use rayon::prelude::*;

use super::histogram_above;
use chiaroscuro_volume::{DataKind, FileDimension, Histogram, Modality, ValueMeaning, Volume};

/// Domain of a volume, which decides its palette.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DataDomain {
    /// Unknown origin of the data.
    Unknown,
    /// Soft tissue in CT.
    SoftTissue,
    /// Bone in CT, and material as dense.
    Bone,
    /// Tissue in magnetic resonance imaging.
    MagneticResonance,
    /// Vessels in magnetic resonance angiography.
    Vessels,
    /// Machines and other objects in industrial CT.
    Metal,
    /// Fluorescence and other light microscopy.
    Fluorescence,
    /// Molecular densities and electron microscopy.
    Molecule,
    /// Simulations, and fields as smooth.
    Simulation,
}

impl DataDomain {
    #[cfg(test)]
    pub(super) const ALL: [Self; 9] = [
        Self::Unknown,
        Self::SoftTissue,
        Self::Bone,
        Self::MagneticResonance,
        Self::Vessels,
        Self::Metal,
        Self::Fluorescence,
        Self::Molecule,
        Self::Simulation,
    ];

    /// Returns the domain of a volume that is one of several channels of a file: that of the file, because a single
    /// channel's values do not determine it. `None` if the file has no channels.
    pub(super) fn from_channels(volume: &Volume) -> Option<Self> {
        volume.contents().alternatives_in(FileDimension::Channel)?;
        let is_finer_than_light =
            !volume.has_unknown_scale() && volume.spacing_mm().max_element() < NANOMETRE_MM;
        Some(match Self::from_hints(volume) {
            Some(domain) => domain,
            None if volume.is_anatomical() => Self::MagneticResonance,
            None if is_finer_than_light => Self::Molecule,
            None => Self::Fluorescence,
        })
    }

    /// Returns the domain of a volume whose object begins at a density.
    pub(super) fn detect(volume: &Volume, start: f64) -> Self {
        let domain = Self::detect_whole(volume, start);
        if domain == Self::MagneticResonance && share_above(volume, start) < MAX_VESSEL_SHARE {
            return Self::Vessels;
        }
        domain
    }

    /// Returns the domain regardless of how much the object fills.
    fn detect_whole(volume: &Volume, start: f64) -> Self {
        if let Some(said) = Self::from_channels(volume).or_else(|| Self::from_hints(volume)) {
            return said;
        }
        if is_hounsfield(volume) {
            Self::SoftTissue
        } else if volume.is_anatomical() {
            // Most patient scans without Hounsfield units are MR.
            Self::MagneticResonance
        } else if is_computed(volume, start) {
            Self::Simulation
        } else {
            Self::Unknown
        }
    }

    /// Returns the domain according to the file's hints.
    fn from_hints(volume: &Volume) -> Option<Self> {
        let hints = volume.metadata();
        if hints.meaning == ValueMeaning::PositiveDensity {
            return Some(Self::Molecule);
        }
        match hints.modality {
            Modality::Mr => Some(Self::MagneticResonance),
            Modality::ElectronMicroscopy => Some(Self::Molecule),
            Modality::LightMicroscopy => Some(Self::Fluorescence),
            Modality::Pet | Modality::Nuclear => Some(Self::Simulation),
            Modality::Ct if !volume.is_anatomical() && !is_hounsfield(volume) => Some(Self::Metal),
            Modality::Ct | Modality::XRay | Modality::Ultrasound => Some(Self::SoftTissue),
            Modality::OpticalCoherence | Modality::Segmentation | Modality::Unknown => None,
        }
    }
}

/// One nanometre in millimetres: no light microscope has voxels as small.
const NANOMETRE_MM: f64 = 1e-6;

/// Largest share of the voxels that vessels fill: those of an angiography of the head have 0.3 to 1.5 %, and heads and
/// brains more than a tenth.
const MAX_VESSEL_SHARE: f64 = 0.03;

/// Returns the share of a volume's voxels above a density.
fn share_above(volume: &Volume, density: f64) -> f64 {
    let histogram = Histogram::from_volume(volume);
    histogram_above(&histogram, density).total as f64 / histogram.total.max(1) as f64
}

fn is_hounsfield(volume: &Volume) -> bool {
    matches!(volume.kind().kind, DataKind::HounsfieldCt { .. })
}

/// Texture statistics of a volume over a range of densities.
#[derive(Debug, Clone, Copy)]
struct TextureStatistics {
    /// Ratio of second to first differences between a voxel and its neighbours on both sides: √3 in white noise,
    /// about 1 at boundaries, nearly 0 in smooth fields.
    roughness: f64,
    /// Share of voxels whose slope is less than a fifth of the mean: the interior of homogeneous objects.
    flat_share: f64,
}

/// Largest roughness and flatness of a computed field, both in the object and in the densities below it. Of 27
/// volumes that are neither labels nor signed, four simulations and a cloud have 0.38 and 0.10 at most. Scans are
/// rougher, flatter inside, or (with thin, blurred objects) flatter around them.
const MAX_ROUGHNESS: f64 = 0.45;
const MAX_FLATNESS: f64 = 0.12;

/// Returns true if a volume varies smoothly everywhere, as simulations do.
fn is_computed(volume: &Volume, start: f64) -> bool {
    let is_smooth = |densities| {
        let texture = TextureStatistics::measure(volume, densities);
        texture.roughness < MAX_ROUGHNESS && texture.flat_share < MAX_FLATNESS
    };
    is_smooth(start..f64::INFINITY) && is_smooth(start / 4.0..start)
}

/// Returns the roughness of the whole volume: √3 in white noise, nearly 0 in smooth fields.
pub(super) fn roughness(volume: &Volume) -> f64 {
    TextureStatistics::measure(volume, f64::NEG_INFINITY..f64::INFINITY).roughness
}

/// Number of voxels to sample: larger volumes are subsampled along each axis.
const SAMPLED_VOXELS: f64 = (1u64 << 20) as f64;

impl TextureStatistics {
    /// Measures the voxels in a range of densities, at places whose neighbours are not missing.
    fn measure(volume: &Volume, densities: Range<f64>) -> Self {
        let [nx, ny, nz] = volume.dims();
        let step = (volume.voxel_count() as f64 / SAMPLED_VOXELS).cbrt().ceil().max(1.0) as usize;
        let inner = |n: usize| (1..n.saturating_sub(1)).step_by(step);
        let found: Vec<[f64; 2]> = inner(nz)
            .collect::<Vec<_>>()
            .into_par_iter()
            .flat_map_iter(|z| inner(ny).flat_map(move |y| inner(nx).map(move |x| [x, y, z])))
            .filter_map(|place| {
                let here = volume.density_at(place).filter(|here| densities.contains(here))?;
                let mut found = [0.0; 2];
                for axis in 0..3 {
                    let [mut before, mut after] = [place; 2];
                    (before[axis], after[axis]) = (place[axis] - 1, place[axis] + 1);
                    let (before, after) = (volume.density_at(before)?, volume.density_at(after)?);
                    found[0] += (before - 2.0 * here + after).abs();
                    found[1] += (after - before).abs();
                }
                Some(found)
            })
            .collect();
        let [second_differences, first_differences] =
            [0, 1].map(|part| found.iter().map(|one| one[part]).sum::<f64>());
        if first_differences == 0.0 {
            return Self { roughness: 1.0, flat_share: 1.0 };
        }
        let count = found.len() as f64;
        let flat = found.iter().filter(|one| one[1] < 0.2 * first_differences / count).count();
        Self { roughness: second_differences / first_differences, flat_share: flat as f64 / count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TransferFunction;
    use crate::first_look::palette::DomainPalette;
    use crate::first_look::transfer_for_kind;
    use chiaroscuro_volume::{Histogram, KindName, LoadControl, VolumeChoice};
    use chiaroscuro_volume_io::{LoadOptions, load};

    const N: usize = 24;

    /// Three channels of one object: a smooth hill, a ball with a grain, and a dark ball on a bright background.
    fn value(channel: usize, voxel: usize) -> u8 {
        let away = [voxel % N, voxel / N % N, voxel / N / N].map(|place| place as f64 - 11.5);
        let radius = away.iter().map(|c| c * c).sum::<f64>().sqrt();
        let grain = (voxel * 7919 % 40) as u8;
        let in_ball = radius < 7.0;
        match channel {
            0 => (200.0 * (-radius * radius / 40.0).exp()) as u8,
            1 => {
                if in_ball {
                    180 + grain
                } else {
                    grain / 4
                }
            }
            _ => {
                if in_ball {
                    10 + grain / 4
                } else {
                    190 + grain
                }
            }
        }
    }

    /// Returns a channel of a file with three channels, or of one that holds it alone.
    fn channel(at: usize, is_alone: bool) -> Volume {
        let channels = if is_alone { at..at + 1 } else { 0..3 };
        // Two time steps, so that the channels are an axis of their own.
        let shape = if is_alone { format!("({N}, {N}, {N})") } else { format!("(2, 3, {N}, {N}, {N})") };
        let header = format!("{{'descr': '|u1', 'fortran_order': False, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
        bytes.extend(header.as_bytes());
        for _ in 0..if is_alone { 1 } else { 2 } {
            bytes
                .extend(channels.clone().flat_map(|channel| (0..N.pow(3)).map(move |at| value(channel, at))));
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("channels.npy");
        std::fs::write(&path, bytes).unwrap();
        let several = VolumeChoice { channel: Some(at), frame: Some(0), ..VolumeChoice::default() };
        let choice = if is_alone { VolumeChoice::default() } else { several };
        load(&path, &LoadOptions { choice, ..LoadOptions::default() }, &LoadControl::new()).unwrap()
    }

    fn function(volume: &Volume) -> TransferFunction {
        // The detected kind of data of a channel is tested elsewhere.
        let kind = if volume.value(0, 0, 0) > 100.0 { KindName::DarkOnBright } else { KindName::Scalar };
        transfer_for_kind(volume, &Histogram::from_volume(volume), Some(kind))
    }

    #[test]
    fn channels_of_a_file_have_the_colors_of_one_field() {
        // Darkest colour of a function, at the beginning of the object.
        let beginning = |at, is_alone| {
            let points = function(&channel(at, is_alone)).points;
            let lightness = |color: &[f32; 3]| color.iter().sum::<f32>();
            let colors = points.into_iter().map(|point| point.color);
            colors.min_by(|a, b| lightness(a).total_cmp(&lightness(b))).expect("points")
        };
        let alone = [0, 1, 2].map(|at| beginning(at, true));
        assert_ne!(alone[0], alone[1], "by their values they are of different fields");
        assert_eq!(
            [0, 1, 2].map(|at| beginning(at, false)),
            [DomainPalette::for_domain(DataDomain::Fluorescence).color_at(0.0); 3]
        );
        assert_eq!(DataDomain::from_channels(&channel(0, true)), None);
        assert_eq!(DataDomain::from_channels(&channel(0, false)), Some(DataDomain::Fluorescence));
    }
}
