//! Transfer functions of other programs: which of them a file is from, and what it says.
//!
//! ParaView's colour maps (`.json`) say values of the data, and so do 3D Slicer's volume properties (`.vp`);
//! colour tables of `MRIcroGL` (`.clut`) and `ImageJ` (`.lut`) are laid over the range of the volume.

use std::path::Path;

use super::exchange::{ExchangeError, form, from_paraview, merged};
use super::{ControlPoint, TransferFunction};

/// Endings of the files that [`import`] reads.
pub const IMPORTED: [&str; 4] = ["json", "vp", "clut", "lut"];

/// Entries of a table of bytes.
const TABLE: usize = 256;

/// Entries of a table between the points that are taken from it: 17 points.
const EVERY: usize = 16;

/// Reads the transfer function of a file with that name, for a volume with these values.
///
/// # Errors
/// When the file is not what its name says.
pub fn import(path: &Path, bytes: &[u8], range: (f64, f64)) -> Result<TransferFunction, ExchangeError> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if ending == "lut" && !bytes.is_ascii() {
        return from_table(bytes, range);
    }
    let text = std::str::from_utf8(bytes).map_err(|err| form(&format!("it is no text: {err}")))?;
    match ending.as_str() {
        "vp" => from_slicer(text),
        "clut" => from_mricrogl(text, range),
        "lut" => from_rows(text, range),
        _ => from_paraview(text),
    }
}

/// 3D Slicer's volume property: numbers of the shading, then opacities by value, opacities by gradient, and
/// colours by value, each list behind the count of its numbers.
fn from_slicer(text: &str) -> Result<TransferFunction, ExchangeError> {
    let mut lists = Vec::new();
    for line in text.lines() {
        let numbers: Option<Vec<f64>> =
            line.split_whitespace().map(|word| word.parse().ok().filter(|n: &f64| n.is_finite())).collect();
        let numbers = numbers.ok_or_else(|| form("a line holds something that is no number"))?;
        if numbers.len() > 1 {
            if numbers[0] != (numbers.len() - 1) as f64 {
                return Err(form("a list does not hold as many numbers as it says"));
            }
            lists.push(numbers[1..].to_vec());
        }
    }
    let [opacities, _by_gradient, colors] = &lists[..] else {
        return Err(form("a volume property has three lists: opacities, opacities by gradient, and colours"));
    };
    if opacities.is_empty() || opacities.len() % 2 != 0 || colors.is_empty() || colors.len() % 4 != 0 {
        return Err(form("a list of the volume property is cut off"));
    }
    let opacities: Vec<_> = opacities.chunks_exact(2).map(|at| (at[0], at[1].clamp(0.0, 1.0))).collect();
    let colors: Vec<_> = colors
        .chunks_exact(4)
        .map(|at| (at[0], [at[1], at[2], at[3]].map(|c| c.clamp(0.0, 1.0) as f32)))
        .collect();
    Ok(merged(colors, opacities))
}

/// `MRIcroGL`'s colour table: nodes with a place from 0 to 255 and red, green, blue and opacity as bytes.
fn from_mricrogl(text: &str, range: (f64, f64)) -> Result<TransferFunction, ExchangeError> {
    let entry = |key: &str| {
        text.lines().find_map(|line| {
            let (name, value) = line.split_once('=')?;
            name.trim().eq_ignore_ascii_case(key).then(|| value.trim())
        })
    };
    let number = |key: &str| entry(key).and_then(|value| value.parse().ok()).filter(|n: &f64| n.is_finite());
    let count = number("numnodes").filter(|count| (2.0..=TABLE as f64).contains(count));
    let count = count.ok_or_else(|| form("numnodes must be a number from 2 to 256"))? as usize;
    // Zeros stand for the range of the volume.
    let (low, high) = match (number("min"), number("max")) {
        (Some(low), Some(high)) if low < high => (low, high),
        _ => range,
    };
    let mut points = Vec::with_capacity(count);
    for node in 0..count {
        let place = number(&format!("nodeintensity{node}"));
        let place = place.ok_or_else(|| form(&format!("nodeintensity{node} is missing")))?;
        let rgba: Option<Vec<f64>> = entry(&format!("nodergba{node}"))
            .map(|value| value.split('|').map_while(|part| part.trim().parse().ok()).collect());
        let Some(&[r, g, b, a]) = rgba.as_deref() else {
            return Err(form(&format!("nodergba{node} must be four numbers with | between")));
        };
        let share = |byte: f64| (byte / 255.0).clamp(0.0, 1.0);
        points.push(ControlPoint {
            value: low + (high - low) * share(place),
            color: [r, g, b].map(|byte| share(byte) as f32),
            opacity: share(a),
        });
    }
    let mut function = TransferFunction { points, ..TransferFunction::default() };
    function.sort();
    Ok(function)
}

/// `ImageJ`'s colour table: 256 reds, as many greens, and as many blues, perhaps behind a header.
fn from_table(bytes: &[u8], range: (f64, f64)) -> Result<TransferFunction, ExchangeError> {
    let first = bytes.len().checked_sub(3 * TABLE).ok_or_else(|| form("a table has 768 bytes"))?;
    let table = &bytes[first..];
    let colors: Vec<_> = (0..TABLE).map(|at| [table[at], table[at + TABLE], table[at + 2 * TABLE]]).collect();
    Ok(ramp(&colors, range))
}

