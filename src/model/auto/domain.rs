//! What field a volume comes from, as far as it decides about colours: from what its file says, and from the values.

use std::ops::Range;

use rayon::prelude::*;

use crate::data::{DataKind, Meaning, Modality, Volume};

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Domain {
    /// Nothing is known.
    Unknown,
    /// Flesh, in CT.
    SoftTissue,
    /// Bone and what is as dense.
    Bone,
    /// Tissue in magnetic resonance.
    MagneticResonance,
    /// Machines and other things in industrial CT.
    Metal,
    /// Light microscopy.
    Fluorescence,
    /// Densities of molecules, and electron microscopy.
    Molecule,
    /// What was computed, or varies as smoothly.
    Simulation,
}

impl Domain {
    #[cfg(test)]
    pub(super) const ALL: [Self; 8] = [
        Self::Unknown,
        Self::SoftTissue,
        Self::Bone,
        Self::MagneticResonance,
        Self::Metal,
        Self::Fluorescence,
        Self::Molecule,
        Self::Simulation,
    ];

    /// The field of a volume whose object begins at a density.
    pub(super) fn of(volume: &Volume, start: f64) -> Self {
        let hints = volume.hints();
        if hints.meaning == Meaning::PositiveDensity {
            return Self::Molecule;
        }
        match hints.modality {
            Modality::Mr => return Self::MagneticResonance,
            Modality::ElectronMicroscopy => return Self::Molecule,
            Modality::LightMicroscopy => return Self::Fluorescence,
            Modality::Pet | Modality::Nuclear => return Self::Simulation,
            Modality::Ct if !volume.is_anatomical() && !is_hounsfield(volume) => return Self::Metal,
            Modality::Ct | Modality::XRay | Modality::Ultrasound => return Self::SoftTissue,
            Modality::OpticalCoherence | Modality::Segmentation | Modality::Unknown => {}
        }
        if is_hounsfield(volume) {
            Self::SoftTissue
        } else if volume.is_anatomical() {
            // Of scans of patients without Hounsfield units most are these.
            Self::MagneticResonance
        } else if is_computed(volume, start) {
            Self::Simulation
        } else {
            Self::Unknown
        }
    }
}

fn is_hounsfield(volume: &Volume) -> bool {
    matches!(volume.kind().kind, DataKind::HounsfieldCt { .. })
}

/// Where in an object a volume varies, and how.
#[derive(Debug, Clone, Copy)]
struct Texture {
    /// How a volume bends, against how it slopes, between a voxel and its neighbours on both sides: √3 in white noise,
    /// about 1 where things end, nearly nothing in smooth fields.
    roughness: f64,
    /// The share of the voxels where it slopes by less than a fifth of the mean: the inside of things of one material.
    flat_share: f64,
}

/// Roughness and flatness below which fields are computed ones, within the object and on the way to it. Of 27 volumes
/// that are neither labels nor signed, four simulations and a cloud have 0.38 and 0.10 at most. Scans are rougher, flatter
/// inside, or (where things are thin and blurred) flatter around them.
const MOST_ROUGH: f64 = 0.45;
const MOST_FLAT: f64 = 0.12;

/// Whether a volume varies smoothly everywhere.
fn is_computed(volume: &Volume, start: f64) -> bool {
    let is_smooth = |densities| {
        let texture = Texture::of(volume, densities);
        texture.roughness < MOST_ROUGH && texture.flat_share < MOST_FLAT
    };
    is_smooth(start..f64::INFINITY) && is_smooth(start / 4.0..start)
}

/// How rough a volume is everywhere: √3 in white noise, nearly nothing in smooth fields.
pub(super) fn roughness(volume: &Volume) -> f64 {
    Texture::of(volume, f64::NEG_INFINITY..f64::INFINITY).roughness
}

/// Voxels that are looked at: of larger volumes, one in so many along each axis.
const LOOKED_AT: f64 = (1u64 << 20) as f64;

impl Texture {
    /// Of the voxels with some densities, between neighbours that hold something.
    fn of(volume: &Volume, densities: Range<f64>) -> Self {
        let [nx, ny, nz] = volume.dims();
        let step = (volume.voxel_count() as f64 / LOOKED_AT).cbrt().ceil().max(1.0) as usize;
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
        let [bends, slopes] = [0, 1].map(|part| found.iter().map(|one| one[part]).sum::<f64>());
        if slopes == 0.0 {
            return Self { roughness: 1.0, flat_share: 1.0 };
        }
        let count = found.len() as f64;
        let flat = found.iter().filter(|one| one[1] < 0.2 * slopes / count).count();
        Self { roughness: bends / slopes, flat_share: flat as f64 / count }
    }
}
