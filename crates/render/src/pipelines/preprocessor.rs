//! Conditional compilation of shaders (`#if`, `#else`, `#endif`).
//!
//! Drivers inline all functions before they drop what an override constant switches off, and spend seconds on code
//! that never runs; so code that only some variants need is left out of the text.
//!
//! A condition is the name of a variant's number, like that of an override constant, and holds unless the number is
//! 0; or a name and a bound, as in `#if SHADOWED > 2`. Numbers that a variant does not set are 0.
//!
//! Names are declared in the shader that uses them, or in a file that it imports: by `#option NAME: meaning`, or as an
//! override constant.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use super::pipeline_variant::ShaderConstants;
use super::shader_files::SHADERS;
use crate::GpuError;

/// Names of the options that any shader declares.
static OPTIONS: LazyLock<BTreeSet<&str>> =
    LazyLock::new(|| SHADERS.iter().flat_map(|(_, text)| text.lines().filter_map(declared_option)).collect());

/// Options that hold in one shader alone, although files that others import as well have code for them: the name, and the
/// shader with its bindings.
const OPTIONS_OF_ONE_SHADER: [(&str, &str); 1] = [("PAGED", "eye/eye_pass.wgsl")];

/// Returns the number of a condition in a shader, from that of its variant: 0 for the options of another shader.
pub(super) fn value_in_shader(shader: &str, condition: &str, value: &dyn Fn(&str) -> f64) -> f64 {
    let is_foreign = |(name, owner): &(&str, &str)| *name == condition && *owner != shader;
    if OPTIONS_OF_ONE_SHADER.iter().any(is_foreign) { 0.0 } else { value(condition) }
}

/// Names of the override constants that any shader declares.
static OVERRIDES: LazyLock<BTreeSet<&str>> = LazyLock::new(|| {
    SHADERS.iter().flat_map(|(_, text)| text.lines().filter_map(declared_override)).collect()
});

/// Returns the constants that are passed to the driver, without those that only decide conditions.
///
/// # Errors
/// Returns an error if no shader declares a constant.
pub(super) fn override_constants(constants: &[(&'static str, f64)]) -> Result<ShaderConstants, GpuError> {
    let is_known = |name| OPTIONS.contains(name) || OVERRIDES.contains(name);
    if let Some((unknown, _)) = constants.iter().find(|(name, _)| !is_known(*name)) {
        return Err(GpuError::Internal(format!("no shader declares the option {unknown}")));
    }
    Ok(constants.iter().filter(|(name, _)| !OPTIONS.contains(name)).copied().collect())
}

/// Returns the names of all conditions, each once.
#[cfg(feature = "testing")]
pub fn shader_conditions() -> impl Iterator<Item = &'static str> {
    let conditions =
        SHADERS.iter().flat_map(|(_, text)| text.lines().filter_map(|line| line.strip_prefix("#if ")));
    let used = conditions.map(|condition| split_bound(condition).0);
    used.chain(OPTIONS.iter().copied()).collect::<BTreeSet<_>>().into_iter()
}

/// Returns the name that a line `#option NAME: meaning` declares.
fn declared_option(line: &str) -> Option<&str> {
    let (name, meaning) = line.strip_prefix("#option ")?.split_once(": ")?;
    let is_name = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
    (!name.is_empty() && name.chars().all(is_name) && !meaning.trim().is_empty()).then_some(name)
}

/// Returns the name of the override constant that a line declares.
fn declared_override(line: &str) -> Option<&str> {
    line.strip_prefix("override ")?.split_once(':').map(|(name, _)| name)
}

/// Returns the lines of a source whose conditions hold, without declarations of options; `value` gives the number of
/// a name.
///
/// # Errors
/// Returns an error if the source does not declare the name of a condition, declares an option twice, or has lines
/// that are not balanced.
pub(super) fn preprocess(source: &str, value: &dyn Fn(&str) -> f64) -> Result<String, GpuError> {
    let invalid = |line: &str| GpuError::Internal(format!("a shader has an invalid line {line:?}"));
    let mut declared: BTreeSet<_> = source.lines().filter_map(declared_override).collect();
    for line in source.lines().filter(|line| line.starts_with("#option")) {
        let is_new = declared_option(line).is_some_and(|name| declared.insert(name));
        if !is_new {
            return Err(invalid(line));
        }
    }
    // Results of the enclosing conditions, outermost first.
    let mut enclosing = Vec::new();
    let mut lines = String::with_capacity(source.len());
    for line in source.lines().filter(|line| !line.starts_with("#option ")) {
        if let Some(condition) = line.strip_prefix("#if ") {
            enclosing.push(evaluate(condition, &declared, value).ok_or_else(|| invalid(line))?);
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

/// Splits a condition into its name and the bound above which it holds, if it has one.
fn split_bound(condition: &str) -> (&str, Option<&str>) {
    condition.split_once(" > ").map_or((condition, None), |(name, bound)| (name, Some(bound)))
}

/// Evaluates a condition; `None` if it cannot be parsed or has a name that is not declared.
fn evaluate(condition: &str, declared: &BTreeSet<&str>, value: &dyn Fn(&str) -> f64) -> Option<bool> {
    let (name, bound) = split_bound(condition);
    let bound = bound.map_or(Some(0.0), |bound| bound.parse().ok())?;
    declared.contains(name).then(|| value(name) > bound)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECLARATIONS: &str = "#option FACES: faces are visible\noverride SHADOWED: u32 = 1u;\n";

    #[test]
    fn parts_are_there_whose_conditions_hold() {
        let source = format!(
            "{DECLARATIONS}a\n#if FACES\nb\n#if SHADOWED > 1\nc\n#else\nd\n#endif\n#else\ne\n#endif\nf"
        );
        let with = |faces: f64, shadowed: f64| {
            let value = |name: &str| if name == "FACES" { faces } else { shadowed };
            let lines = preprocess(&source, &value).unwrap();
            lines.lines().filter(|line| line.len() == 1).collect::<String>()
        };
        assert_eq!([with(1.0, 2.0), with(1.0, 1.0), with(0.0, 2.0)], ["abcf", "abdf", "aef"]);
    }

    #[test]
    fn lines_that_mean_nothing_are_refused() {
        for wrong in [
            "#if FACE\n#endif",
            "#if SHADOWED > many\n#endif",
            "#if FACES",
            "#endif",
            "#else",
            "#fi",
            "#option FACES: declared twice",
            "#option SHADOWED: an override constant as well",
            "#option CORNERS",
            "#option corners: in small letters",
        ] {
            assert!(preprocess(&format!("{DECLARATIONS}{wrong}"), &|_| 1.0).is_err(), "{wrong:?}");
        }
        assert!(
            preprocess("#if FACES\n#endif", &|_| 1.0).is_err(),
            "a condition that the source does not declare"
        );
    }

    #[test]
    fn options_are_not_passed_to_the_driver() {
        let passed = override_constants(&[("MISSING", 1.0), ("KERNEL", 2.0)]).unwrap();
        assert_eq!(passed, [("KERNEL", 2.0)]);
        let err = override_constants(&[("KERNEL", 2.0), ("KERNELS", 2.0)]).unwrap_err();
        assert!(err.to_string().contains("KERNELS"), "{err}");
    }
}
