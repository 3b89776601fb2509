//! Conditional compilation of shaders (`#if`, `#else`, `#endif`).
//!
//! Drivers inline all functions before they drop what an override constant switches off, and spend seconds on code
//! that never runs; so code that only some variants need is left out of the text.
//!
//! A condition is the name of a variant's number, like that of an override constant, and holds unless the number is
//! 0; or a name and a bound, as in `#if SHADOWED > 2`. Numbers that a variant does not set are 0.

use crate::GpuError;

/// Names used in conditions only; they are not declared as override constants in WGSL.
const CONDITIONS_ONLY: [&str; 12] = [
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
const OVERRIDE_CONDITIONS: [&str; 3] = ["SHADOWED", "NEAR_STEPS", "EXTINCTION_CHANNEL"];

/// Returns true if `name` is passed to the driver as an override constant.
pub(super) fn is_override(name: &str) -> bool {
    !CONDITIONS_ONLY.contains(&name)
}

/// Returns the names of all conditions.
#[cfg(feature = "testing")]
pub fn shader_conditions() -> impl Iterator<Item = &'static str> {
    CONDITIONS_ONLY.into_iter().chain(OVERRIDE_CONDITIONS)
}

/// Returns the lines of a source whose conditions hold; `value` gives the number of a name.
///
/// # Errors
/// Returns an error if a condition has an unknown name, or if the lines are not balanced.
pub(super) fn preprocess(source: &str, value: &dyn Fn(&str) -> f64) -> Result<String, GpuError> {
    let invalid = |line: &str| GpuError::Internal(format!("a shader has an invalid line {line:?}"));
    // Results of the enclosing conditions, outermost first.
    let mut enclosing = Vec::new();
    let mut lines = String::with_capacity(source.len());
    for line in source.lines() {
        if let Some(condition) = line.strip_prefix("#if ") {
            enclosing.push(evaluate(condition, value).ok_or_else(|| invalid(line))?);
        } else if line == "#else" {
            let last = enclosing.last_mut().ok_or_else(|| invalid(line))?;
            *last = !*last;
        } else if line == "#endif" {
            enclosing.pop().ok_or_else(|| invalid(line))?;
        } else if line.starts_with('#') {
            return Err(invalid(line));
        } else if enclosing.iter().all(|holds| *holds) {
            lines.push_str(line);
            lines.push('\n');
        }
    }
    if enclosing.is_empty() { Ok(lines) } else { Err(invalid("#if without #endif")) }
}

/// Evaluates a condition; `None` if it cannot be parsed.
fn evaluate(condition: &str, value: &dyn Fn(&str) -> f64) -> Option<bool> {
    let (name, bound) = match condition.split_once(" > ") {
        Some((name, bound)) => (name, bound.parse().ok()?),
        None => (condition, 0.0),
    };
    let is_known = CONDITIONS_ONLY.contains(&name) || OVERRIDE_CONDITIONS.contains(&name);
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
            preprocess(source, &value).unwrap().replace('\n', "")
        };
        assert_eq!([with(1.0, 2.0), with(1.0, 1.0), with(0.0, 2.0)], ["abcf", "abdf", "aef"]);
    }

    #[test]
    fn lines_that_mean_nothing_are_refused() {
        for wrong in ["#if FACE", "#if SHADOWED > many\n#endif", "#if FACES", "#endif", "#else", "#fi"] {
            assert!(preprocess(wrong, &|_| 1.0).is_err(), "{wrong:?}");
        }
    }
}