/// The same as text: rows of red, green and blue, perhaps behind the entry's number.
fn from_rows(text: &str, range: (f64, f64)) -> Result<TransferFunction, ExchangeError> {
    let row = |line: &str| {
        let numbers: Option<Vec<u8>> = line
            .split([' ', '\t', ','])
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().ok())
            .collect();
        let numbers = numbers?;
        let first = numbers.len().checked_sub(3)?;
        (first <= 1).then(|| [numbers[first], numbers[first + 1], numbers[first + 2]])
    };
    // A first line of words names the columns.
    let colors: Vec<[u8; 3]> = text.lines().filter_map(row).collect();
    if colors.len() != TABLE {
        return Err(form(&format!("{} rows of three bytes were found, a table has 256", colors.len())));
    }
    Ok(ramp(&colors, range))
}

/// The colours of a table over a range, more and more opaque.
fn ramp(colors: &[[u8; 3]], (low, high): (f64, f64)) -> TransferFunction {
    let last = colors.len() - 1;
    let point = |at: usize| {
        let share = at as f64 / last as f64;
        let color = colors[at].map(|byte| f32::from(byte) / 255.0);
        ControlPoint { value: low + (high - low) * share, color, opacity: share }
    };
    let places = (0..last).step_by(EVERY).chain([last]);
    TransferFunction { points: places.map(point).collect(), ..TransferFunction::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, bytes: &[u8]) -> Result<TransferFunction, String> {
        import(Path::new(name), bytes, (-1000.0, 1000.0)).map_err(|err| err.to_string())
    }

    #[test]
    fn slicers_volume_properties() {
        let text = "1\n1\n0.9\n0.1\n0.2\n10\n6 -100 0 50 0.5 300 2\n4 0 1 255 1\n8 -100 0 0 0 300 1 0.5 0\n";
        let function = read("bone.VP", text.as_bytes()).unwrap();
        let [low, middle, high] = function.points[..] else { panic!("{function:?}") };
        assert_eq!((low.value, low.opacity, high.value, high.opacity), (-100.0, 0.0, 300.0, 1.0));
        assert_eq!((middle.value, middle.opacity), (50.0, 0.5));
        assert!((middle.color[0] - 0.375).abs() < 1e-6, "between the colours: {middle:?}");
    }

    #[test]
    fn mricrogls_tables() {
        let text = "[FLT]\nmin=0\nmax=0\n[INT]\nnumnodes=2\n[BYT]\nnodeintensity0=0\nnodeintensity1=255\n\
                    [RGBA255]\nnodergba0=0|0|0|0\nnodergba1=255|51|0|102\n";
        let function = read("hot.clut", text.as_bytes()).unwrap();
        let [low, high] = function.points[..] else { panic!("{function:?}") };
        assert_eq!((low.value, low.opacity), (-1000.0, 0.0), "over the volume's range");
        assert_eq!((high.value, high.opacity, high.color), (1000.0, 0.4, [1.0, 0.2, 0.0]));
        let own = text.replace("min=0", "min=20").replace("max=0", "max=70");
        assert_eq!(read("hot.clut", own.as_bytes()).unwrap().points[1].value, 70.0);
    }

    #[test]
    fn imagejs_tables() {
        let table: Vec<u8> = (0..768).map(|at| if at < 256 { at as u8 } else { 0 }).collect();
        let header = [b"ICOL".as_slice(), &[0; 28]].concat();
        let rows: Vec<String> = (0..256).map(|at| format!("{at}\t{at}\t0\t0")).collect();
        let plain = read("red.lut", &table).unwrap();
        assert_eq!(plain, read("red.lut", &[header.as_slice(), &table].concat()).unwrap());
        assert_eq!(
            plain,
            read("red.lut", format!("Index\tRed\tGreen\tBlue\n{}", rows.join("\n")).as_bytes()).unwrap()
        );
        assert_eq!(plain.points.len(), 17);
        assert_eq!((plain.points[16].value, plain.points[16].color), (1000.0, [1.0, 0.0, 0.0]));
        assert_eq!((plain.points[0].value, plain.points[0].opacity), (-1000.0, 0.0));
    }

    #[test]
    fn other_files_are_refused_in_words() {
        for (name, bytes, what) in [
            ("a.vp", b"1\n1\n".as_slice(), "three lists"),
            ("a.vp", b"3 1 2\n", "as many numbers"),
            ("a.vp", b"3 0 1 2\n2 0 1\n4 0 0 0 0\n", "cut off"),
            ("a.vp", b"hello", "no number"),
            ("a.clut", b"numnodes=1", "2 to 256"),
            ("a.clut", b"numnodes=2", "nodeintensity0"),
            ("a.clut", b"numnodes=2\nnodeintensity0=1\nnodergba0=1|2|3", "four numbers"),
            ("a.lut", &[200; 700], "768 bytes"),
            ("a.lut", b"1 2 3\n", "256"),
            ("a.json", b"{", "JSON"),
            ("a.json", &[0xff, 0xfe], "no text"),
        ] {
            let err = read(name, bytes).unwrap_err();
            assert!(err.contains(what), "{name}: {err}");
        }
    }
}
