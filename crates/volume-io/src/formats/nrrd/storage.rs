//! Storage layout of NRRD voxels: `type`, `encoding`, `endian`, `line skip`, `byte skip`.

use super::super::number::FileNumberType;
use super::super::{Endian, LoadError};
use super::header::NrrdHeader;
use chiaroscuro_volume::{LoadContext, quoted};

/// Encoding of the numbers in the data files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NrrdEncoding {
    Raw,
    Gzip,
    Bzip2,
    Hex,
    Text,
}

/// Storage of the voxels: number type, encoding, byte order and skipped parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NrrdStorage {
    pub(super) number: FileNumberType,
    pub(super) encoding: NrrdEncoding,
    /// Byte order; may be `None` for text and single bytes, which need none.
    pub(super) endian: Option<Endian>,
    /// Number of lines to skip before the data.
    pub(super) line_skip: u64,
    /// Number of bytes to skip after those lines; `None` if the data are the file's last bytes (`byte skip: -1`).
    pub(super) byte_skip: Option<u64>,
}

impl NrrdStorage {
    pub(super) fn from_header(context: LoadContext<'_>, header: &NrrdHeader) -> Result<Self, LoadError> {
        let number = parse_number_type(context, header)?;
        let encoding = parse_encoding(context, header)?;
        let endian = parse_endian(context, header)?;
        if endian.is_none() && encoding != NrrdEncoding::Text && number.bytes() > 1 {
            return Err(context.bad_input_error(
                "endian",
                "the field endian is missing and the type has more than one byte",
                "add endian: little or endian: big",
            ));
        }
        Ok(Self {
            number,
            encoding,
            endian,
            line_skip: parse_line_skip(context, header)?,
            byte_skip: parse_byte_skip(context, header, encoding)?,
        })
    }
}

fn parse_number_type(context: LoadContext<'_>, header: &NrrdHeader) -> Result<FileNumberType, LoadError> {
    const HELP: &str = "use one of uint8, int8, uint16, int16, uint32, int32, uint64, int64, float, double";
    let text = header.require(context, "type", HELP)?;
    let words: Vec<_> = text.split_whitespace().map(str::to_lowercase).collect();
    Ok(match words.join(" ").as_str() {
        "signed char" | "int8" | "int8_t" => FileNumberType::I8,
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => FileNumberType::U8,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            FileNumberType::I16
        }
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => FileNumberType::U16,
        "int" | "signed int" | "int32" | "int32_t" => FileNumberType::I32,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => FileNumberType::U32,
        "float" | "float32" => FileNumberType::F32,
        "double" | "float64" => FileNumberType::F64,
        "longlong"
        | "long long"
        | "long long int"
        | "signed long long"
        | "signed long long int"
        | "int64"
        | "int64_t" => FileNumberType::I64,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
            FileNumberType::U64
        }
        "block" => {
            return Err(context.bad_input_error(
                "type",
                format!("voxels of type {} are not supported", quoted(text)),
                HELP,
            ));
        }
        _ => {
            return Err(context.bad_input_error(
                "type",
                format!("{} is not an NRRD type", quoted(text)),
                HELP,
            ));
        }
    })
}

fn parse_encoding(context: LoadContext<'_>, header: &NrrdHeader) -> Result<NrrdEncoding, LoadError> {
    let text = header.require(context, "encoding", "add encoding: raw, gzip, bzip2, hex or ascii")?;
    match text.to_lowercase().as_str() {
        "raw" => Ok(NrrdEncoding::Raw),
        "gz" | "gzip" => Ok(NrrdEncoding::Gzip),
        "bz2" | "bzip2" => Ok(NrrdEncoding::Bzip2),
        "hex" => Ok(NrrdEncoding::Hex),
        "txt" | "text" | "ascii" => Ok(NrrdEncoding::Text),
        _ => Err(context.bad_input_error(
            "encoding",
            format!("raw, gzip, bzip2, hex or ascii was expected, {} was found", quoted(text)),
            "write it again with encoding raw or gzip (for example: unu save -f nrrd -e gzip)",
        )),
    }
}

fn parse_endian(context: LoadContext<'_>, header: &NrrdHeader) -> Result<Option<Endian>, LoadError> {
    match header.get("endian").map(str::to_lowercase).as_deref() {
        None => Ok(None),
        Some("little") => Ok(Some(Endian::Little)),
        Some("big") => Ok(Some(Endian::Big)),
        Some(other) => Err(context.bad_input_error(
            "endian",
            format!("little or big was expected, {} was found", quoted(other)),
            "correct the header",
        )),
    }
}

fn parse_line_skip(context: LoadContext<'_>, header: &NrrdHeader) -> Result<u64, LoadError> {
    let text = header.get("line skip").unwrap_or("0");
    text.parse().map_err(|_unreadable| {
        context.bad_input_error(
            "line skip",
            format!("a number of lines was expected, {} was found", quoted(text)),
            "correct the header",
        )
    })
}

fn parse_byte_skip(
    context: LoadContext<'_>,
    header: &NrrdHeader,
    encoding: NrrdEncoding,
) -> Result<Option<u64>, LoadError> {
    let text = header.get("byte skip").unwrap_or("0");
    match text.parse::<u64>() {
        Ok(skip) => Ok(Some(skip)),
        Err(_) if text == "-1" && encoding == NrrdEncoding::Raw => Ok(None),
        Err(_) if text == "-1" => Err(context.bad_input_error(
            "byte skip",
            "-1 (the data are the last bytes) is possible with encoding raw only",
            "give the number of bytes to skip",
        )),
        Err(_) => Err(context.bad_input_error(
            "byte skip",
            format!("a number of bytes or -1 was expected, {} was found", quoted(text)),
            "correct the header",
        )),
    }
}
