//! Tests of partial reading: a portion read from a file equals the same portion of the whole volume.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{LoadOptions, load};
use chiaroscuro_volume::{
    Downsampling, LoadControl, LoadError, MissingVoxels, Portion, ResolvedPortion, Volume, VolumeChoice,
    VoxelRegion, VoxelSpan,
};

/// Sample files of all formats, written by other programs, of about 5 × 4 × 3 voxels.
fn samples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracle/written");
    let mut found: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    found.sort();
    found
}

fn read(path: &Path, portion: Portion) -> Result<Volume, LoadError> {
    read_under(&LoadControl::new(), path, portion)
}

fn read_under(control: &LoadControl, path: &Path, portion: Portion) -> Result<Volume, LoadError> {
    let choice = VolumeChoice { portion: Some(portion), ..VolumeChoice::default().with_first_as_fallback() };
    // Enough for all samples.
    let options = LoadOptions { choice, memory_budget_bytes: 1 << 20, ..LoadOptions::default() };
    load(path, &options, control)
}

/// Region without the first voxel of every axis that has several.
fn inner(dims: [usize; 3]) -> VoxelRegion {
    VoxelRegion(dims.map(|n| VoxelSpan { first: usize::from(n > 1), end: (n > 3).then_some(n - 1) }))
}

fn values(volume: &Volume) -> Vec<u64> {
    (0..volume.voxel_count()).map(|voxel| volume.samples().value(voxel).to_bits()).collect()
}

#[track_caller]
fn assert_same(read: &Volume, left: &Volume, what: &str) {
    assert_eq!((read.dims(), read.file_dims()), (left.dims(), left.file_dims()), "{what}");
    assert!(read.world_from_index() == left.world_from_index(), "{what}: it lies elsewhere");
    assert!(values(read) == values(left), "{what}: it has other values");
    assert_eq!(read.padding_value(), left.padding_value(), "{what}");
    let missing = |volume: &Volume| volume.missing().map(MissingVoxels::count);
    assert_eq!(missing(read), missing(left), "{what}");
    let same = |volume: &Volume| {
        (
            volume.name().to_owned(),
            volume.metadata().clone(),
            volume.has_unknown_scale(),
            volume.is_anatomical(),
        )
    };
    assert_eq!(same(read), same(left), "{what}");
}

#[test]
fn partial_reads_match_portions_of_whole_volumes() {
    let mut formats = BTreeSet::new();
    for path in samples() {
        let Ok(whole) = read(&path, Portion::default()) else { continue };
        formats.insert(path.extension().unwrap_or_default().to_string_lossy().into_owned());
        let dims = whole.dims();
        let region = Some(inner(dims));
        for portion in [
            Portion::with_stride(2),
            Portion::with_stride(3),
            Portion { region, thinning: Downsampling::None },
            Portion { region, thinning: Downsampling::Every(2) },
            Portion::with_block_average(2),
            Portion::with_block_average(3),
            Portion { region, thinning: Downsampling::Average(2) },
        ] {
            let what = format!("{} {portion:?}", path.display());
            let wanted = ResolvedPortion::resolve(&portion, dims, false).unwrap();
            // The corner of a phantom may contain no finite voxel.
            let Ok(left) = whole.clone().extract_portion(&ResolvedPortion::whole_grid(dims), &wanted) else {
                assert!(read(&path, portion).is_err(), "{what}");
                continue;
            };
            let part = read(&path, portion).unwrap_or_else(|err| panic!("{what}: {err}"));
            assert_same(&part, &left, &what);
            let streamed = read_under(&LoadControl::with_scarce_memory(), &path, portion);
            let streamed = streamed.unwrap_or_else(|err| panic!("{what}: {err}"));
            assert_same(&streamed, &left, &format!("{what} while it was read"));
            assert_eq!((part.contents().portion, part.contents().grid), (portion, Some(dims)), "{what}");
            assert_eq!(part.contents().choice().portion, Some(portion), "{what}");
        }
    }
    // Every format with samples must be among those that were compared.
    for format in
        ["nrrd", "nhdr", "mha", "mhd", "nii", "gz", "raw", "mrc", "npy", "npz", "pvm", "cube", "vti", "vtk"]
    {
        assert!(formats.contains(format), "{format} is not in {formats:?}");
    }
    for format in ["dcm", "dicom-series", "tif", "slices", "dat"] {
        assert!(formats.contains(format), "{format} is not in {formats:?}");
    }
}

#[test]
fn labels_that_no_file_calls_labels_are_not_averaged() {
    // Three labels in columns of three voxels: the mean of 1 and 9 is none of them.
    let values: Vec<u8> = (0..12 * 12 * 40).map(|at| [1u8, 9, 4][at % 12 / 3 % 3]).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("labels_12x12x40_uint8.raw");
    fs::write(&path, values).unwrap();
    let control = LoadControl::with_scarce_memory();
    let averaged = read_under(&control, &path, Portion::with_block_average(2)).unwrap();
    let whole = read(&path, Portion::default()).unwrap();
    assert!(whole.is_label_map(), "{:?}", whole.kind());
    assert_same(&averaged, &whole.block_averaged([2; 3]).unwrap(), "most frequent labels");
    assert!(averaged.value_range() == (1.0, 9.0).into());
}

#[test]
fn a_file_larger_than_the_memory_is_read_in_part() {
    // 512 KiB of voxels within a budget of two fifths of that.
    let n = 64usize;
    let bytes: Vec<u8> = (0..n * n * n).flat_map(|at| ((at * 7919) as u16).to_le_bytes()).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("large_{n}x{n}x{n}_uint16.raw"));
    fs::write(&path, bytes).unwrap();
    let within = |portion: Portion, budget: u64| {
        let choice = VolumeChoice { portion: Some(portion), ..VolumeChoice::default() };
        let options = LoadOptions { choice, memory_budget_bytes: budget, ..LoadOptions::default() };
        load(&path, &options, &LoadControl::new())
    };
    let error = within(Portion::default(), 200 << 10).unwrap_err().to_string();
    assert!(error.contains("--every 2 reads 32 x 32 x 32 voxels in 64.0 KiB"), "{error}");
    assert!(error.contains("--reduce 3") && error.contains("--region"), "{error}");
    assert_eq!(within(Portion::with_stride(2), 200 << 10).unwrap().dims(), [32; 3]);
    assert_eq!(within(Portion::with_block_average(3), 200 << 10).unwrap().dims(), [22; 3]);
    let region = Portion { region: "0:64,0:64,60:".parse().ok(), ..Portion::default() };
    assert_eq!(within(region, 200 << 10).unwrap().dims(), [64, 64, 4]);
    let error = within(Portion::with_block_average(2), 200 << 10).unwrap_err().to_string();
    assert!(error.contains("means of 2 x 2 x 2 voxels of 64 x 64 x 64"), "{error}");
}
