//! Steps of filling a volume of scattered light, in order.

/// Step of filling a volume of scattered light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ScatteringStep {
    /// Computes extinction and scattering of the blocks.
    Blocks,
    /// Sweeps a batch of directions, given by its index.
    Batch(SweepSource, usize),
    /// Computes the light that blocks scatter directly from the lights and the sky, for slices from `slice` on.
    SingleScattering { slice: usize },
    /// Computes the light that blocks scatter after this number of bounces.
    Emission { bounce: u32 },
    /// Stores the result: the light that arrives with the last bounce.
    Result,
}

/// Light that a sweep follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SweepSource {
    /// Light that arrives from the sky.
    Sky,
    /// Light scattered by blocks, gathered as the source of the next bounce.
    Bounce,
    /// Light scattered by blocks for the last time, in more directions: the result.
    LastBounce,
}

/// Returns the steps for a number of bounces. `slices` is the number of slices of blocks, of which `at_once` cast
/// rays to lights in one step; `batches` gives the number of batches of a sweep.
pub(super) fn scattering_steps(
    bounces: u32,
    has_sky: bool,
    slices: usize,
    at_once: usize,
    batches: impl Fn(SweepSource) -> usize,
) -> Vec<ScatteringStep> {
    let batch_steps =
        |followed| (0..batches(followed)).map(move |batch| ScatteringStep::Batch(followed, batch));
    let mut steps = vec![ScatteringStep::Blocks];
    if has_sky {
        steps.extend(batch_steps(SweepSource::Sky));
    }
    steps.extend((0..slices).step_by(at_once).map(|slice| ScatteringStep::SingleScattering { slice }));
    for bounce in 0..bounces {
        steps.push(ScatteringStep::Emission { bounce });
        let is_last = bounce + 1 == bounces;
        steps.extend(batch_steps(if is_last { SweepSource::LastBounce } else { SweepSource::Bounce }));
    }
    steps.push(ScatteringStep::Result);
    steps
}
