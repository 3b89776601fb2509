//! Unsupported formats of medical scanners and brain research.

use super::UnsupportedFormat;
use super::signature::FormatSignature;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        description: "an MRtrix image",
        signatures: &[FormatSignature::Bytes(0, b"mrtrix image")],
        extensions: &[".mif", ".mif.gz", ".mih"],
        advice: "convert it: mrconvert IN.mif OUT.nii.gz",
    },
    UnsupportedFormat {
        description: "an AFNI header",
        signatures: &[
            FormatSignature::TextWith("type", "string-attribute"),
            FormatSignature::TextWith("type", "integer-attribute"),
        ],
        extensions: &[".head", ".brik", ".brik.gz"],
        advice: "convert it: 3dAFNItoNIFTI -prefix OUT.nii.gz IN+orig.HEAD",
    },
    UnsupportedFormat {
        description: "a PAR header of Philips scanners",
        signatures: &[FormatSignature::Text("# === data description file")],
        extensions: &[".par"],
        advice: "convert it and the REC file beside it: dcm2niix IN.PAR, or parrec2nii IN.PAR",
    },
    UnsupportedFormat {
        description: "a parameter file of a Bruker scanner (ParaVision)",
        signatures: &[FormatSignature::Text("##title=parameter list")],
        extensions: &["2dseq", "visu_pars", "acqp"],
        advice: "convert the folder of the study: brkraw tonii FOLDER",
    },
    UnsupportedFormat {
        description: "an Interfile header",
        signatures: &[FormatSignature::Text("!interfile")],
        extensions: &[".hv", ".h33", ".i33"],
        advice: "convert it: medcon -c nifti -f IN.hv",
    },
    UnsupportedFormat {
        description: "an ECAT file of positron emission tomography",
        signatures: &[FormatSignature::Bytes(0, b"MATRIX7"), FormatSignature::Bytes(0, b"MATRIX6")],
        extensions: &[],
        advice: "convert it: medcon -c nifti -f IN.v, or python -c \"import nibabel; \
               i = nibabel.load('IN.v'); nibabel.save(nibabel.Nifti1Image(i.get_fdata(), i.affine), 'OUT.nii.gz')\"",
    },
    UnsupportedFormat {
        description: "a volume of a Scanco scanner (ISQ, AIM)",
        signatures: &[
            FormatSignature::Bytes(0, b"CTDATA-HEADER_V1"),
            FormatSignature::Bytes(0, b"AIMDATA_V030"),
        ],
        extensions: &[".isq", ".aim"],
        advice: "convert it: pip install itk-ioscanco, then python -c \"import itk; itk.imwrite(itk.imread('IN.isq'), 'OUT.nrrd')\"",
    },
    UnsupportedFormat {
        description: "a BrainVoyager file",
        signatures: &[],
        extensions: &[".vmr", ".v16", ".vmp"],
        advice: "export it as NIfTI with BrainVoyager, or save it as an array with Python's bvbabel and numpy.save",
    },
    UnsupportedFormat {
        description: "an AVW file of Analyze",
        signatures: &[FormatSignature::Text("avw_imagefile")],
        extensions: &[".avw"],
        advice: "export it with Analyze as NIfTI",
    },
    UnsupportedFormat {
        description: "a description of VGStudio (VGI)",
        signatures: &[
            FormatSignature::BytesWithExtension(0, b"{", &[".vgi"]),
            FormatSignature::BytesWithExtension(0, b"[", &[".vgi"]),
        ],
        extensions: &[".vgi"],
        advice: "open the .vol file beside it with the values of this file: Size as --dims, Datatype as --type",
    },
    UnsupportedFormat {
        description: "a project of VGStudio (VGL)",
        signatures: &[],
        extensions: &[".vgl", ".vgarchive"],
        advice: "export the volume with VGStudio as a stack of TIFF files or as RAW; the .vol file beside a .vgi is RAW already",
    },
    UnsupportedFormat {
        description: "a file of VGStudio (VOL), which contains nothing but voxels",
        signatures: &[],
        extensions: &[".vol"],
        advice: "give the values of the .vgi file beside it: Size as --dims, Datatype as --type",
    },
];
