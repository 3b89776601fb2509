//! Check that every shader is valid for every storage format, and needs no optional capability.

use std::fmt::Write as _;

use chiaroscuro_render::ShaderLibrary;
use wgpu::TextureFormat;

use crate::sources::{FORMATS, entry_shaders, shader_source, validate_shader, variants};

#[test]
fn every_shader_is_valid_for_both_storage_formats() {
    let mut failures = String::new();
    for name in entry_shaders() {
        for format in FORMATS {
            for (what, source) in variants(name, format, format) {
                if let Err(err) = validate_shader(&source) {
                    let line = writeln!(failures, "{name} with {format:?}, {what}:\n{err}");
                    line.expect("strings can be written to");
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(entry_shaders().len() >= 6, "the check must see the passes: {:?}", entry_shaders());
}

#[test]
fn storage_formats_reach_the_shader() {
    for (format, wgsl) in [(TextureFormat::R16Float, "r16float"), (TextureFormat::R32Float, "r32float")] {
        let source = ShaderLibrary::source("sky/sweep.wgsl", format, format).expect("the shader is there");
        assert!(source.contains(&format!("texture_storage_3d<{wgsl}, write>")), "{format:?}");
        assert!(!source.contains("STORAGE_FORMAT"), "{format:?}");
    }
}

#[test]
fn broken_shaders_are_reported() {
    let source = shader_source("output/display.wgsl");
    assert!(validate_shader(&source).is_ok());
    for (from, to, what) in [
        ("let w = 1.0 - SHOULDER;", "let w = 1.0 - SHOULDERS;", "an unknown name"),
        ("let w = 1.0 - SHOULDER;", "let w = 1.0 - SHOULDER", "a missing semicolon"),
        ("let w = 1.0 - SHOULDER;", "let w = 1u - SHOULDER;", "a mix of types"),
        ("@group(0) @binding(1)", "@group(0) @binding(0)", "two things in one binding"),
    ] {
        assert!(source.contains(from), "{from}");
        assert!(validate_shader(&source.replace(from, to)).is_err(), "{what} must be noticed");
    }
}
