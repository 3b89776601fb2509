//! Header lines of a PVM volume, and the texts after the voxels of version 3.

use super::super::LoadError;
use super::super::number::ScalarReduction;
use super::super::placement::GridPlacement;
use chiaroscuro_volume::{LoadContext, Modality, ValueMetadata, quoted};

/// Maximum length of a header, in bytes.
pub(super) const MAX_BYTES: usize = 1024;

/// Magic bytes of each version.
const MAGICS: [&[u8]; 3] = [b"PVM\n", b"PVM2\n", b"PVM3\n"];

/// Returns true if content with this beginning is a PVM volume.
pub(super) fn is_pvm(start: &[u8]) -> bool {
    MAGICS.iter().any(|mark| start.starts_with(mark))
}

pub(super) struct PvmHeader {
    version: usize,
    /// Voxels along x, y and z.
    pub(super) dims: [u64; 3],
    scale: [f64; 3],
    /// Bytes of each voxel: 2 are a 16-bit number, 3 and 4 a colour.
    pub(super) components: usize,
    /// Length of the header, in bytes.
    pub(super) bytes: usize,
}

impl PvmHeader {
    pub(super) fn parse(context: LoadContext<'_>, content: &[u8]) -> Result<Self, LoadError> {
        let mut lines = PvmLines { content: &content[..content.len().min(MAX_BYTES)], at: 0 };
        let bad = |field: &str, found: &str, expected: &str| {
            let why = format!("{expected} was expected, {} was found", quoted(found));
            context.bad_input_error(field, why, "check that the file is a PVM volume, or copy it again")
        };
        let mark = lines.next().unwrap_or_default();
        let version = match mark.as_str() {
            "PVM" => 1,
            "PVM2" => 2,
            "PVM3" => 3,
            _ => return Err(bad("magic", &mark, "PVM, PVM2 or PVM3")),
        };
        let mut line = lines.next().unwrap_or_default();
        while version == 1 && line.starts_with('#') {
            line = lines.next().unwrap_or_default();
        }
        let dims = parse_three(&line).ok_or_else(|| bad("dimensions", &line, "three numbers of voxels"))?;
        let scale = if version == 1 {
            [1.0; 3]
        } else {
            let line = lines.next().unwrap_or_default();
            parse_three(&line).ok_or_else(|| bad("scale", &line, "three distances"))?
        };
        let line = lines.next().unwrap_or_default();
        let components = line.trim().parse().ok().filter(|n| (1..=4).contains(n));
        let components = components.ok_or_else(|| bad("components", &line, "1 to 4 bytes for each voxel"))?;
        Ok(Self { version, dims, scale, components, bytes: lines.at })
    }

    /// Placement by relative distances: they have no unit, and often the shortest is 1.
    pub(super) fn placement(&self, part: ScalarReduction) -> GridPlacement {
        GridPlacement::from_spacing(self.scale).with_unknown_scale().with_remark(part.remark())
    }

    /// Metadata after the voxels: description, courtesy, parameters and comment, each ended by a zero byte.
    pub(super) fn hints(&self, after: &[u8]) -> ValueMetadata {
        let mut hints = ValueMetadata::default();
        if self.version == 3 {
            let after = &after[..after.len().min(MAX_BYTES)];
            let texts: Vec<String> = after
                .split(|&byte| byte == 0)
                .take(4)
                .map(|t| String::from_utf8_lossy(t).into_owned())
                .collect();
            hints.modality = Modality::from_description(&texts.join(" "));
            hints.set_acquisition(texts.iter().find(|text| !text.trim().is_empty()).map_or("", |text| text));
        }
        hints
    }
}

/// Parses the three numbers of a line.
fn parse_three<T: std::str::FromStr>(line: &str) -> Option<[T; 3]> {
    let mut numbers = line.split_whitespace().map(|word| word.parse().ok());
    Some([numbers.next()??, numbers.next()??, numbers.next()??])
}

struct PvmLines<'a> {
    content: &'a [u8],
    at: usize,
}

impl PvmLines<'_> {
    /// Next line that is ended by a newline.
    fn next(&mut self) -> Option<String> {
        let rest = self.content.get(self.at..)?;
        let end = rest.iter().position(|&byte| byte == b'\n')?;
        self.at += end + 1;
        Some(String::from_utf8_lossy(&rest[..end]).trim_end().to_owned())
    }
}
