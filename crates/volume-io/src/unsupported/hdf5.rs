//! HDF5 and the formats based on it, and older or similar array formats.
//!
//! After the HDF5 file format specification 3.0, section II.A: the signature is at byte 0, 512, 1024 and so on.

use super::UnsupportedFormat;
use super::signature::{FormatSignature, InspectedFile};

const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Returns true if a file is HDF5, possibly after a user block, which mostly has 512 bytes.
fn is_hdf5(look: &InspectedFile) -> bool {
    let places = [0, 512, 1024, 2048, 4096].into_iter();
    look.has_at(0, SIGNATURE)
        || places.filter_map(|at| look.stored.get(at..)).any(|rest| rest.starts_with(SIGNATURE))
}

/// Returns true if a file is HDF5 and contains one of the names, or has one of the extensions.
fn hdf5_containing(look: &InspectedFile, names: &[&[u8]], endings: &[&str]) -> bool {
    is_hdf5(look)
        && (names.iter().any(|name| look.contains(name))
            || endings.iter().any(|ending| look.name.ends_with(ending)))
}

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        description: "a MATLAB 7.3 file (HDF5)",
        signatures: &[FormatSignature::Test(|look| is_hdf5(look) && look.has_at(0, b"MATLAB"))],
        extensions: &[],
        advice: "save one of its variables as an array: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.mat')['NAME'][()])\"",
    },
    UnsupportedFormat {
        description: "an Imaris file (HDF5)",
        signatures: &[FormatSignature::Test(|look| {
            hdf5_containing(look, &[b"DataSetInfo", b"ImarisDataSet"], &[".ims"])
        })],
        extensions: &[],
        advice: "convert it with Bio-Formats: bfconvert IN.ims OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "a MINC 2 file (HDF5)",
        signatures: &[FormatSignature::Test(|look| hdf5_containing(look, &[b"minc-2.0"], &[".mnc"]))],
        extensions: &[],
        advice: "convert it: mnc2nii IN.mnc OUT.nii, or mri_convert IN.mnc OUT.nii.gz",
    },
    UnsupportedFormat {
        description: "an HDF5 file of BigDataViewer",
        signatures: &[FormatSignature::Test(|look| hdf5_containing(look, &[b"t00000"], &[]))],
        extensions: &[],
        advice: "save one of its volumes as an array: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.h5')['t00000/s00/0/cells'][()])\", or export it with BigDataViewer \
               in Fiji",
    },
    UnsupportedFormat {
        description: "a NeXus file (HDF5)",
        signatures: &[FormatSignature::Test(|look| {
            hdf5_containing(look, &[b"NX_class"], &[".nxs", ".nx", ".nexus"])
        })],
        extensions: &[],
        advice: "list its arrays with h5ls -r IN.nxs, and save one: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.nxs')['entry/data/data'][()])\"",
    },
    UnsupportedFormat {
        description: "a NetCDF-4 file (HDF5)",
        signatures: &[FormatSignature::Test(|look| {
            hdf5_containing(look, &[b"_NCProperties", b"_Netcdf4"], &[".nc", ".nc4", ".cdf"])
        })],
        extensions: &[],
        advice: "list its variables with ncdump -h IN.nc, and save one as an array: python -c \"import xarray, numpy; \
               numpy.save('OUT.npy', xarray.open_dataset('IN.nc')['NAME'].values)\"",
    },
    UnsupportedFormat {
        description: "an HDF5 file",
        signatures: &[FormatSignature::Test(is_hdf5)],
        extensions: &[],
        advice: "list its arrays with h5ls -r IN.h5, and save one: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.h5')['NAME'][()])\"",
    },
    UnsupportedFormat {
        description: "a MINC 1 file (NetCDF)",
        signatures: &[
            FormatSignature::BytesWithExtension(0, b"CDF", &[".mnc", ".mnc.gz"]),
            FormatSignature::Container(0, b"CDF\x01", b"MINC standard"),
        ],
        extensions: &[],
        advice: "convert it: mnc2nii IN.mnc OUT.nii, or mri_convert IN.mnc OUT.nii.gz",
    },
    UnsupportedFormat {
        description: "a NetCDF file",
        signatures: &[
            FormatSignature::Bytes(0, b"CDF\x01"),
            FormatSignature::Bytes(0, b"CDF\x02"),
            FormatSignature::Bytes(0, b"CDF\x05"),
        ],
        extensions: &[],
        advice: "list its variables with ncdump -h IN.nc, and save one as an array: python -c \"import xarray, numpy; \
               numpy.save('OUT.npy', xarray.open_dataset('IN.nc')['NAME'].values)\"",
    },
    UnsupportedFormat {
        description: "an HDF4 file",
        signatures: &[FormatSignature::Bytes(0, b"\x0e\x03\x13\x01")],
        extensions: &[],
        advice: "convert it to HDF5 with h4toh5 IN.hdf OUT.h5, and save an array of that with h5py and numpy.save",
    },
    UnsupportedFormat {
        description: "a MATLAB file",
        signatures: &[FormatSignature::Bytes(0, b"MATLAB 5.0 MAT-file")],
        extensions: &[],
        advice: "save one of its variables as an array: python -c \"import scipy.io, numpy; \
               numpy.save('OUT.npy', scipy.io.loadmat('IN.mat')['NAME'])\"",
    },
];
