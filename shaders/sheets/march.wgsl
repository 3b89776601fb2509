// March of light through sheets, gathered or scattered (P §3.5, eq. 10): transmittance decreases from slab to slab,
// and a ring of layers stores what each slab will deposit in the light volume.
#import "sheets/sheet_frame.wgsl"
#import "density/cut.wgsl"
#import "common/slab_mean.wgsl"

struct MarchUniform {
    frame: SheetFrameUniform,
    // Range of slabs of this chunk; the end is exclusive.
    begin: u32,
    end: u32,
    // Number of layers in the ring.
    layers: u32,
    // Number of tiles of this dispatch.
    tiles: u32,
    // Factor applied to extinction.
    extinction_scale: f32,
    // Cone of the light, as in shading/lights.wgsl, with its axis in the coordinates of the sheets.
    cone_cos_inner: f32,
    cone_cos_outer: f32,
    // Distance, in cells, from cells visible in either transfer function up to which sheets are read.
    reach: i32,
    cone_axis: vec3f,
    // Minimum transmittance, at which light is no longer followed.
    min_transmittance: f32,
    // Region that attenuates light.
    shading_cut: CutUniform,
}

@group(0) @binding(0) var<uniform> bound_march: MarchUniform;
var<private> march: MarchUniform;
// Transmittance in front of the next slab, per pixel.
@group(0) @binding(3) var<storage, read_write> transmittance: array<f32>;
// Ring with four slabs per texel, which takes a quarter of the stores here, and of the fetches in the
// back-projection.
@group(0) @binding(4) var ring: texture_storage_2d_array<RING_FORMAT, write>;

// Deposits the transmittance in front of the slab, as P eq. 10 reads literally.
override DEPOSIT_FRONT: bool = false;

// Light inside the cone at a pixel: the sheet in front of the first slab.
fn cone_light(pixel: vec2f) -> f32 {
    let slope = march.frame.slope + march.frame.slope_di * pixel.x + march.frame.slope_dj * pixel.y;
    let along = normalize(vec3f(slope, 1.0));
    return smoothstep(march.cone_cos_outer, march.cone_cos_inner, dot(march.cone_axis, along));
}

// Deposit of a slab of optical depth tau, with transmittance t in front of it.
fn slab_deposit(t: f32, tau: f32) -> f32 {
    return select(t * slab_mean_transmittance(tau), t, DEPOSIT_FRONT);
}

// Stores the deposits of the four slabs that share a texel with slab k.
fn store_deposits(pixel: vec2u, k: u32, deposits: vec4f) {
    textureStore(ring, pixel, ring_layer(i32(k / 4u), march.layers), deposits);
}

// Replaces the deposit of slab k.
fn with_deposit(deposits: vec4f, k: u32, deposit: f32) -> vec4f {
    return select(deposits, vec4f(deposit), vec4u(0u, 1u, 2u, 3u) == vec4u(k % 4u));
}

// Replaces the deposits of all slabs behind slab k in its texel.
fn with_deposits_behind(deposits: vec4f, k: u32, deposit: f32) -> vec4f {
    return select(deposits, vec4f(deposit), vec4u(0u, 1u, 2u, 3u) > vec4u(k % 4u));
}
