//! Unsupported formats of simulations, visual effects and geoscience.

use super::UnsupportedFormat;
use super::mark::Mark;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "an OpenVDB file",
        marks: &[Mark::Bytes(0, b" BDV\0\0\0\0")],
        endings: &[".vdb"],
        help: "save a grid as an array: python -c \"import openvdb, numpy; g = openvdb.readAllGridMetadata('IN.vdb')[0]; \
               g = openvdb.read('IN.vdb', g.name); a, b = g.evalActiveVoxelBoundingBox(); \
               v = numpy.zeros([q - p + 1 for p, q in zip(a, b)], 'f4'); g.copyToArray(v, ijk=a); \
               numpy.save('OUT.npy', v.T)\"",
    },
    UnsupportedFormat {
        what: "a NanoVDB file",
        marks: &[Mark::Bytes(0, b"NanoVDB")],
        endings: &[".nvdb"],
        help: "convert it to OpenVDB with nanovdb_convert IN.nvdb OUT.vdb, and save a grid of that as an array with python's \
               openvdb and numpy.save",
    },
    UnsupportedFormat {
        what: "an Amira or Avizo file",
        marks: &[Mark::Words("# amiramesh"), Mark::Words("# avizo"), Mark::Words("# hypersurface")],
        endings: &[".am", ".amiramesh"],
        help: "open it in Fiji (File > Import > Amira File) and save it as NRRD or TIFF, or export it with Amira as TIFF",
    },
    UnsupportedFormat {
        what: "an OpenDX grid",
        marks: &[Mark::Test(|look| {
            let text = look.text();
            (text.starts_with('#') || text.starts_with("object")) && text.contains("class gridpositions")
        })],
        endings: &[".dx"],
        help: "convert it with GridDataFormats: python -c \"import gridData; gridData.Grid('IN.dx').export('OUT.mrc')\"",
    },
    UnsupportedFormat {
        what: "a SEG-Y file of seismics",
        // First card image of the textual header in EBCDIC: "C 1 " or "C01 ".
        marks: &[Mark::Bytes(0, b"\xc3\x40\xf1\x40"), Mark::Bytes(0, b"\xc3\xf0\xf1\x40")],
        endings: &[".sgy", ".segy"],
        help: "save it as an array: python -c \"import segyio, numpy; numpy.save('OUT.npy', segyio.tools.cube('IN.sgy'))\"",
    },
    UnsupportedFormat {
        what: "a GRIB file of weather models",
        marks: &[Mark::Bytes(0, b"GRIB")],
        endings: &[],
        help: "save a variable as an array: python -c \"import xarray, numpy; \
               numpy.save('OUT.npy', xarray.open_dataset('IN.grib', engine='cfgrib')['NAME'].values)\"",
    },
    UnsupportedFormat {
        what: "an ENVI header of remote sensing",
        marks: &[Mark::Words("envi\n"), Mark::Words("envi\r\n")],
        endings: &[],
        help: "convert it and the data beside it with GDAL: gdal_translate -of GTiff IN OUT.tif",
    },
];
