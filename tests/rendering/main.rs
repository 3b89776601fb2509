//! Tests of the renderer on a graphics adapter: against the f64 reference and against closed forms.
//!
//! Without an adapter they fail: a check that did not run must be seen.

#![expect(clippy::print_stdout, reason = "what was measured, for whoever reads the log of a failure")]

mod against_reference;
mod caching;
mod closed_form;
mod common;
mod compare;
mod metamorphic;
mod output;
mod pages;
mod path_tracing;
mod scenes;
mod settings;
mod surfaces;
mod thresholds;
