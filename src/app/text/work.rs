//! Work on other threads that ends badly.

/// It ended and said nothing.
pub(crate) const NO_RESULT: &str = "the thread ended without a result";
/// What stands for the message of a panic that has none.
pub(crate) const NO_REASON: &str = "for no stated reason";
