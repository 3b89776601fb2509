//! What all tests of the command line share: the program in a folder, and small volumes.

pub(crate) mod program;
pub(crate) mod volumes;
