//! Transfer syntaxes: encoding of data sets, and compression of pixels (PS3.5 chapter 10, PS3.6 annex A).

use crate::data::load::Endian;

/// Encoding of data elements: explicit or implicit value representation, and byte order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) struct Form {
    /// True if elements state their value representation.
    pub(in crate::data::load::formats::dicom) is_explicit: bool,
    pub(in crate::data::load::formats::dicom) endian: Endian,
}

impl Form {
    pub(in crate::data::load::formats::dicom) const EXPLICIT: Self =
        Self { is_explicit: true, endian: Endian::Little };
    pub(in crate::data::load::formats::dicom) const IMPLICIT: Self =
        Self { is_explicit: false, endian: Endian::Little };
    const BIG: Self = Self { is_explicit: true, endian: Endian::Big };

    /// Detects the encoding from the beginning of a data set; `said` is the stated one, for lack of evidence.
    pub(in crate::data::load::formats::dicom) fn of_start(start: &[u8], said: Self) -> Self {
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
pub(in crate::data::load::formats::dicom) enum Codec {
    /// Native encoding: pixels without compression.
    Native,
    Rle,
    Jpeg,
    JpegLs,
    Jpeg2000,
}

impl Codec {
    /// Detects the codec of a compressed image from its magic bytes, as the codecs' standards define them.
    fn of_picture(start: &[u8]) -> Option<Self> {
        const JPEG_2000_FILE: &[u8] = &[0, 0, 0, 12, b'j', b'P', b' ', b' '];
        /// Capability bit (`Rsiz`) of High-Throughput JPEG 2000 (ITU-T T.814, which is not supported).
        const HIGH_THROUGHPUT: u8 = 0x40;
        match start {
            [0xff, 0x4f, 0xff, 0x51, _, _, capabilities, ..] => {
                (capabilities & HIGH_THROUGHPUT == 0).then_some(Self::Jpeg2000)
            }
            [0xff, 0xd8, rest @ ..] => Self::of_jpeg_segments(rest),
            _ if start.starts_with(JPEG_2000_FILE) => Some(Self::Jpeg2000),
            // Up to 15 segments, the first of which begins behind a header of 64 bytes (PS3.5, G.5).
            [1..=15, 0, 0, 0, 64, 0, 0, 0, ..] => Some(Self::Rle),
            _ => None,
        }
    }

    /// Detects the codec of a JPEG from its segments, up to the frame header.
    fn of_jpeg_segments(mut segments: &[u8]) -> Option<Self> {
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
pub(in crate::data::load::formats::dicom) struct NotRead {
    /// True for a private syntax, whose pixels may nevertheless be plain.
    pub(crate) is_private: bool,
    pub(in crate::data::load::formats::dicom) name: String,
    pub(in crate::data::load::formats::dicom) help: &'static str,
}

/// Private syntax of GE: a data set without value representations, pixels in big-endian order.
const PRIVATE_GE: &str = "1.2.840.113619.5.2";

/// Advice for a syntax that tools on every system can convert.
const CONVERT: &str = "convert it with `gdcmconv --raw in.dcm out.dcm`";

/// Advice for a syntax that such tools cannot convert.
const ASK: &str = "ask who sent it for pixels without compression (Explicit VR Little Endian)";

/// Advice for files that contain a video stream.
const FRAMES: &str = "take its pictures out: `gdcmraw -i in.dcm -o film.mpg`, `ffmpeg -i film.mpg %04d.png`, and open their folder";

/// Transfer syntax of a data set and its pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) struct Syntax {
    pub(in crate::data::load::formats::dicom) form: Form,
    pub(in crate::data::load::formats::dicom) is_deflated: bool,
    /// Byte order of the pixels, if it differs from that of the data set.
    pub(crate) pixel_endian: Option<Endian>,
    /// True if the pixels are in fragments.
    pub(in crate::data::load::formats::dicom) is_encapsulated: bool,
    /// Codec of the pixels; `Err` if the syntax is not supported.
    pub(in crate::data::load::formats::dicom) codec: Result<Codec, NotRead>,
}

impl Syntax {
    /// Returns the syntax of a data set whose file does not state one.
    pub(in crate::data::load::formats::dicom) fn unsaid(form: Form) -> Self {
        Self {
            form,
            is_deflated: false,
            pixel_endian: None,
            is_encapsulated: false,
            codec: Ok(Codec::Native),
        }
    }

    /// Returns the syntax of an identifier.
    pub(in crate::data::load::formats::dicom) fn of(uid: &str) -> Self {
        let native = |form| Self::unsaid(form);
        let encapsulated = |codec| Self {
            form: Form::EXPLICIT,
            is_deflated: false,
            pixel_endian: None,
            is_encapsulated: true,
            codec: Ok(codec),
        };
        if uid == PRIVATE_GE {
            return Self { pixel_endian: Some(Endian::Big), ..native(Form::IMPLICIT) };
        }
        let Some(rest) = uid.strip_prefix("1.2.840.10008.1.2") else {
            return Self::private(uid, "a private syntax");
        };
        match rest {
            "" => native(Form::IMPLICIT),
            ".1" => native(Form::EXPLICIT),
            ".1.98" => encapsulated(Codec::Native),
            ".1.99" => Self { is_deflated: true, ..native(Form::EXPLICIT) },
            ".2" => native(Form::BIG),
            ".5" => encapsulated(Codec::Rle),
            ".4.50" | ".4.51" | ".4.57" | ".4.70" => encapsulated(Codec::Jpeg),
            ".4.80" | ".4.81" => encapsulated(Codec::JpegLs),
            ".4.90" | ".4.91" => encapsulated(Codec::Jpeg2000),
            ".4.92" | ".4.93" => Self::refused(uid, "JPEG 2000 of several components", CONVERT),
            ".4.94" | ".4.95" | ".4.204" | ".4.205" => Self::refused(uid, "pixels on a server (JPIP)", ASK),
            ".4.201" | ".4.202" | ".4.203" => Self::refused(uid, "High-Throughput JPEG 2000", ASK),
            ".4.110" | ".4.111" | ".4.112" => Self::refused(uid, "JPEG XL", ASK),
            _ if rest.starts_with(".4.10") => Self::refused(uid, "a film (MPEG)", FRAMES),
            _ if rest.starts_with(".4.") => Self::refused(uid, "a rare kind of JPEG", CONVERT),
            _ => Self::private(uid, "a syntax that is not known"),
        }
    }

    /// Returns the syntax of a private or unknown identifier, whose pixels may turn out to be supported.
    fn private(uid: &str, name: &str) -> Self {
        let refused = Self::refused(uid, name, ASK);
        let codec = refused.codec.map_err(|not_read| NotRead { is_private: true, ..not_read });
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
    pub(crate) fn looked_at(self, length: Option<u64>, expected: Option<u64>, start: &[u8]) -> Self {
        /// Maximum number of padding bytes behind pixels.
        const MOST_FILL: u64 = 16;
        let is_open = match &self.codec {
            Ok(codec) => *codec != Codec::Native || length.is_none(),
            Err(not_read) => not_read.is_private,
        };
        if !is_open {
            return self;
        }
        let is_plain = length.zip(expected).is_some_and(|(length, expected)| {
            (expected..=expected.saturating_add(MOST_FILL)).contains(&length)
        });
        if is_plain {
            return Self { is_encapsulated: false, codec: Ok(Codec::Native), ..self };
        }
        let found = if length.is_none() && self.codec.is_err() { Codec::of_picture(start) } else { None };
        match found {
            Some(codec) => Self { is_encapsulated: true, codec: Ok(codec), ..self },
            None => self,
        }
    }

    /// Returns a syntax whose pixels are not supported; the header is read with the most common encoding.
    fn refused(uid: &str, name: &str, help: &'static str) -> Self {
        let name = format!("{name}, {}", crate::data::plain(uid, 64));
        Self {
            form: Form::EXPLICIT,
            is_deflated: false,
            pixel_endian: None,
            is_encapsulated: true,
            codec: Err(NotRead { is_private: false, name, help }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_say_how_pixels_are_compressed() {
        for (uid, codec) in [
            ("1.2.840.10008.1.2", Codec::Native),
            ("1.2.840.10008.1.2.1", Codec::Native),
            ("1.2.840.10008.1.2.5", Codec::Rle),
            ("1.2.840.10008.1.2.4.70", Codec::Jpeg),
            ("1.2.840.10008.1.2.4.91", Codec::Jpeg2000),
            ("1.2.840.10008.1.2.4.80", Codec::JpegLs),
        ] {
            assert_eq!(Syntax::of(uid).codec, Ok(codec), "{uid}");
        }
        for (uid, name) in [
            ("1.2.840.10008.1.2.4.102", "film"),
            ("1.2.840.10008.1.2.4.201", "High-Throughput"),
            ("1.3.46.670589.33.1.4.1", "private"),
            ("", "private"),
        ] {
            assert!(Syntax::of(uid).codec.unwrap_err().name.contains(name), "{uid}");
        }
    }

    #[test]
    fn a_look_at_the_pixels_says_more_than_a_private_identifier() {
        let codec = |uid: &str, length: Option<u64>, start: &[u8]| {
            Syntax::of(uid).looked_at(length, Some(112), start).codec.ok()
        };
        let private = "1.3.46.670589.33.1.4.1";
        for length in [112, 113] {
            assert_eq!(codec(private, Some(length), &[]), Some(Codec::Native), "{length} bytes");
        }
        for length in [0, 111, 200] {
            assert_eq!(codec(private, Some(length), &[]), None, "{length} bytes");
        }
        for (start, found) in [
            (&[0xff, 0xd8, 0xff, 0xe0, 0, 4, 0, 0, 0xff, 0xc3, 0, 11][..], Some(Codec::Jpeg)),
            (&[0xff, 0xd8, 0xff, 0xf7, 0, 11], Some(Codec::JpegLs)),
            (&[0xff, 0xd8, 0xff, 0xe0, 0xff, 0xff], None),
            (&[0xff, 0xd8, 0xff, 0xe0, 0, 0, 0, 0], None),
            (&[0xff, 0x4f, 0xff, 0x51, 0, 41, 0, 0], Some(Codec::Jpeg2000)),
            (&[0xff, 0x4f, 0xff, 0x51, 0, 41, 0x40, 0], None),
            (&[2, 0, 0, 0, 64, 0, 0, 0], Some(Codec::Rle)),
            (&[16, 0, 0, 0, 64, 0, 0, 0], None),
            (&[], None),
        ] {
            assert_eq!(codec(private, None, start), found, "{start:?}");
        }
        // Known syntaxes are not guessed.
        assert_eq!(codec("1.2.840.10008.1.2.4.201", Some(112), &[]), None);
        assert_eq!(
            codec("1.2.840.10008.1.2.4.70", Some(112), &[]),
            Some(Codec::Native),
            "unpacked, and not said"
        );
        assert_eq!(codec("1.2.840.10008.1.2.4.70", None, &[0xff, 0xd8, 0xff, 0xf7]), Some(Codec::Jpeg));
        assert_eq!(Syntax::of(PRIVATE_GE).pixel_endian, Some(Endian::Big));
    }

    #[test]
    fn the_first_element_says_how_it_is_written() {
        let of = |start: &[u8]| Form::of_start(start, Form::EXPLICIT);
        assert_eq!(of(b"\x08\0\x05\0CS\x0a\0"), Form::EXPLICIT);
        assert_eq!(of(b"\x08\0\x05\0\x0a\0\0\0"), Form::IMPLICIT);
        assert_eq!(of(b"\0\x08\0\x05CS\0\x0a"), Form::BIG);
        assert_eq!(of(b""), Form::EXPLICIT);
    }
}
