//! Effects of single settings on a picture: combined lights, cuts, the floor, stretched kernels, shadow algorithms.

mod clipping;
mod combine;
mod floor;
mod layers;
mod narrow_peaks;
mod near_field;
mod phantom;
mod render_modes;
mod shadow_algorithms;
mod shape_cuts;
mod stretched_kernels;
mod surface_sides;
