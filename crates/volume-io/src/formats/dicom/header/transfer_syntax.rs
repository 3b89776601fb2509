//! Transfer syntaxes: encoding of data sets, and compression of pixels (PS3.5 chapter 10, PS3.6 annex A).

use crate::Endian;

/// Encoding of data elements: explicit or implicit value representation, and byte order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ElementEncoding {
    /// True if elements state their value representation.
    pub(crate) is_explicit: bool,
    pub(crate) endian: Endian,
}

impl ElementEncoding {
    pub(crate) const EXPLICIT: Self = Self { is_explicit: true, endian: Endian::Little };
    pub(crate) const IMPLICIT: Self = Self { is_explicit: false, endian: Endian::Little };
    const BIG: Self = Self { is_explicit: true, endian: Endian::Big };

    /// Detects the encoding from the beginning of a data set; `said` is the stated one, for lack of evidence.
    pub(crate) fn detect(start: &[u8], said: Self) -> Self {
        let [a, b, _, _, vr @ ..] = start else { return said };
        // The first group is 8 at most, so that one of its bytes is 0, which shows the byte order.
        let endian = match (a, b) {
            (0, 1..) => Endian::Big,
            (1.., 0) => Endian::Little,
            _ => said.endian,
        };
        let is_explicit = vr.len() >= 2 && vr[..2].iter().all(u8::is_ascii_uppercase);
        Self { is_explicit, endian }
    }
}

/// Compression codec of the pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PixelCodec {
    /// Native encoding: pixels without compression.
    Native,
    /// Each frame deflated by itself.
    Deflated,
    Rle,
    Jpeg,
    JpegLs,
    Jpeg2000,
}

impl PixelCodec {
    /// Detects the codec of a compressed image from its magic bytes, as the codecs' standards define them.
    fn detect(start: &[u8]) -> Option<Self> {
        const JPEG_2000_FILE: &[u8] = &[0, 0, 0, 12, b'j', b'P', b' ', b' '];
        /// Capability bit (`Rsiz`) of High-Throughput JPEG 2000 (ITU-T T.814, which is not supported).
        const HIGH_THROUGHPUT: u8 = 0x40;
        match start {
            [0xff, 0x4f, 0xff, 0x51, _, _, capabilities, ..] => {
                (capabilities & HIGH_THROUGHPUT == 0).then_some(Self::Jpeg2000)
            }
            [0xff, 0xd8, rest @ ..] => Self::detect_jpeg(rest),
            _ if start.starts_with(JPEG_2000_FILE) => Some(Self::Jpeg2000),
            // Up to 15 segments, the first of which begins behind a header of 64 bytes (PS3.5, G.5).
            [1..=15, 0, 0, 0, 64, 0, 0, 0, ..] => Some(Self::Rle),
            _ => None,
        }
    }

    /// Detects the codec of a JPEG from its segments, up to the frame header.
    fn detect_jpeg(mut segments: &[u8]) -> Option<Self> {
        while let [0xff, mark, high, low, ..] = *segments {
            match mark {
                // Sequential, extended, progressive, lossless (ITU-T T.81, table B.1).
                0xc0..=0xc3 => return Some(Self::Jpeg),
                0xf7 => return Some(Self::JpegLs),
                _ => segments = segments.get(2 + usize::from(u16::from_be_bytes([high, low])).max(2)..)?,
            }
        }
        None
    }
}

/// Unsupported transfer syntax: its name, and advice for the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct UnsupportedSyntax {
    /// True for a private syntax, whose pixels may nevertheless be plain.
    pub(crate) is_private: bool,
    pub(crate) name: String,
    pub(crate) advice: &'static str,
}

/// Private syntax of GE: a data set without value representations, pixels in big-endian order.
const PRIVATE_GE: &str = "1.2.840.113619.5.2";

/// Advice for a syntax that tools on every system can convert.
const CONVERT_ADVICE: &str = "convert it with `gdcmconv --raw in.dcm out.dcm`";

/// Advice for a syntax that such tools cannot convert.
const ASK_SENDER_ADVICE: &str = "ask the sender for an uncompressed file (Explicit VR Little Endian)";

/// Advice for files that contain a video stream.
const EXTRACT_FRAMES_ADVICE: &str = "extract its frames: `gdcmraw -i in.dcm -o video.mpg`, \
                        `ffmpeg -i video.mpg %04d.png`, and open their folder";

/// Transfer syntax of a data set and its pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TransferSyntax {
    pub(crate) encoding: ElementEncoding,
    pub(crate) is_deflated: bool,
    /// Byte order of the pixels, if it differs from that of the data set.
    pub(crate) pixel_endian: Option<Endian>,
    /// True if the pixels are in fragments.
    pub(crate) is_encapsulated: bool,
    /// Codec of the pixels; `Err` if the syntax is not supported.
    pub(crate) codec: Result<PixelCodec, UnsupportedSyntax>,
}

