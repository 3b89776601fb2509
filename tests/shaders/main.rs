//! Tests of the shaders without a GPU: every shader is valid, and agrees with the Rust code about structs, constants
//! and sizes.

mod bindings;
mod constants;
mod driver_rules;
mod imports;
mod layouts;
mod options;
mod sources;
mod struct_layout;
mod structs;
mod validity;
mod voxel_access;
