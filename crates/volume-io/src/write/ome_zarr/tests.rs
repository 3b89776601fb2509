//! Tests of pyramids: read back by the reader of this program, averaged against a plain loop, and interrupted.

use std::collections::BTreeMap;
use std::io::{Error, Result as IoResult};
use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use serde_json::Value;

use super::hierarchy_sink::HierarchySink;
use super::*;
use crate::write::{NumberRequest, write_volume};
use crate::{LoadOptions, load};
use chiaroscuro_volume::{
    LoadControl, Portion, Samples, ValueMeaning, ValueMetadata, Volume, VolumeChoice, VoxelType,
};

/// Dimensions that no chunk or shard divides.
const DIMS: [usize; 3] = [150, 67, 131];

fn mixed(at: usize) -> u64 {
    (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 16
}

/// Numbers modulo 100, in a type.
fn narrowed(samples: &Samples, voxel_type: VoxelType) -> Samples {
    let small = (0..samples.len()).map(|at| samples.value(at) % 100.0).collect();
    Samples::F64(small).converted_to(voxel_type, samples.len()).unwrap()
}

/// Volume of smooth numbers with noise in a type.
fn volume(dims: [usize; 3], voxel_type: VoxelType) -> Volume {
    let count = dims.iter().product::<usize>();
    let numbers = (0..count).map(|at| ((at % dims[0]) as u64 + mixed(at) % 50) as f64).collect();
    // Whole numbers are exact in all types; those of 8 bits are limited.
    let samples = Samples::F64(numbers);
    let samples = match voxel_type {
        VoxelType::U8 | VoxelType::I8 => narrowed(&samples, voxel_type),
        _ => samples.converted_to(voxel_type, count).unwrap(),
    };
    let place = DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::new(0.5e-3, 0.25e-3, 0.5e-3)),
        translation: DVec3::new(7e-3, -3e-3, 0.0),
    };
    Volume::new("cells", dims, place, samples).unwrap().with_length_unit(1e-3)
}

fn read_level(path: &Path, level: &str, region: Option<&str>) -> Volume {
    let portion = region.map(|region| Portion { region: region.parse().ok(), ..Portion::default() });
    let choice = VolumeChoice { level: Some(level.to_owned()), portion, ..VolumeChoice::default() };
    load(path, &LoadOptions { choice, ..LoadOptions::default() }, &LoadControl::new()).unwrap()
}

/// Mean of blocks of a volume by a plain loop, rounded as whole numbers are.
fn plain_means(volume: &Volume, block: [usize; 3]) -> Vec<f64> {
    let dims = volume.dims();
    let is_whole = !matches!(volume.samples().voxel_type(), VoxelType::F32 | VoxelType::F64);
    let counts = [0, 1, 2].map(|axis| dims[axis].div_ceil(block[axis]));
    let mut means = Vec::new();
    for at in 0..counts.iter().product() {
        let low = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])];
        let span = |axis: usize| low[axis] * block[axis]..dims[axis].min((low[axis] + 1) * block[axis]);
        let (mut sum, mut count) = (0.0, 0.0);
        for z in span(2) {
            for y in span(1) {
                for x in span(0) {
                    sum += volume.value(x, y, z);
                    count += 1.0;
                }
            }
        }
        let mean: f64 = sum / count;
        means.push(if is_whole { mean.round() } else { mean });
    }
    means
}

#[test]
fn levels_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    for (number, voxel_type) in VoxelType::ALL.into_iter().enumerate() {
        let volume = volume(DIMS, voxel_type);
        let format = [VolumeFormat::OmeZarr, VolumeFormat::OmeZarrArchive][number % 2];
        let path = folder.path().join(format!("{number}.{}", format.extensions()[0]));
        write_volume(&path, format, &ExportVolume::new(&volume), false).unwrap();
        let finest = read_level(&path, "0", None);
        assert_eq!(finest.samples(), volume.samples(), "{voxel_type:?}");
        assert!((finest.spacing_mm() - volume.spacing_mm()).length() < 1e-15);
        let from = |volume: &Volume| volume.world_from_index().translation;
        assert!((from(&finest) - from(&volume)).length() < 1e-15);
        // The distance between rows is half of that between columns and slices: a first level halves y alone.
        let mut finer = finest;
        for (level, block) in [("1", [1, 2, 1]), ("2", [2, 2, 2])] {
            let found = read_level(&path, level, None);
            let wanted = plain_means(&finer, block);
            let is_far = |at: &usize| (found.samples().value(*at) - wanted[*at]).abs() > 1e-5 * wanted[*at];
            assert_eq!(found.samples().len(), wanted.len());
            assert_eq!((0..wanted.len()).find(is_far), None, "{voxel_type:?}, level {level}");
            let steps = DVec3::from(block.map(|n| n as f64));
            assert!((found.spacing_mm() - steps * finer.spacing_mm()).length() < 1e-12);
            let middle = from(&finer) + 0.5 * (steps - 1.0) * finer.spacing_mm();
            assert!((from(&found) - middle).length() < 1e-12, "{level}");
            finer = found;
        }
        assert_eq!(finer.dims(), [75, 17, 66]);
        let part = read_level(&path, "0", Some("60:70,0:9,120:131"));
        let is_same = |x, y, z| part.value(x, y, z) == volume.value(60 + x, y, 120 + z);
        assert!((0..990).all(|at| is_same(at % 10, at / 10 % 9, at / 90)), "{voxel_type:?}");
    }
}

