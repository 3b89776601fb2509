//! Metamorphic tests of the renderer: relations between pictures of random scenes.

mod relations;
mod scenes;
mod small_adapters;
