//! Unsupported formats based on OLE 2 compound files, recognised by the names of their streams.

use super::UnsupportedFormat;
use super::mark::Mark;
use super::ole2::SIGNATURE;

pub(super) const FORMATS: &[UnsupportedFormat] = &[
    UnsupportedFormat {
        what: "a tomogram of Zeiss Xradia (TXM, TXRM)",
        marks: &[
            Mark::Compound("ImageInfo"),
            Mark::Compound("ImageData1"),
            Mark::Named(0, SIGNATURE, &[".txm", ".txrm"]),
        ],
        endings: &[".txm", ".txrm"],
        help: "save it as an array: python -c \"import dxchange, numpy; \
               numpy.save('OUT.npy', dxchange.read_txrm('IN.txm')[0])\", or export it as TIFF with XMController",
    },
    UnsupportedFormat {
        what: "an OIB file of Olympus microscopes",
        marks: &[Mark::Compound("OibInfo.txt"), Mark::Named(0, SIGNATURE, &[".oib"])],
        endings: &[".oib"],
        help: "convert it with Bio-Formats: bfconvert IN.oib OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "a ZVI file of Zeiss AxioVision",
        marks: &[Mark::Compound("Item(0)"), Mark::Named(0, SIGNATURE, &[".zvi"])],
        endings: &[".zvi"],
        help: "convert it with Bio-Formats: bfconvert IN.zvi OUT.ome.tif, or open it in Fiji and save it as TIFF",
    },
    UnsupportedFormat {
        what: "a document of an older Office",
        marks: &[
            Mark::Compound("WordDocument"),
            Mark::Compound("Workbook"),
            Mark::Compound("Book"),
            Mark::Compound("PowerPoint Document"),
        ],
        endings: &[],
        help: "it is no volume: open the data that it is about",
    },
    UnsupportedFormat {
        what: "a compound file of OLE 2, as microscopes and Office programs write them",
        marks: &[Mark::Bytes(0, SIGNATURE)],
        endings: &[],
        help: "if it is of a microscope, convert it with Bio-Formats: bfconvert IN OUT.ome.tif, or open it in Fiji and save \
               it as TIFF",
    },
];
