//! The pieces of a filling, in order.

/// A piece of the filling.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BounceStep {
    /// What light meets.
    Blocks,
    /// A batch of directions in which light is followed, and whose.
    Batch(Followed, usize),
    /// What unscattered light makes blocks give off, from a slice of them on.
    First { slice: usize },
    /// What so many bounces make them give off for the next.
    Source { bounce: u32 },
    /// What all bounces have brought.
    Outcome,
}

/// Whose light is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Followed {
    /// A sky's.
    Sky,
    /// What blocks give off, for what it makes them give off in turn.
    Bounce,
    /// The same for the last time, in more directions: what is seen.
    Last,
}

/// The pieces of a filling with so many bounces, of so many slices of blocks of which some cast rays to lights at once; light is
/// followed in so many batches.
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
