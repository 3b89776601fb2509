//! Tests of FITS voxel spacing: degrees, lengths, spectra, matrices.

use glam::DVec3;

use super::loaded;
use super::writer::TestUnit;

/// World coordinate of an axis: type, unit and step.
#[derive(Clone, Copy)]
struct WorldAxis<'a> {
    kind: &'a str,
    unit: &'a str,
    step: f64,
}

fn axis<'a>(kind: &'a str, unit: &'a str, step: f64) -> WorldAxis<'a> {
    WorldAxis { kind, unit, step }
}

/// A cube whose axes have these world coordinates.
fn cube(axes: [WorldAxis<'_>; 3]) -> TestUnit {
    let mut unit = TestUnit::primary(8, &[2, 2, 2], (0..8).collect());
    for (at, WorldAxis { kind, unit: name, step }) in (1..).zip(axes) {
        unit = unit.with(&format!("CTYPE{at}"), format!("'{kind}'")).with(&format!("CDELT{at}"), step);
        if !name.is_empty() {
            unit = unit.with(&format!("CUNIT{at}"), format!("'{name}'"));
        }
    }
    unit
}

/// True if two spacings are equal within rounding.
fn is_near(found: DVec3, expected: DVec3) -> bool {
    (found - expected).abs().max_element() < 1e-9
}

#[test]
fn degrees_compare_and_are_no_lengths() {
    let sky = [axis("RA---SIN", "", -0.002), axis("DEC--SIN", "deg", 0.004), axis("FREQ", "Hz", 1e6)];
    let volume = loaded(&cube(sky));
    assert!(is_near(volume.spacing_mm(), DVec3::new(1.0, 2.0, 1.0)), "{}", volume.spacing_mm());
    assert!(volume.has_unknown_scale());
    let said = volume.remarks().join("; ");
    assert!(said.contains("axis 3 (FREQ, in hz)") && said.contains("degrees"), "{said}");
    let arcseconds =
        [axis("GLON-CAR", "arcsec", 7.2), axis("GLAT-CAR", "deg", 0.001), axis("", "deg", 0.004)];
    let volume = loaded(&cube(arcseconds));
    assert!(is_near(volume.spacing_mm(), DVec3::new(2.0, 1.0, 4.0)), "{}", volume.spacing_mm());
    assert!(volume.remarks().is_empty());
}

#[test]
fn a_spectrum_may_be_the_first_axis_and_wavelengths_are_no_lengths() {
    let first = [axis("VELO-LSR", "m/s", 500.0), axis("RA---SIN", "deg", -0.1), axis("DEC--SIN", "deg", 0.3)];
    let volume = loaded(&cube(first));
    assert!(is_near(volume.spacing_mm(), DVec3::new(1.0, 1.0, 3.0)), "{}", volume.spacing_mm());
    assert!(volume.remarks()[0].contains("axis 1 (VELO-LSR"), "{:?}", volume.remarks());
    let waves = [axis("", "mm", 0.5), axis("", "mm", 0.25), axis("WAVE", "m", 1e-9)];
    let volume = loaded(&cube(waves));
    assert!(is_near(volume.spacing_mm(), DVec3::new(0.5, 0.25, 0.25)), "{}", volume.spacing_mm());
    assert!(!volume.has_unknown_scale() && volume.remarks().len() == 1);
}

#[test]
fn lengths_are_millimetres() {
    for (name, mm) in [("m", 1e3), ("cm", 10.0), ("mm", 1.0), ("um", 1e-3), ("nm", 1e-6)] {
        let volume = loaded(&cube([axis("", name, 2.0), axis("", name, 2.0), axis("", name, 6.0)]));
        assert!(is_near(volume.spacing_mm() / mm, DVec3::new(2.0, 2.0, 6.0)), "{name}");
        assert!(!volume.has_unknown_scale());
    }
    // Kiloparsecs are longer than a scene can be.
    let far = loaded(&cube([axis("", "kpc", 2.0), axis("", "kpc", 2.0), axis("", "kpc", 6.0)]));
    assert!(is_near(far.spacing_mm(), DVec3::new(1.0, 1.0, 3.0)) && far.has_unknown_scale());
}

#[test]
fn matrices_say_how_long_steps_are() {
    let plain = TestUnit::primary(8, &[2, 2, 2], (0..8).collect());
    // A rotation by 30°, with steps of 0.1 and 0.2.
    let (sine, cosine) = 30f64.to_radians().sin_cos();
    let sky = plain.with("CTYPE1", "'RA---TAN'").with("CTYPE2", "'DEC--TAN'").with("CTYPE3", "'FREQ'");
    let turned = sky
        .clone()
        .with("CD1_1", -0.1 * cosine)
        .with("CD2_1", 0.1 * sine)
        .with("CD1_2", 0.2 * sine)
        .with("CD2_2", 0.2 * cosine)
        .with("CD3_3", 5e6);
    let volume = loaded(&turned);
    assert!(is_near(volume.spacing_mm(), DVec3::new(1.0, 2.0, 1.0)), "{}", volume.spacing_mm());
    let turned = sky
        .with("CDELT1", -0.1)
        .with("CDELT2", 0.1)
        .with("CDELT3", 5e6)
        .with("PC1_1", 2.0 * cosine)
        .with("PC2_1", -2.0 * sine)
        .with("PC1_2", sine)
        .with("PC2_2", cosine);
    let volume = loaded(&turned);
    assert!(is_near(volume.spacing_mm(), DVec3::new(2.0, 1.0, 1.0)), "{}", volume.spacing_mm());
}

#[test]
fn steps_that_cannot_be_are_mended() {
    for (step, expected) in [(0.0, 1.0), (-3.0, 3.0)] {
        let volume = loaded(&cube([axis("", "", 1.0), axis("", "", 1.0), axis("", "", step)]));
        assert!(is_near(volume.spacing_mm(), DVec3::new(1.0, 1.0, expected)), "{}", volume.spacing_mm());
    }
    let unlike = loaded(&cube([axis("", "deg", 1.0), axis("", "deg", 1e-12), axis("", "deg", 1.0)]));
    assert!(is_near(unlike.spacing_mm(), DVec3::ONE) && !unlike.remarks().is_empty());
}
