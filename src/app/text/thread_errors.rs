//! Error texts of background threads that fail.

/// Error of a thread that ended without a result.
pub(crate) const NO_RESULT: &str = "the thread ended without a result";
/// Text in place of the message of a panic without one.
pub(crate) const NO_REASON: &str = "an internal error without a message";
