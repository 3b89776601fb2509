//! Steps of filling a volume of scattered light, in order.

/// Step of filling a volume of scattered light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BounceStep {
    /// Computes extinction and scattering of the blocks.
    Blocks,
    /// Sweeps a batch of directions, given by its index.
    Batch(Followed, usize),
    /// Computes the light that blocks scatter directly from the lights and the sky, for slices from `slice` on.
    First { slice: usize },
    /// Computes the light that blocks scatter after this number of bounces.
    Source { bounce: u32 },
    /// Stores the result: the light that arrives with the last bounce.
    Outcome,
}

/// Light that a sweep follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Followed {
    /// Light that arrives from the sky.
    Sky,
    /// Light scattered by blocks, gathered as the source of the next bounce.
    Bounce,
    /// Light scattered by blocks for the last time, in more directions: the result.
    Last,
}

/// Returns the steps for a number of bounces. `slices` is the number of slices of blocks, of which `at_once` cast
/// rays to lights in one step; `batches` gives the number of batches of a sweep.
pub(super) fn steps(
    bounces: u32,
    has_sky: bool,
    (slices, at_once): (usize, usize),
    batches: impl Fn(Followed) -> usize,
) -> Vec<BounceStep> {
    let of = |followed| (0..batches(followed)).map(move |batch| BounceStep::Batch(followed, batch));
    let mut steps = vec![BounceStep::Blocks];
    if has_sky {
        steps.extend(of(Followed::Sky));
    }
    steps.extend((0..slices).step_by(at_once).map(|slice| BounceStep::First { slice }));
    for bounce in 0..bounces {
        steps.push(BounceStep::Source { bounce });
        let is_last = bounce + 1 == bounces;
        steps.extend(of(if is_last { Followed::Last } else { Followed::Bounce }));
    }
    steps.push(BounceStep::Outcome);
    steps
}
