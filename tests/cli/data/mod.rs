//! Tests of volume data on the command line: facts and corrections.

mod corrections;
mod info;
