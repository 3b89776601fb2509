//! Tests of `NIfTI` and Analyze files, end to end: accepted and refused files.

mod extensions;
mod geometry;
mod hints;
mod masks;
mod pairs;
mod refused;
mod series;

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

use crate::Endian;
use crate::tests::helpers::{self, assert_refused, gzip, load_path};
use chiaroscuro_volume::{LoadError, LoadErrorKind, Samples, Volume, VolumeChoice};

/// Builder of a header in a given byte order, whose fields are set one by one.
#[derive(Clone)]
struct NiftiBuilder {
    endian: Endian,
    bytes: Vec<u8>,
}

macro_rules! put {
    ($($name:ident: $type:ty),*) => { $(
        fn $name(mut self, at: usize, values: &[$type]) -> Self {
            let size = size_of::<$type>();
            for (index, value) in values.iter().enumerate() {
                let bytes = match self.endian {
                    Endian::Little => value.to_le_bytes(),
                    Endian::Big => value.to_be_bytes(),
                };
                self.bytes[at + index * size..][..size].copy_from_slice(&bytes);
            }
            self
        }
    )* };
}

impl NiftiBuilder {
    put!(i16: i16, i32: i32, i64: i64, f32: f32, f64: f64);

    fn text(mut self, at: usize, text: &[u8]) -> Self {
        self.bytes[at..at + text.len()].copy_from_slice(text);
        self
    }

    /// Returns the file's bytes: the header followed by data.
    fn with_data(&self, data: &[u8]) -> Vec<u8> {
        [&self.bytes[..], data].concat()
    }
}

/// A header of 348 bytes, followed by the extender of 4 bytes.
fn header_348(endian: Endian, dims: &[i16], datatype: i16, magic: &[u8]) -> NiftiBuilder {
    let spacing = [1.0f32, 2.0, 3.0, 4.0, 1.5, 1.0, 1.0, 1.0];
    NiftiBuilder { endian, bytes: vec![0; 352] }
        .i32(0, &[348])
        .i16(40, &[dims.len() as i16])
        .i16(42, dims)
        .i16(70, &[datatype])
        .f32(76, &spacing)
        .f32(108, &[352.0])
        .text(344, magic)
}

