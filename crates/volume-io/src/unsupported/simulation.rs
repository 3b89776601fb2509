//! Unsupported formats of simulations, visual effects and geoscience.

use super::UnsupportedFormat;
use super::signature::FormatSignature;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        description: "an OpenVDB file",
        signatures: &[FormatSignature::Bytes(0, b" BDV\0\0\0\0")],
        extensions: &[".vdb"],
        advice: "save a grid as an array: python -c \"import openvdb, numpy; g = openvdb.readAllGridMetadata('IN.vdb')[0]; \
               g = openvdb.read('IN.vdb', g.name); a, b = g.evalActiveVoxelBoundingBox(); \
               v = numpy.zeros([q - p + 1 for p, q in zip(a, b)], 'f4'); g.copyToArray(v, ijk=a); \
               numpy.save('OUT.npy', v.T)\"",
    },
    UnsupportedFormat {
        description: "a NanoVDB file",
        signatures: &[FormatSignature::Bytes(0, b"NanoVDB")],
        extensions: &[".nvdb"],
        advice: "convert it to OpenVDB with nanovdb_convert IN.nvdb OUT.vdb, and save a grid of that as an array with Python's \
               openvdb and numpy.save",
    },
    UnsupportedFormat {
        description: "an Amira or Avizo file",
        signatures: &[
            FormatSignature::Text("# amiramesh"),
            FormatSignature::Text("# avizo"),
            FormatSignature::Text("# hypersurface"),
        ],
        extensions: &[".am", ".amiramesh"],
        advice: "open it in Fiji (File > Import > Amira File) and save it as NRRD or TIFF, or export it with Amira as TIFF",
    },
    UnsupportedFormat {
        description: "an OpenDX grid",
        signatures: &[FormatSignature::Test(|look| {
            let text = look.text();
            (text.starts_with('#') || text.starts_with("object")) && text.contains("class gridpositions")
        })],
        extensions: &[".dx"],
        advice: "convert it with GridDataFormats: python -c \"import gridData; gridData.Grid('IN.dx').export('OUT.mrc')\"",
    },
    UnsupportedFormat {
        description: "a SEG-Y file of seismic data",
        // First card image of the textual header in EBCDIC: "C 1 " or "C01 ".
        signatures: &[
            FormatSignature::Bytes(0, b"\xc3\x40\xf1\x40"),
            FormatSignature::Bytes(0, b"\xc3\xf0\xf1\x40"),
        ],
        extensions: &[".sgy", ".segy"],
        advice: "save it as an array: python -c \"import segyio, numpy; numpy.save('OUT.npy', segyio.tools.cube('IN.sgy'))\"",
    },
    UnsupportedFormat {
        description: "a GRIB file of weather models",
        signatures: &[FormatSignature::Bytes(0, b"GRIB")],
        extensions: &[],
        advice: "save a variable as an array: python -c \"import xarray, numpy; \
               numpy.save('OUT.npy', xarray.open_dataset('IN.grib', engine='cfgrib')['NAME'].values)\"",
    },
    UnsupportedFormat {
        description: "an ENVI header of remote sensing",
        signatures: &[FormatSignature::Text("envi\n"), FormatSignature::Text("envi\r\n")],
        extensions: &[],
        advice: "convert it and the data beside it with GDAL: gdal_translate -of GTiff IN OUT.tif",
    },
];
