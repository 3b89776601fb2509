//! HDF5 and the formats based on it, and older or similar array formats.
//!
//! After the HDF5 file format specification 3.0, section II.A: the signature is at byte 0, 512, 1024 and so on.

use super::UnsupportedFormat;
use super::mark::{Look, Mark};

const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Returns true if a file is HDF5, possibly after a user block, which mostly has 512 bytes.
fn is_hdf5(look: &Look) -> bool {
    let places = [0, 512, 1024, 2048, 4096].into_iter();
    look.has(0, SIGNATURE)
        || places.filter_map(|at| look.stored.get(at..)).any(|rest| rest.starts_with(SIGNATURE))
}

/// Returns true if a file is HDF5 and contains one of the names, or has one of the extensions.
fn holding(look: &Look, names: &[&[u8]], endings: &[&str]) -> bool {
    is_hdf5(look)
        && (names.iter().any(|name| look.holds(name))
            || endings.iter().any(|ending| look.name.ends_with(ending)))
}

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "a MATLAB 7.3 file (HDF5)",
        marks: &[Mark::Test(|look| is_hdf5(look) && look.has(0, b"MATLAB"))],
        endings: &[],
        help: "save one of its variables as an array: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.mat')['NAME'][()])\"",
    },
    UnsupportedFormat {
        what: "an Imaris file (HDF5)",
        marks: &[Mark::Test(|look| holding(look, &[b"DataSetInfo", b"ImarisDataSet"], &[".ims"]))],
        endings: &[],
        help: "convert it with Bio-Formats: bfconvert IN.ims OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "a MINC 2 file (HDF5)",
        marks: &[Mark::Test(|look| holding(look, &[b"minc-2.0"], &[".mnc"]))],
        endings: &[],
        help: "convert it: mnc2nii IN.mnc OUT.nii, or mri_convert IN.mnc OUT.nii.gz",
    },
    UnsupportedFormat {
        what: "an HDF5 file of BigDataViewer",
        marks: &[Mark::Test(|look| holding(look, &[b"t00000"], &[]))],
        endings: &[],
        help: "save one of its volumes as an array: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.h5')['t00000/s00/0/cells'][()])\", or export it with BigDataViewer \
               in Fiji",
    },
    UnsupportedFormat {
        what: "a NeXus file (HDF5)",
        marks: &[Mark::Test(|look| holding(look, &[b"NX_class"], &[".nxs", ".nx", ".nexus"]))],
        endings: &[],
        help: "list its arrays with h5ls -r IN.nxs, and save one: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.nxs')['entry/data/data'][()])\"",
    },
    UnsupportedFormat {
        what: "a NetCDF-4 file (HDF5)",
        marks: &[Mark::Test(|look| {
            holding(look, &[b"_NCProperties", b"_Netcdf4"], &[".nc", ".nc4", ".cdf"])
        })],
        endings: &[],
        help: "list its variables with ncdump -h IN.nc, and save one as an array: python -c \"import xarray, numpy; \
               numpy.save('OUT.npy', xarray.open_dataset('IN.nc')['NAME'].values)\"",
    },
    UnsupportedFormat {
        what: "an HDF5 file",
        marks: &[Mark::Test(is_hdf5)],
        endings: &[],
        help: "list its arrays with h5ls -r IN.h5, and save one: python -c \"import h5py, numpy; \
               numpy.save('OUT.npy', h5py.File('IN.h5')['NAME'][()])\"",
    },
    UnsupportedFormat {
        what: "a MINC 1 file (NetCDF)",
        marks: &[
            Mark::Named(0, b"CDF", &[".mnc", ".mnc.gz"]),
            Mark::Holding(0, b"CDF\x01", b"MINC standard"),
        ],
        endings: &[],
        help: "convert it: mnc2nii IN.mnc OUT.nii, or mri_convert IN.mnc OUT.nii.gz",
    },
    UnsupportedFormat {
        what: "a NetCDF file",
        marks: &[Mark::Bytes(0, b"CDF\x01"), Mark::Bytes(0, b"CDF\x02"), Mark::Bytes(0, b"CDF\x05")],
        endings: &[],
        help: "list its variables with ncdump -h IN.nc, and save one as an array: python -c \"import xarray, numpy; \
               numpy.save('OUT.npy', xarray.open_dataset('IN.nc')['NAME'].values)\"",
    },
    UnsupportedFormat {
        what: "an HDF4 file",
        marks: &[Mark::Bytes(0, b"\x0e\x03\x13\x01")],
        endings: &[],
        help: "convert it to HDF5 with h4toh5 IN.hdf OUT.h5, and save an array of that with h5py and numpy.save",
    },
    UnsupportedFormat {
        what: "a MATLAB file",
        marks: &[Mark::Bytes(0, b"MATLAB 5.0 MAT-file")],
        endings: &[],
        help: "save one of its variables as an array: python -c \"import scipy.io, numpy; \
               numpy.save('OUT.npy', scipy.io.loadmat('IN.mat')['NAME'])\"",
    },
    UnsupportedFormat {
        what: "a part of a Zarr array",
        marks: &[Mark::Test(|look| {
            matches!(look.name.as_str(), ".zarray" | ".zgroup" | ".zattrs" | ".zmetadata" | "zarr.json")
        })],
        endings: &[],
        help: "it belongs to the folder it lies in; save an array of that: python -c \"import zarr, numpy; \
               numpy.save('OUT.npy', zarr.open('FOLDER', mode='r')['0'][:])\"",
    },
];
