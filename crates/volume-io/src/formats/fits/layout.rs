//! Layout of a FITS array: number type, scale, and the meaning of its axes: three form a volume, a fourth makes
//! several.

use super::super::number::FileNumberType;
use super::super::{FileDimension, LoadError};
use super::header::FitsHeader;
use chiaroscuro_volume::LoadContext;

/// Storage of an array as one or several volumes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FitsLayout {
    pub(super) number: FileNumberType,
    /// Number of voxels along x, y, z.
    pub(super) dims: [u64; 3],
    /// Axes of the file behind x, y and z, counted from 1; `None` for the z axis of a two-dimensional image.
    pub(super) axes: [Option<usize>; 3],
    /// Axis along which there are several volumes, counted from 1, and their number.
    pub(super) series_axis: Option<(usize, u64)>,
    /// Slope and intercept of the values (`BSCALE`, `BZERO`).
    pub(super) scale: [f64; 2],
    /// Value that marks unmeasured pixels (`BLANK`), after scaling.
    pub(super) blank: Option<f64>,
}

impl FitsLayout {
    /// Derives the layout from a header; `None` for an array without elements, or with fewer than two axes. If there
    /// are more than three axes, those of length 1 are dropped.
    ///
    /// # Errors
    /// `BadInput` for an unknown type, and for more than four axes longer than 1.
    pub(super) fn new(context: LoadContext<'_>, header: &FitsHeader) -> Result<Option<Self>, LoadError> {
        let lengths = header.axes(context)?;
        if lengths.contains(&0) {
            return Ok(None);
        }
        let bits = header.required_int(context, "BITPIX")?;
        let Some(number) = number_from_bitpix(bits) else {
            return Err(context.bad_input_error(
                "BITPIX",
                format!("values of {bits} bits are not supported; 8, 16, 32, 64, -32 and -64 are"),
                "copy or download the file again",
            ));
        };
        let mut axes: Vec<(usize, u64)> = (1..).zip(lengths).collect();
        while axes.len() > 3 {
            let Some(single) = axes.iter().rposition(|&(_, length)| length == 1) else { break };
            axes.remove(single);
        }
        let (grid, outer) = match axes[..] {
            [] | [_] => return Ok(None),
            [x, y] => ([Some(x), Some(y), None], None),
            [x, y, z] => ([Some(x), Some(y), Some(z)], None),
            [x, y, z, outer] => ([Some(x), Some(y), Some(z)], Some(outer)),
            _ => {
                return Err(context.bad_input_error(
                    "NAXIS",
                    format!(
                        "an array of {} axes longer than 1 is not supported: two to four are",
                        axes.len()
                    ),
                    "cut it along the others first: python -c \"from astropy.io import fits; \
                     fits.writeto('OUT.fits', fits.getdata('IN.fits')[0])\"",
                ));
            }
        };
        let scale = [header.float("BSCALE").unwrap_or(1.0), header.float("BZERO").unwrap_or(0.0)];
        // Only integer arrays have `BLANK`; floating-point arrays use NaN.
        let blank = if bits > 0 { header.int(context, "BLANK").ok().flatten() } else { None };
        Ok(Some(Self {
            number,
            dims: grid.map(|axis| axis.map_or(1, |(_, length)| length)),
            axes: grid.map(|axis| axis.map(|(axis, _)| axis)),
            series_axis: outer,
            scale,
            blank: blank.map(|blank| scale_value(blank as f64, scale, number)),
        }))
    }

    /// Returns the dimension in which the volumes differ, and a function that names the volume of a number.
    pub(super) fn dimension(&self, header: &FitsHeader) -> (FileDimension, impl Fn(usize) -> String + use<>) {
        let axis = self.series_axis.map_or(0, |(axis, _)| axis);
        let is_stokes = header.text(&format!("CTYPE{axis}")).eq_ignore_ascii_case("STOKES");
        let at = |keyword: &str, otherwise| header.float(&format!("{keyword}{axis}")).unwrap_or(otherwise);
        let (value, pixel, step) = (at("CRVAL", 0.0), at("CRPIX", 0.0), at("CDELT", 1.0));
        let name = move |number: usize| {
            let code = value + step * (number as f64 + 1.0 - pixel);
            if is_stokes { stokes_name(code).to_owned() } else { String::new() }
        };
        (if is_stokes { FileDimension::Channel } else { FileDimension::Frame }, name)
    }
}

/// Maps `BITPIX` to a number type (table 8 of the standard).
fn number_from_bitpix(bits: i64) -> Option<FileNumberType> {
    Some(match bits {
        8 => FileNumberType::U8,
        16 => FileNumberType::I16,
        32 => FileNumberType::I32,
        64 => FileNumberType::I64,
        -32 => FileNumberType::F32,
        -64 => FileNumberType::F64,
        _ => return None,
    })
}

/// Scales a stored number as voxels are scaled: 8- and 16-bit integers with a fractional scale become 32-bit floats.
fn scale_value(stored: f64, [slope, intercept]: [f64; 2], number: FileNumberType) -> f64 {
    let value = stored.mul_add(slope, intercept);
    let is_whole = slope.fract() == 0.0 && intercept.fract() == 0.0;
    if is_whole || number.bytes() > 2 { value } else { f64::from(value as f32) }
}

/// Returns the name of a polarisation (Stokes parameter) by its code (table 28).
fn stokes_name(code: f64) -> &'static str {
    match code.round() as i64 {
        1 => "I",
        2 => "Q",
        3 => "U",
        4 => "V",
        -1 => "RR",
        -2 => "LL",
        -3 => "RL",
        -4 => "LR",
        -5 => "XX",
        -6 => "YY",
        -7 => "XY",
        -8 => "YX",
        _ => "",
    }
}
