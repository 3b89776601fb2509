//! Array formats that are older than HDF5 or similar to it, and MINC 2, which is based on it.

use super::UnsupportedFormat;
use super::signature::FormatSignature;
use chiaroscuro_volume::{LoadContext, LoadError};

/// Format of MINC 2, which is recognised by the reader of HDF5 files.
pub(super) const MINC_2: UnsupportedFormat = UnsupportedFormat {
    description: "a MINC 2 file (HDF5)",
    signatures: &[],
    extensions: &[],
    advice: "convert it: mnc2nii IN.mnc OUT.nii, or mri_convert IN.mnc OUT.nii.gz",
};

/// Error for a MINC 2 file.
pub(crate) fn minc_2_refusal(context: LoadContext<'_>) -> LoadError {
    MINC_2.refusal(context)
}

pub(super) const FORMATS: &[UnsupportedFormat] = &[
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