impl TransferSyntax {
    /// Returns the syntax of a data set whose file does not state one.
    pub(crate) fn native(form: ElementEncoding) -> Self {
        Self {
            encoding: form,
            is_deflated: false,
            pixel_endian: None,
            is_encapsulated: false,
            codec: Ok(PixelCodec::Native),
        }
    }

    /// Returns the syntax of an identifier.
    pub(crate) fn from_uid(uid: &str) -> Self {
        let native = |form| Self::native(form);
        let encapsulated = |codec| Self {
            encoding: ElementEncoding::EXPLICIT,
            is_deflated: false,
            pixel_endian: None,
            is_encapsulated: true,
            codec: Ok(codec),
        };
        if uid == PRIVATE_GE {
            return Self { pixel_endian: Some(Endian::Big), ..native(ElementEncoding::IMPLICIT) };
        }
        let Some(rest) = uid.strip_prefix("1.2.840.10008.1.2") else {
            return Self::private(uid, "a private transfer syntax");
        };
        match rest {
            "" => native(ElementEncoding::IMPLICIT),
            ".1" => native(ElementEncoding::EXPLICIT),
            ".1.98" => encapsulated(PixelCodec::Native),
            ".1.99" => Self { is_deflated: true, ..native(ElementEncoding::EXPLICIT) },
            ".2" => native(ElementEncoding::BIG),
            ".5" => encapsulated(PixelCodec::Rle),
            ".8.1" => encapsulated(PixelCodec::Deflated),
            ".4.50" | ".4.51" | ".4.57" | ".4.70" => encapsulated(PixelCodec::Jpeg),
            ".4.80" | ".4.81" => encapsulated(PixelCodec::JpegLs),
            ".4.90" | ".4.91" => encapsulated(PixelCodec::Jpeg2000),
            ".4.92" | ".4.93" => Self::unsupported(uid, "multi-component JPEG 2000", CONVERT_ADVICE),
            ".4.94" | ".4.95" | ".4.204" | ".4.205" => {
                Self::unsupported(uid, "pixels on a server (JPIP)", ASK_SENDER_ADVICE)
            }
            ".4.201" | ".4.202" | ".4.203" => {
                Self::unsupported(uid, "High-Throughput JPEG 2000", ASK_SENDER_ADVICE)
            }
            ".4.110" | ".4.111" | ".4.112" => Self::unsupported(uid, "JPEG XL", ASK_SENDER_ADVICE),
            _ if rest.starts_with(".4.10") => Self::unsupported(uid, "a video (MPEG)", EXTRACT_FRAMES_ADVICE),
            _ if rest.starts_with(".4.") => Self::unsupported(uid, "a rare kind of JPEG", CONVERT_ADVICE),
            _ => Self::private(uid, "an unknown transfer syntax"),
        }
    }

    /// Returns the syntax of a private or unknown identifier, whose pixels may turn out to be supported.
    fn private(uid: &str, name: &str) -> Self {
        let refused = Self::unsupported(uid, name, ASK_SENDER_ADVICE);
        let codec = refused.codec.map_err(|not_read| UnsupportedSyntax { is_private: true, ..not_read });
        Self { codec, ..refused }
    }

    /// True for a private or unknown syntax.
    pub(crate) fn is_private(&self) -> bool {
        self.codec.as_ref().is_err_and(|not_read| not_read.is_private)
    }

    /// Corrects the syntax by the pixels themselves: programs decompress pixels and leave the syntax unchanged, and
    /// private syntaxes are often plain.
    ///
    /// `length` is the size of the pixels, `None` for fragments, the first image of which begins with `start`;
    /// `expected` is the size of all images without compression.
    #[must_use]
    pub(crate) fn corrected_by_pixels(
        self,
        length: Option<u64>,
        expected: Option<u64>,
        start: &[u8],
    ) -> Self {
        /// Maximum number of padding bytes behind pixels.
        const MAX_PADDING: u64 = 16;
        let may_be_wrong = match &self.codec {
            Ok(codec) => *codec != PixelCodec::Native || length.is_none(),
            Err(not_read) => not_read.is_private,
        };
        if !may_be_wrong {
            return self;
        }
        let is_plain = length.zip(expected).is_some_and(|(length, expected)| {
            (expected..=expected.saturating_add(MAX_PADDING)).contains(&length)
        });
        if is_plain {
            return Self { is_encapsulated: false, codec: Ok(PixelCodec::Native), ..self };
        }
        let found = if length.is_none() && self.codec.is_err() { PixelCodec::detect(start) } else { None };
        match found {
            Some(codec) => Self { is_encapsulated: true, codec: Ok(codec), ..self },
            None => self,
        }
    }

