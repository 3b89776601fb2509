//! Unsupported formats based on OLE 2 compound files, recognised by the names of their streams.

use super::UnsupportedFormat;
use super::ole2::SIGNATURE;
use super::signature::FormatSignature;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        description: "a tomogram of Zeiss Xradia (TXM, TXRM)",
        signatures: &[
            FormatSignature::Compound("ImageInfo"),
            FormatSignature::Compound("ImageData1"),
            FormatSignature::BytesWithExtension(0, SIGNATURE, &[".txm", ".txrm"]),
        ],
        extensions: &[".txm", ".txrm"],
        advice: "save it as an array: python -c \"import dxchange, numpy; \
               numpy.save('OUT.npy', dxchange.read_txrm('IN.txm')[0])\", or export it as TIFF with XMController",
    },
    UnsupportedFormat {
        description: "an OIB file of Olympus microscopes",
        signatures: &[
            FormatSignature::Compound("OibInfo.txt"),
            FormatSignature::BytesWithExtension(0, SIGNATURE, &[".oib"]),
        ],
        extensions: &[".oib"],
        advice: "convert it with Bio-Formats: bfconvert IN.oib OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "a ZVI file of Zeiss AxioVision",
        signatures: &[
            FormatSignature::Compound("Item(0)"),
            FormatSignature::BytesWithExtension(0, SIGNATURE, &[".zvi"]),
        ],
        extensions: &[".zvi"],
        advice: "convert it with Bio-Formats: bfconvert IN.zvi OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        description: "a document of an older Office version",
        signatures: &[
            FormatSignature::Compound("WordDocument"),
            FormatSignature::Compound("Workbook"),
            FormatSignature::Compound("Book"),
            FormatSignature::Compound("PowerPoint Document"),
        ],
        extensions: &[],
        advice: "it is not a volume: open the data that it describes",
    },
    UnsupportedFormat {
        description: "a compound file of OLE 2, as microscopes and Office programs write them",
        signatures: &[FormatSignature::Bytes(0, SIGNATURE)],
        extensions: &[],
        advice: "if a microscope wrote it, convert it with Bio-Formats: bfconvert IN OUT.ome.tif, or open it in Fiji and save \
               it as TIFF",
    },
];
