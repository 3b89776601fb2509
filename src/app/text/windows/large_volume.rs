//! Texts of the dialog that asks how much of a large volume to load.

use crate::app::text::data::{dimensions, ordinal};
use chiaroscuro_volume::{VolumeSize, human_bytes};

pub(crate) const TITLE: &str = "Large volume: how much to open?";

/// Name, dimensions, voxel type and size of the volume.
pub(crate) fn volume_size(source: &str, size: &VolumeSize) -> String {
    let bytes = human_bytes(size.bytes().into());
    format!("{source} holds {} voxels of {}, {bytes}", dimensions(size.dims), size.voxel_type.name())
}

/// Host memory that the whole volume would take, and the free memory.
pub(crate) fn host_memory(needed: u64, free: u64) -> String {
    format!(
        "Memory: the whole volume takes {}, {} are free",
        human_bytes(needed.into()),
        human_bytes(free.into())
    )
}

/// GPU memory that the whole volume would take, and the dimensions that fit, if fewer.
pub(crate) fn gpu_memory(needed: u64, held: Option<[usize; 3]>) -> String {
    let needed = human_bytes(needed.into());
    match held {
        Some(held) => {
            format!("Graphics adapter: the whole volume takes {needed}, {} voxels fit", dimensions(held))
        }
        None => format!("Graphics adapter: the whole volume takes {needed}, which fits"),
    }
}

/// Dimensions and memory of a part, with a caveat if there is one.
pub(crate) fn part_size(dims: [usize; 3], bytes: u64, but: Option<&str>) -> String {
    let taken = format!("{} voxels, {}", dimensions(dims), human_bytes(bytes.into()));
    but.map_or(taken.clone(), |but| format!("{taken}: {but}"))
}

/// Caveats of a part: exceeds the memory, takes most of it, or exceeds the graphics adapter.
pub(crate) const TOO_MUCH: &str = "too much";
pub(crate) const MOST_OF_MEMORY: &str = "most of the free memory";
pub(crate) const DOWNSAMPLED_BY_ADAPTER: &str = "the graphics adapter shows averages";

pub(crate) fn average(block: usize) -> String {
    format!("Average {block} × {block} × {block}")
}

pub(crate) fn subsample(step: usize) -> String {
    format!("Every {} voxel", ordinal(step))
}

pub(crate) const AVERAGE_TIP: &str = "Each voxel is the mean of a block; for labels, the most frequent one";
pub(crate) const EVERY_TIP: &str =
    "The voxels in between are skipped along each axis: values stay as in the file";
pub(crate) const REGION: &str = "Region";
pub(crate) const REGION_TIP: &str =
    "A box with all of its voxels, from the first up to but without the end, counted from 0";
pub(crate) const WHOLE: &str = "Whole volume anyway";
pub(crate) const WHOLE_TIP: &str = "Other programs may become slow, or be ended for lack of memory";
pub(crate) const OPEN: &str = "Open this much";
pub(crate) const CANCEL: &str = "Do not open";

pub(crate) fn first_along(axis: &str) -> String {
    format!("First voxel along {axis}")
}

pub(crate) fn end_along(axis: &str) -> String {
    format!("End along {axis}")
}
