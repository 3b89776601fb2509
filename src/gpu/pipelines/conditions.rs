//! Conditional compilation of shaders (`#if`, `#else`, `#endif`).
//!
//! Drivers inline all functions before they drop what an override constant switches off, and spend seconds on code
//! that never runs; so code that only some variants need is left out of the text.
//!
//! A condition is the name of a variant's number, like that of an override constant, and holds unless the number is
//! 0; or a name and a bound, as in `#if SHADOWED > 2`. Numbers that a variant does not set are 0.

use crate::gpu::GpuError;

/// Names used in conditions only; they are not declared as override constants in WGSL.
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

/// Names used in conditions that are override constants as well.
const OVERRIDES: [&str; 3] = ["SHADOWED", "NEAR_STEPS", "GATHERED"];

/// Returns true if `name` is passed to the driver as an override constant.
pub(super) fn is_override(name: &str) -> bool {
    !TEXT_ALONE.contains(&name)
}

/// Returns the names of all conditions.
#[cfg(feature = "testing")]
pub fn shader_conditions() -> impl Iterator<Item = &'static str> {
    TEXT_ALONE.into_iter().chain(OVERRIDES)
}

/// Returns the lines of a source whose conditions hold; `value` gives the number of a name.
///
/// # Errors
/// Returns an error if a condition has an unknown name, or if the lines are not balanced.
pub(super) fn chosen(source: &str, value: &dyn Fn(&str) -> f64) -> Result<String, GpuError> {
    let refused = |line: &str| GpuError::Refused(format!("a shader has a line {line:?} that means nothing"));
    // Results of the enclosing conditions, outermost first.
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

/// Evaluates a condition; `None` if it cannot be parsed.
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