#[test]
fn labels_and_missing_voxels_are_no_means() {
    let count = DIMS.iter().product::<usize>();
    let mut hints = ValueMetadata::default();
    hints.meaning = ValueMeaning::Labels;
    hints.labels.insert(3, "nucleus", Some([1.0, 0.0, 0.2]));
    hints.labels.insert(200, "membrane", None);
    let numbers = (0..count).map(|at| [0, 3, 200][mixed(at / 3) as usize % 3]).collect();
    let labels = Volume::with_spacing("labels", DIMS, DVec3::ONE, Samples::U8(numbers)).unwrap();
    let labels = labels.with_metadata(hints.clone());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("labels.ome.zarr");
    write_volume(&path, VolumeFormat::OmeZarr, &ExportVolume::new(&labels), false).unwrap();
    let (found, coarse) = (read_level(&path, "0", None), read_level(&path, "1", None));
    assert_eq!((found.metadata(), found.samples()), (&hints, labels.samples()));
    let wanted = labels.to_block_averaged([2; 3]).unwrap();
    assert_eq!(coarse.samples(), wanted.samples());
    // Missing voxels are left out of means, and chunks of nothing else are not stored.
    let numbers = (0..count).map(|at| if at % DIMS[0] < 20 { at as i16 % 100 } else { -1000 }).collect();
    let scan = Volume::with_spacing("scan", DIMS, DVec3::ONE, Samples::I16(numbers)).unwrap();
    let scan = scan.with_padding(-1000.0).unwrap();
    let path = folder.path().join("scan.ome.zarr");
    write_volume(&path, VolumeFormat::OmeZarr, &ExportVolume::new(&scan), false).unwrap();
    assert_eq!(read_level(&path, "0", None).samples(), scan.samples());
    let wanted = scan.to_block_averaged([2; 3]).unwrap();
    assert_eq!(read_level(&path, "1", None).samples(), wanted.samples());
    let document: Value = serde_json::from_slice(&std::fs::read(path.join("0/zarr.json")).unwrap()).unwrap();
    assert_eq!(document["fill_value"], -1000);
    let shard = std::fs::read(path.join("0/c/0/0/0")).unwrap();
    let index = &shard[shard.len() - 4 - 18 * 16..];
    let absent = index[..18 * 16].chunks(16).filter(|entry| **entry == [255; 16]).count();
    assert_eq!(absent, 12, "two thirds of 3 x 2 x 3 chunks");
}

/// Sink in memory, which fails after so many bytes.
#[derive(Default)]
struct MemorySink {
    files: BTreeMap<String, Vec<u8>>,
    room: usize,
}

impl HierarchySink for MemorySink {
    fn append(&mut self, key: &str, bytes: &[u8]) -> IoResult<()> {
        self.room = self.room.checked_sub(bytes.len()).ok_or_else(|| Error::other("full"))?;
        self.files.entry(key.to_owned()).or_default().extend_from_slice(bytes);
        Ok(())
    }
}

fn write_in_slabs(volume: &Volume, slices: usize, room: usize) -> IoResult<MemorySink> {
    let outgoing = ExportVolume::new(volume);
    let sink = MemorySink { room, ..MemorySink::default() };
    let mut writer = PyramidWriter::new(sink, PyramidSpec::new(&outgoing))?;
    let all = outgoing.slices(0..volume.dims()[2]);
    for slab in all.chunks(slices) {
        writer.write_slab(&slab.concat())?;
    }
    writer.finish()
}

#[test]
fn slabs_of_any_thickness_make_the_same_pyramid() {
    // More than one shard along two axes, and most of them empty.
    let dims = [520, 200, 530];
    let mut numbers: Vec<u8> =
        (0..dims.iter().product()).map(|at| if at % 65_537 == 0 { at as u8 } else { 0 }).collect();
    *numbers.last_mut().unwrap() = 9;
    let volume = Volume::with_spacing("v", dims, DVec3::ONE, Samples::U8(numbers)).unwrap();
    let whole = write_in_slabs(&volume, 530, usize::MAX).unwrap();
    assert_eq!(whole.files, write_in_slabs(&volume, 37, usize::MAX).unwrap().files);
    let shards = whole.files.keys().filter(|key| key.starts_with("0/c")).count();
    assert_eq!(shards, 4);
    let levels = whole.files.keys().filter(|key| key.ends_with("/zarr.json")).count();
    assert_eq!(levels, 4, "530, 265, 133 and 67 slices");
    let first: Value = serde_json::from_slice(&whole.files["zarr.json"]).unwrap();
    let ome = &first["attributes"]["ome"];
    assert_eq!(
        (&ome["version"], &ome["multiscales"][0]["axes"][0]["unit"]),
        (&"0.5".into(), &"millimeter".into())
    );
}

