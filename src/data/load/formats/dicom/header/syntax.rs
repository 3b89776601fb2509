//! Transfer syntaxes: how a data set is written, and how its pixels are compressed (PS3.5 chapter 10, PS3.6 annex A).

use crate::data::load::Endian;

/// How data elements are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) struct Form {
    /// Elements say their representation.
    pub(in crate::data::load::formats::dicom) is_explicit: bool,
    pub(in crate::data::load::formats::dicom) endian: Endian,
}

impl Form {
    pub(in crate::data::load::formats::dicom) const EXPLICIT: Self =
        Self { is_explicit: true, endian: Endian::Little };
    pub(in crate::data::load::formats::dicom) const IMPLICIT: Self =
        Self { is_explicit: false, endian: Endian::Little };
    const BIG: Self = Self { is_explicit: true, endian: Endian::Big };

    /// How a data set is written that begins so.
    pub(in crate::data::load::formats::dicom) fn of_start(start: &[u8], said: Self) -> Self {
        let [a, b, _, _, vr @ ..] = start else { return said };
        // The first group is 8 at most, so that one of its bytes is 0 and says the order.
        let endian = match (a, b) {
            (0, 1..) => Endian::Big,
            (1.., 0) => Endian::Little,
            _ => said.endian,
        };
        let is_explicit = vr.len() >= 2 && vr[..2].iter().all(u8::is_ascii_uppercase);
        Self { is_explicit, endian }
    }
}

/// How pixels are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) enum Codec {
    /// They are not.
    Native,
    Rle,
    Jpeg,
    JpegLs,
    Jpeg2000,
}

/// A syntax that is not read: its name, and what helps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) struct NotRead {
    pub(in crate::data::load::formats::dicom) name: String,
    pub(in crate::data::load::formats::dicom) help: &'static str,
}

/// Where tools of every system know it.
const CONVERT: &str = "convert it with `gdcmconv --raw in.dcm out.dcm`";

/// Where they do not.
const ASK: &str = "ask who sent it for pixels without compression (Explicit VR Little Endian)";

/// Films within files.
const FRAMES: &str = "take its pictures out: `gdcmraw -i in.dcm -o film.mpg`, `ffmpeg -i film.mpg %04d.png`, and open their folder";

/// A transfer syntax.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::data::load::formats::dicom) struct Syntax {
    pub(in crate::data::load::formats::dicom) form: Form,
    pub(in crate::data::load::formats::dicom) is_deflated: bool,
    /// Pixels are in fragments.
    pub(in crate::data::load::formats::dicom) is_encapsulated: bool,
    /// `Err` where it is not read.
    pub(in crate::data::load::formats::dicom) codec: Result<Codec, NotRead>,
}

impl Syntax {
    /// The syntax of a data set whose file does not say it.
    pub(in crate::data::load::formats::dicom) fn unsaid(form: Form) -> Self {
        Self { form, is_deflated: false, is_encapsulated: false, codec: Ok(Codec::Native) }
    }

    /// The syntax of an identifier.
    pub(in crate::data::load::formats::dicom) fn of(uid: &str) -> Self {
        let native = |form| Self::unsaid(form);
        let encapsulated = |codec| Self {
            form: Form::EXPLICIT,
            is_deflated: false,
            is_encapsulated: true,
            codec: Ok(codec),
        };
        let Some(rest) = uid.strip_prefix("1.2.840.10008.1.2") else {
            return Self::refused(uid, "a private syntax", ASK);
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
            _ => Self::refused(uid, "a syntax that is not known", ASK),
        }
    }

    /// Its header is read as nearly all are written; its pixels are not.
    fn refused(uid: &str, name: &str, help: &'static str) -> Self {
        let name = format!("{name}, {}", crate::data::plain(uid, 64));
        Self {
            form: Form::EXPLICIT,
            is_deflated: false,
            is_encapsulated: true,
            codec: Err(NotRead { name, help }),
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
            ("1.2.840.113619.5.2", "private"),
            ("", "private"),
        ] {
            assert!(Syntax::of(uid).codec.unwrap_err().name.contains(name), "{uid}");
        }
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
