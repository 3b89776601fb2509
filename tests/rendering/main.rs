//! Tests of the renderer on a graphics adapter: against the f64 reference and against closed forms.
//!
//! Without an adapter they fail: a check that did not run must be seen.

#![expect(clippy::print_stdout, reason = "what was measured, for whoever reads the log of a failure")]

mod bands;
mod caching;
mod closed_form;
mod combine;
mod common;
mod compare;
mod cuts;
mod floor;
mod gpu_vs_reference;
mod mutations;
mod preview;
mod reduced;
mod scatter;
mod scenes;
mod stretch;
mod thresholds;
mod variants;
mod window;
