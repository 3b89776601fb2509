//! Growth of a light volume's cost with the volume's edge N. The paper's O(N³) for splatting and O(N⁴) for rays hold
//! without skipping; with brick skipping and early ray termination both grow less.

use serde_json::{Value, json};

use super::report::{CaseTimings, round_to_microsecond};
use crate::cli::CliError;
use chiaroscuro_render::{GpuContext, RenderOptions, Renderer, ShaderLibrary, TestSwitches, WorkOptions};
use chiaroscuro_scene::{LightSimplification, ShadowAlgorithm, first_look};
use chiaroscuro_volume::{Dataset, synthetic};

/// Numbers of voxels along each axis of the test clouds.
const SIZES: [usize; 4] = [64, 128, 256, 512];

/// Largest cloud for ray casting: the next would take a software adapter an hour.
const LARGEST_FOR_RAYS: usize = 256;

/// Time limit after which a size gets no more frames, in seconds: rays through 256³ voxels without skipping take a
/// software adapter minutes.
const TIME_LIMIT_S: f64 = 20.0;

/// Optimisations that are enabled in a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Optimizations {
    /// Brick skipping, early ray termination, and filling only the voxels that the picture looks up.
    All,
    /// No optimisation: every sample of every ray, every voxel.
    None,
}

/// Times light volumes of clouds, filled by both algorithms.
pub(super) fn run(
    context: &GpuContext,
    frames: usize,
    cases: &mut Vec<Value>,
    ratios: &mut serde_json::Map<String, Value>,
) -> Result<(), CliError> {
    let shaders = ShaderLibrary::new(context);
    let mut builds: [Vec<f64>; COMBINATIONS.len()] = Default::default();
    for n in SIZES {
        let loaded = Dataset::new(synthetic::builtin("cloud", Some(n))?);
        for ((algorithm, savings), builds) in COMBINATIONS.into_iter().zip(&mut builds) {
            if algorithm == ShadowAlgorithm::Raycast && n > LARGEST_FOR_RAYS {
                continue;
            }
            let renderer = Renderer::with_shaders(context, shaders.clone())?;
            let samples = light_builds(renderer, &loaded, algorithm, savings, frames, builds.is_empty())?;
            builds.push(samples.light_build());
            let mut case = json!({
                "name": format!("growth-{}", label(algorithm, savings)),
                "volume": loaded.volume().name(),
                "dims": loaded.volume().dims(),
                "light_volume_ms": round_to_microsecond(samples.light_build()),
            });
            if let (Value::Object(case), Value::Object(timings)) = (&mut case, samples.json()) {
                case.extend(timings);
            }
            cases.push(case);
        }
    }
    for ((algorithm, savings), builds) in COMBINATIONS.into_iter().zip(&builds) {
        let label = label(algorithm, savings);
        for (pair, n) in builds.windows(2).zip(&SIZES[1..]) {
            ratios.insert(
                format!("{label}_{n}_over_{}", n / 2),
                json!(round_to_microsecond(pair[1] / pair[0])),
            );
        }
        ratios.insert(format!("{label}_exponent"), json!(round_to_microsecond(exponent(builds))));
    }
    for (pair, ways) in builds.chunks_exact(2).zip(COMBINATIONS.chunks_exact(2)) {
        for ((splat, raycast), n) in pair[0].iter().zip(&pair[1]).zip(SIZES) {
            let label = label(ShadowAlgorithm::Raycast, ways[0].1);
            ratios.insert(format!("{label}_over_splat_{n}"), json!(round_to_microsecond(raycast / splat)));
        }
    }
    Ok(())
}

/// Compared combinations: pairs of splatting and ray casting.
const COMBINATIONS: [(ShadowAlgorithm, Optimizations); 4] = [
    (ShadowAlgorithm::Splat, Optimizations::All),
    (ShadowAlgorithm::Raycast, Optimizations::All),
    (ShadowAlgorithm::Splat, Optimizations::None),
    (ShadowAlgorithm::Raycast, Optimizations::None),
];

fn label(algorithm: ShadowAlgorithm, savings: Optimizations) -> String {
    let name = if algorithm == ShadowAlgorithm::Splat { "splat" } else { "raycast" };
    let savings = if savings == Optimizations::All { "skipping" } else { "everything" };
    format!("{name}_{savings}")
}

/// Fills the light volume of a cloud's first look repeatedly, with the light turned each time.
fn light_builds(
    mut renderer: Renderer,
    loaded: &Dataset,
    algorithm: ShadowAlgorithm,
    savings: Optimizations,
    frames: usize,
    compiles: bool,
) -> Result<CaseTimings, CliError> {
    let first = first_look::first_settings(loaded.volume(), loaded.histogram());
    let mut settings = LightSimplification::ALL.apply(&first);
    settings.shadows.algorithm = algorithm;
    // The picture is irrelevant here, but requests the light volume.
    let size = [64; 2];
    let mut options = RenderOptions::from(WorkOptions { timed: true, ..WorkOptions::default() });
    if savings == Optimizations::None {
        options.work.fill_all_light_voxels = true;
        options.switches =
            TestSwitches { empty_space_skipping: false, min_transmittance: 0.0, ..TestSwitches::default() };
    }
    let warm_up = usize::from(compiles);
    let mut samples = CaseTimings::default();
    let start = std::time::Instant::now();
    for frame in 0..warm_up + frames.max(1) {
        if let Some(light) = settings.lights.first_mut() {
            let turn = glam::DQuat::from_rotation_z(super::STEP_DEG.to_radians());
            light.position = (turn * glam::DVec3::from(light.position)).into();
        }
        let mut draw = || {
            renderer.draw(loaded, &settings, size, &options)?;
            Ok::<_, CliError>(renderer.report().clone())
        };
        if frame < warm_up {
            draw()?;
        } else {
            samples.time(draw)?;
        }
        if frame >= warm_up && start.elapsed().as_secs_f64() > TIME_LIMIT_S {
            break;
        }
    }
    Ok(samples)
}

/// Returns the slope of log₂(milliseconds) over doublings of the size, by least squares; 0 for fewer than two sizes.
fn exponent(builds: &[f64]) -> f64 {
    let count = builds.len() as f64;
    if builds.len() < 2 {
        return 0.0;
    }
    let middle = (count - 1.0) / 2.0;
    let (mut sum, mut weight) = (0.0, 0.0);
    for (at, ms) in builds.iter().enumerate() {
        let x = at as f64 - middle;
        sum += x * ms.log2();
        weight += x * x;
    }
    sum / weight
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents() {
        assert!((exponent(&[1.0, 8.0, 64.0]) - 3.0).abs() < 1e-12);
        assert!((exponent(&[5.0, 80.0]) - 4.0).abs() < 1e-12);
        assert_eq!(exponent(&[5.0]), 0.0);
    }
}