    /// Returns a syntax whose pixels are not supported; the header is read with the most common encoding.
    fn unsupported(uid: &str, name: &str, help: &'static str) -> Self {
        let name = format!("{name}, {}", chiaroscuro_files::sanitised(uid, 64));
        Self {
            encoding: ElementEncoding::EXPLICIT,
            is_deflated: false,
            pixel_endian: None,
            is_encapsulated: true,
            codec: Err(UnsupportedSyntax { is_private: false, name, advice: help }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_say_how_pixels_are_compressed() {
        for (uid, codec) in [
            ("1.2.840.10008.1.2", PixelCodec::Native),
            ("1.2.840.10008.1.2.1", PixelCodec::Native),
            ("1.2.840.10008.1.2.5", PixelCodec::Rle),
            ("1.2.840.10008.1.2.8.1", PixelCodec::Deflated),
            ("1.2.840.10008.1.2.4.70", PixelCodec::Jpeg),
            ("1.2.840.10008.1.2.4.91", PixelCodec::Jpeg2000),
            ("1.2.840.10008.1.2.4.80", PixelCodec::JpegLs),
        ] {
            assert_eq!(TransferSyntax::from_uid(uid).codec, Ok(codec), "{uid}");
        }
        for (uid, name) in [
            ("1.2.840.10008.1.2.4.102", "video"),
            ("1.2.840.10008.1.2.4.201", "High-Throughput"),
            ("1.3.46.670589.33.1.4.1", "private"),
            ("", "private"),
        ] {
            assert!(TransferSyntax::from_uid(uid).codec.unwrap_err().name.contains(name), "{uid}");
        }
    }

    #[test]
    fn a_look_at_the_pixels_says_more_than_a_private_identifier() {
        let codec = |uid: &str, length: Option<u64>, start: &[u8]| {
            TransferSyntax::from_uid(uid).corrected_by_pixels(length, Some(112), start).codec.ok()
        };
        let private = "1.3.46.670589.33.1.4.1";
        for length in [112, 113] {
            assert_eq!(codec(private, Some(length), &[]), Some(PixelCodec::Native), "{length} bytes");
        }
        for length in [0, 111, 200] {
            assert_eq!(codec(private, Some(length), &[]), None, "{length} bytes");
        }
        for (start, found) in [
            (&[0xff, 0xd8, 0xff, 0xe0, 0, 4, 0, 0, 0xff, 0xc3, 0, 11][..], Some(PixelCodec::Jpeg)),
            (&[0xff, 0xd8, 0xff, 0xf7, 0, 11], Some(PixelCodec::JpegLs)),
            (&[0xff, 0xd8, 0xff, 0xe0, 0xff, 0xff], None),
            (&[0xff, 0xd8, 0xff, 0xe0, 0, 0, 0, 0], None),
            (&[0xff, 0x4f, 0xff, 0x51, 0, 41, 0, 0], Some(PixelCodec::Jpeg2000)),
            (&[0xff, 0x4f, 0xff, 0x51, 0, 41, 0x40, 0], None),
            (&[2, 0, 0, 0, 64, 0, 0, 0], Some(PixelCodec::Rle)),
            (&[16, 0, 0, 0, 64, 0, 0, 0], None),
            (&[], None),
        ] {
            assert_eq!(codec(private, None, start), found, "{start:?}");
        }
        // Known syntaxes are not guessed.
        assert_eq!(codec("1.2.840.10008.1.2.4.201", Some(112), &[]), None);
        assert_eq!(
            codec("1.2.840.10008.1.2.4.70", Some(112), &[]),
            Some(PixelCodec::Native),
            "unpacked, and not said"
        );
        assert_eq!(codec("1.2.840.10008.1.2.4.70", None, &[0xff, 0xd8, 0xff, 0xf7]), Some(PixelCodec::Jpeg));
        assert_eq!(TransferSyntax::from_uid(PRIVATE_GE).pixel_endian, Some(Endian::Big));
    }

    #[test]
    fn the_first_element_says_how_it_is_written() {
        let of = |start: &[u8]| ElementEncoding::detect(start, ElementEncoding::EXPLICIT);
        assert_eq!(of(b"\x08\0\x05\0CS\x0a\0"), ElementEncoding::EXPLICIT);
        assert_eq!(of(b"\x08\0\x05\0\x0a\0\0\0"), ElementEncoding::IMPLICIT);
        assert_eq!(of(b"\0\x08\0\x05CS\0\x0a"), ElementEncoding::BIG);
        assert_eq!(of(b""), ElementEncoding::EXPLICIT);
    }
}