#[test]
fn what_fails_leaves_nothing() {
    let volume = volume([70, 60, 130], VoxelType::U16);
    assert!(write_in_slabs(&volume, 64, 10_000).is_err());
    let outgoing = ExportVolume::new(&volume);
    let folder = tempfile::tempdir().unwrap();
    let count = || std::fs::read_dir(folder.path()).unwrap().count();
    for format in [VolumeFormat::OmeZarr, VolumeFormat::OmeZarrArchive] {
        let path = folder.path().join("a").with_extension(format.extensions()[0]);
        let mut writer = OmeZarrWriter::new(&path, format, PyramidSpec::new(&outgoing), false).unwrap();
        writer.write_slab(&outgoing).unwrap();
        let said = writer.write_slab(&outgoing).unwrap_err().to_string();
        assert!(said.contains("more slices"), "{said}");
        drop(writer);
        let longer = PyramidSpec::new(&outgoing).with_whole(200, &outgoing);
        let mut writer = OmeZarrWriter::new(&path, format, longer, false).unwrap();
        writer.write_slab(&outgoing).unwrap();
        let wish = NumberRequest { voxel_type: Some(VoxelType::F32), rescaled: None, padding: None };
        let other = ExportVolume::new(&volume).with_number_type(&wish).unwrap();
        assert!(writer.write_slab(&other).unwrap_err().to_string().contains("another number type"));
        assert!(writer.finish().unwrap_err().to_string().contains("fewer slices"));
        assert_eq!(count(), 0);
    }
    let theirs = folder.path().join("theirs.ome.zarr");
    std::fs::create_dir(&theirs).unwrap();
    std::fs::write(theirs.join("zarr.json"), "{}").unwrap();
    assert!(write_volume(&theirs, VolumeFormat::OmeZarr, &outgoing, false).is_err() && count() == 1);
    write(&theirs, VolumeFormat::OmeZarr, &outgoing, true).unwrap();
    assert_eq!(read_level(&theirs, "0", None).samples(), volume.samples());
    write_volume(&theirs, VolumeFormat::OmeZarr, &outgoing, false).unwrap();
    assert_eq!(count(), 1);
}

/// Writes samples to the folder that the environment names, for comparison with other readers.
#[test]
#[ignore = "writes many files; CHIAROSCURO_ZARR_SAMPLES names the folder"]
fn samples_for_other_readers() {
    let Some(folder) = std::env::var_os("CHIAROSCURO_ZARR_SAMPLES") else { return };
    let write = |name: &str, volume: &Volume| {
        for format in [VolumeFormat::OmeZarr, VolumeFormat::OmeZarrArchive] {
            let begin = std::time::Instant::now();
            let path = Path::new(&folder).join(format!("{name}.{}", format.extensions()[0]));
            write_volume(&path, format, &ExportVolume::new(volume), false).unwrap();
            let seconds = begin.elapsed().as_secs_f64();
            let bytes = volume.samples().len() * volume.samples().voxel_type().bytes();
            println!("{name} {format:?}: {bytes} bytes, {:.0} MB/s", bytes as f64 / 1e6 / seconds);
        }
        let raw = ExportVolume::new(volume).slices(0..volume.dims()[2]).concat();
        let [x, y, z] = volume.dims();
        let kind = volume.samples().voxel_type().name();
        std::fs::write(Path::new(&folder).join(format!("{name}_{x}x{y}x{z}_{kind}.raw")), raw).unwrap();
    };
    for voxel_type in [VoxelType::U8, VoxelType::I16, VoxelType::U16, VoxelType::F32, VoxelType::F64] {
        write(voxel_type.name(), &volume([301, 67, 259], voxel_type));
    }
    let numbers = (0..301 * 67 * 259).map(|at| [0u16, 3, 200, 999][mixed(at / 3) as usize % 4]).collect();
    let mut hints = ValueMetadata::default();
    hints.meaning = ValueMeaning::Labels;
    hints.labels.insert(3, "nucleus", Some([1.0, 0.0, 0.2]));
    let labels = Volume::with_spacing("labels", [301, 67, 259], DVec3::ONE, Samples::U16(numbers)).unwrap();
    write("labels", &labels.with_metadata(hints));
    let numbers =
        (0..600 * 520 * 515).map(|at: usize| if at.is_multiple_of(999_983) { 7 } else { 0 }).collect();
    write("sparse", &Volume::with_spacing("s", [600, 520, 515], DVec3::ONE, Samples::U8(numbers)).unwrap());
    write("bone", &chiaroscuro_volume::synthetic::builtin("bone", Some(256)).unwrap());
}
