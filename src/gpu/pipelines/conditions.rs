//! Parts of shaders that only some variants have. Drivers inline all functions before they drop what an override constant
//! switches off, and take seconds for what is never run; so such parts stand between lines `#if`, `#else` and `#endif`
//! and are left out of the text.
//!
//! A condition is the name of a number that variants give, like those of override constants, and holds unless that is 0;
//! or such a name and a bound, as in `#if SHADOWED > 2`. What a variant does not name is 0.

use crate::gpu::GpuError;

/// Names that stand in conditions alone, which drivers are not told.
const TEXT_ALONE: [&str; 12] = [
    "FACES",
    "MISSING",
    "PRECLASSIFY",
    "DIRECT",
    "BY_NEED",
    "PREINTEGRATED",
    "KERNEL_GRADIENTS",
    "SKY",
    "BOUNCES",
    "ANISOTROPIC",
    "COLORED",
    "ONE_COLOR",
];

/// Names that are override constants as well.
const OVERRIDES: [&str; 3] = ["SHADOWED", "NEAR_STEPS", "GATHERED"];

/// Whether drivers are told a constant of that name.
pub(super) fn is_override(name: &str) -> bool {
    !TEXT_ALONE.contains(&name)
}

/// All names of conditions.
#[cfg(feature = "testing")]
pub fn shader_conditions() -> impl Iterator<Item = &'static str> {
    TEXT_ALONE.into_iter().chain(OVERRIDES)
}

/// The lines of a source whose conditions hold, where `value` tells the numbers.
///
/// # Errors
/// When a condition has another name, or the lines do not match.
pub(super) fn chosen(source: &str, value: &dyn Fn(&str) -> f64) -> Result<String, GpuError> {
    let refused = |line: &str| GpuError::Refused(format!("a shader has a line {line:?} that means nothing"));
    // Of each condition around a line, whether it holds.
    let mut around = Vec::new();
    let mut lines = String::with_capacity(source.len());
    for line in source.lines() {
        if let Some(condition) = line.strip_prefix("#if ") {
            around.push(holds(condition, value).ok_or_else(|| refused(line))?);
        } else if line == "#else" {
            let last = around.last_mut().ok_or_else(|| refused(line))?;
            *last = !*last;
        } else if line == "#endif" {
            around.pop().ok_or_else(|| refused(line))?;
        } else if line.starts_with('#') {
            return Err(refused(line));
        } else if around.iter().all(|holds| *holds) {
            lines.push_str(line);
            lines.push('\n');
        }
    }
    if around.is_empty() { Ok(lines) } else { Err(refused("#if without #endif")) }
}

/// Whether a condition holds; `None` if it is none.
fn holds(condition: &str, value: &dyn Fn(&str) -> f64) -> Option<bool> {
    let (name, bound) = match condition.split_once(" > ") {
        Some((name, bound)) => (name, bound.parse().ok()?),
        None => (condition, 0.0),
    };
    let is_known = TEXT_ALONE.contains(&name) || OVERRIDES.contains(&name);
    is_known.then(|| value(name) > bound)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_there_whose_conditions_hold() {
        let source = "a\n#if FACES\nb\n#if SHADOWED > 1\nc\n#else\nd\n#endif\n#else\ne\n#endif\nf";
        let with = |faces: f64, shadowed: f64| {
            let value = |name: &str| if name == "FACES" { faces } else { shadowed };
            chosen(source, &value).unwrap().replace('\n', "")
        };
        assert_eq!([with(1.0, 2.0), with(1.0, 1.0), with(0.0, 2.0)], ["abcf", "abdf", "aef"]);
    }

    #[test]
    fn lines_that_mean_nothing_are_refused() {
        for wrong in ["#if FACE", "#if SHADOWED > many\n#endif", "#if FACES", "#endif", "#else", "#fi"] {
            assert!(chosen(wrong, &|_| 1.0).is_err(), "{wrong:?}");
        }
    }
}