/// A little-endian NIfTI-1 header of a single file.
fn nifti1_header(dims: &[i16], datatype: i16) -> NiftiBuilder {
    header_348(Endian::Little, dims, datatype, b"n+1\0")
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

fn load_bytes(bytes: &[u8], choice: VolumeChoice) -> Result<Volume, LoadError> {
    helpers::load_bytes("v.nii", bytes, choice)
}

fn read(bytes: &[u8]) -> Volume {
    load_bytes(bytes, VolumeChoice::default()).unwrap()
}

#[test]
fn every_type_is_read_in_both_byte_orders_and_forms() {
    macro_rules! check {
        ($code:expr, $type:ty, $values:expr, $samples:expr) => {
            let values: [$type; 3] = $values;
            for endian in [Endian::Little, Endian::Big] {
                let data: Vec<u8> = match endian {
                    Endian::Little => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
                    Endian::Big => values.iter().flat_map(|value| value.to_be_bytes()).collect(),
                };
                let one = header_348(endian, &[3, 1, 1], $code, b"n+1\0").with_data(&data);
                let two = NiftiBuilder { endian, bytes: vec![0; 544] }
                    .i32(0, &[540])
                    .text(4, b"n+2\0\r\n\x1a\n")
                    .i16(12, &[$code])
                    .i64(16, &[3, 3, 1, 1])
                    .f64(104, &[1.0; 8])
                    .i64(168, &[544])
                    .with_data(&data);
                for file in [one, two] {
                    assert_eq!(*read(&file).samples(), $samples, "{} {endian:?}", $code);
                    assert_eq!(*read(&gzip(&file)).samples(), $samples, "{} {endian:?}", $code);
                }
            }
        };
    }
    check!(2, u8, [0, 7, 255], Samples::U8(vec![0, 7, 255]));
    check!(256, i8, [-128, 7, 127], Samples::I8(vec![-128, 7, 127]));
    check!(4, i16, [-32768, 258, 7], Samples::I16(vec![-32768, 258, 7]));
    check!(512, u16, [0, 258, 65535], Samples::U16(vec![0, 258, 65535]));
    check!(8, i32, [i32::MIN, 258, 7], Samples::I32(vec![i32::MIN, 258, 7]));
    check!(768, u32, [0, 258, u32::MAX], Samples::U32(vec![0, 258, u32::MAX]));
    check!(1024, i64, [-5, 258, 7], Samples::I32(vec![-5, 258, 7]));
    check!(1280, u64, [5, 1 << 40, 7], Samples::F64(vec![5.0, (1u64 << 40) as f64, 7.0]));
    check!(16, f32, [-1.5, 0.25, 1e30], Samples::F32(vec![-1.5, 0.25, 1e30]));
    check!(64, f64, [-1.5, 0.25, 1e300], Samples::F64(vec![-1.5, 0.25, 1e300]));
}

#[test]
fn complex_numbers_and_colours_are_shown_as_one_number() {
    let component = |component| VolumeChoice { component: Some(component), ..VolumeChoice::default() };
    let complex: Vec<u8> = [3.0f32, 4.0, 0.0, -2.0].into_iter().flat_map(f32::to_le_bytes).collect();
    let file = nifti1_header(&[2, 1, 1], 32).with_data(&complex);
    let volume = read(&file);
    assert_eq!(*volume.samples(), Samples::F32(vec![5.0, 2.0]));
    assert!(volume.remarks().iter().any(|remark| remark.contains("complex")));
    let imaginary = load_bytes(&file, component(1)).unwrap();
    assert_eq!(*imaginary.samples(), Samples::F32(vec![4.0, -2.0]));
    // Scaled by two; the intercept, which applies to real parts, is omitted from magnitudes and imaginary parts.
    let scaled = nifti1_header(&[2, 1, 1], 32).f32(112, &[2.0, 1.0]).with_data(&complex);
    assert_eq!(*read(&scaled).samples(), Samples::F32(vec![10.0, 4.0]));
    assert_eq!(*load_bytes(&scaled, component(0)).unwrap().samples(), Samples::F32(vec![7.0, 1.0]));
    assert_eq!(*load_bytes(&scaled, component(1)).unwrap().samples(), Samples::F32(vec![8.0, -4.0]));
    let wide: Vec<u8> = [3.0f64, 4.0].into_iter().flat_map(f64::to_le_bytes).collect();
    assert_eq!(*read(&nifti1_header(&[1, 1, 1], 1792).with_data(&wide)).samples(), Samples::F32(vec![5.0]));

    let colors = [255u8, 255, 255, 0, 255, 0];
    let file = nifti1_header(&[2, 1, 1], 128).f32(112, &[2.0, 1.0]).with_data(&colors);
    let volume = read(&file);
    assert_eq!(*volume.samples(), Samples::U8(vec![255, 182]), "colours are not scaled");
    assert!(volume.remarks().iter().any(|remark| remark.contains("luminance")));
    assert_eq!(*load_bytes(&file, component(2)).unwrap().samples(), Samples::U8(vec![255, 0]));
    assert_refused(load_bytes(&file, component(3)), LoadErrorKind::BadInput, &["--component", "0 to 2"]);
    let file = nifti1_header(&[1, 1, 1], 2304).with_data(&[0, 255, 0, 9]);
    assert_eq!(*read(&file).samples(), Samples::U8(vec![182]));
    assert_eq!(*load_bytes(&file, component(3)).unwrap().samples(), Samples::U8(vec![9]));
}

#[test]
fn values_are_scaled_where_a_slope_is_said() {
    let scaled = |slope: f32, intercept: f32| {
        let file =
            nifti1_header(&[3, 1, 1], 4).f32(112, &[slope, intercept]).with_data(&[0, 0, 2, 0, 255, 255]);
        read(&file).samples().clone()
    };
    assert_eq!(scaled(0.5, -3.0), Samples::F32(vec![-3.0, -2.0, -3.5]));
    assert_eq!(scaled(1.0, -1024.0), Samples::I16(vec![-1024, -1022, -1025]));
    for (slope, intercept) in [(0.0, 0.0), (0.0, 7.0), (f32::NAN, f32::NAN), (2.0, f32::NAN)] {
        assert_eq!(scaled(slope, intercept), Samples::I16(vec![0, 2, -1]), "{slope} {intercept}");
    }
}

#[test]
fn bytes_behind_a_packed_file_are_passed_over() {
    let whole = nifti1_header(&[3, 1, 1], 2).with_data(&[1, 2, 3]);
    let packed = gzip(&whole);
    let halves = [gzip(&whole[..200]), gzip(&whole[200..])].concat();
    for behind in [vec![0; 512], b"-- passed on by a gateway".to_vec(), vec![0x1f], vec![0x1f, 0x8b]] {
        for packed in [&packed, &halves] {
            let volume = read(&[&packed[..], &behind].concat());
            assert_eq!(*volume.samples(), Samples::U8(vec![1, 2, 3]), "{behind:?}");
        }
    }
    for end in [packed.len() - 1, packed.len() - 9] {
        let cut = load_bytes(&packed[..end], VolumeChoice::default());
        assert_refused(cut, LoadErrorKind::BadInput, &["truncated"]);
    }
    let mut changed = [&packed[..], &[0; 512]].concat();
    changed[packed.len() - 6] ^= 1;
    assert_refused(load_bytes(&changed, VolumeChoice::default()), LoadErrorKind::BadInput, &["broken"]);
}

#[test]
fn what_is_packed_twice_is_called_so() {
    let twice = gzip(&gzip(&nifti1_header(&[3, 1, 1], 2).with_data(&[1, 2, 3])));
    let refused = helpers::load_bytes("v.nii.gz", &twice, VolumeChoice::default());
    assert_refused(refused, LoadErrorKind::BadInput, &["compressed twice", "gunzip"]);
}
