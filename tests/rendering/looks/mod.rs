//! What single settings do to a picture: combined lights, cuts, the floor, far away, other algorithms.

mod collapse;
mod cuts;
mod ground;
mod stretch;
mod variants;
