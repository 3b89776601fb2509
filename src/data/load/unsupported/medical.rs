//! Unsupported formats of medical scanners and brain research.

use super::UnsupportedFormat;
use super::mark::Mark;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "an MRtrix image",
        marks: &[Mark::Bytes(0, b"mrtrix image")],
        endings: &[".mif", ".mif.gz", ".mih"],
        help: "convert it: mrconvert IN.mif OUT.nii.gz",
    },
    UnsupportedFormat {
        what: "an AFNI header",
        marks: &[Mark::WordsWith("type", "string-attribute"), Mark::WordsWith("type", "integer-attribute")],
        endings: &[".head", ".brik", ".brik.gz"],
        help: "convert it: 3dAFNItoNIFTI -prefix OUT.nii.gz IN+orig.HEAD",
    },
    UnsupportedFormat {
        what: "a PAR header of Philips scanners",
        marks: &[Mark::Words("# === data description file")],
        endings: &[".par"],
        help: "convert it and the REC file beside it: dcm2niix IN.PAR, or parrec2nii IN.PAR",
    },
    UnsupportedFormat {
        what: "a file of parameters of a Bruker scanner (ParaVision)",
        marks: &[Mark::Words("##title=parameter list")],
        endings: &["2dseq", "visu_pars", "acqp"],
        help: "convert the folder of the study: brkraw tonii FOLDER",
    },
    UnsupportedFormat {
        what: "an Interfile header",
        marks: &[Mark::Words("!interfile")],
        endings: &[".hv", ".h33", ".i33"],
        help: "convert it: medcon -c nifti -f IN.hv",
    },
    UnsupportedFormat {
        what: "an ECAT file of positron emission tomography",
        marks: &[Mark::Bytes(0, b"MATRIX7"), Mark::Bytes(0, b"MATRIX6")],
        endings: &[],
        help: "convert it: medcon -c nifti -f IN.v, or python -c \"import nibabel; \
               i = nibabel.load('IN.v'); nibabel.save(nibabel.Nifti1Image(i.get_fdata(), i.affine), 'OUT.nii.gz')\"",
    },
    UnsupportedFormat {
        what: "a volume of a Scanco scanner (ISQ, AIM)",
        marks: &[Mark::Bytes(0, b"CTDATA-HEADER_V1"), Mark::Bytes(0, b"AIMDATA_V030")],
        endings: &[".isq", ".aim"],
        help: "convert it: pip install itk-ioscanco, then python -c \"import itk; itk.imwrite(itk.imread('IN.isq'), 'OUT.nrrd')\"",
    },
    UnsupportedFormat {
        what: "a BrainVoyager file",
        marks: &[],
        endings: &[".vmr", ".v16", ".vmp"],
        help: "export it as NIfTI with BrainVoyager, or save it as an array with python's bvbabel and numpy.save",
    },
    UnsupportedFormat {
        what: "an AVW file of Analyze",
        marks: &[Mark::Words("avw_imagefile")],
        endings: &[".avw"],
        help: "export it with Analyze as NIfTI",
    },
    UnsupportedFormat {
        what: "a description of VGStudio (VGI)",
        marks: &[Mark::Named(0, b"{", &[".vgi"]), Mark::Named(0, b"[", &[".vgi"])],
        endings: &[".vgi"],
        help: "open the .vol file beside it, whose voxels it describes: its Size is --dims, its Datatype --type",
    },
    UnsupportedFormat {
        what: "a project of VGStudio (VGL)",
        marks: &[],
        endings: &[".vgl", ".vgarchive"],
        help: "export the volume with VGStudio as a stack of TIFF files or as RAW; the .vol file beside a .vgi is RAW already",
    },
    UnsupportedFormat {
        what: "voxels of VGStudio (VOL), which do not say their size",
        marks: &[],
        endings: &[".vol"],
        help: "give what the .vgi file beside it says: its Size as --dims, its Datatype as --type",
    },
];
