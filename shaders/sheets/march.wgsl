// The march of light through sheets, however these were filled (P §3.5, eq. 10): from slab to slab the
// transmittance falls, and each keeps in a ring of layers what it will deposit in the light volume.
#import "sheets/sheet_frame.wgsl"
#import "density/cut.wgsl"
#import "common/slab_mean.wgsl"

struct March {
    frame: SheetFrame,
    // Slabs of this chunk: first, and one beyond the last.
    begin: u32,
    end: u32,
    // Of the ring.
    layers: u32,
    // Tiles of this dispatch.
    tiles: u32,
    // Multiplies extinctions.
    extinction_scale: f32,
    // The light's hood, as in shading/lights.wgsl, its axis along the sheets' axes.
    hood_inner: f32,
    hood_outer: f32,
    // Cells beyond those that either transfer function shows in which light is looked up or read for it.
    reach: i32,
    hood_axis: vec3f,
    // Light is followed until less than this is left of it.
    dark: f32,
    // What attenuates light.
    shading_cut: Cut,
}

@group(0) @binding(0) var<uniform> bound_march: March;
var<private> march: March;
// Transmittance in front of the next slab, per pixel.
@group(0) @binding(3) var<storage, read_write> transmittance: array<f32>;
// Four slabs to a texel: a quarter of the stores here, and of the fetches behind.
@group(0) @binding(4) var ring: texture_storage_2d_array<RING_FORMAT, write>;

// P eq. 10 read literally takes the transmittance in front of the slab.
override DEPOSIT_FRONT: bool = false;

// What the hood lets through to a pixel: the sheet in front of the first slab.
fn unattenuated(pixel: vec2f) -> f32 {
    let slope = march.frame.slope + march.frame.slope_di * pixel.x + march.frame.slope_dj * pixel.y;
    let along = normalize(vec3f(slope, 1.0));
    return smoothstep(march.hood_outer, march.hood_inner, dot(march.hood_axis, along));
}

// What a slab of optical depth tau deposits, with the transmittance t in front of it.
fn deposited(t: f32, tau: f32) -> f32 {
    return select(t * slab_mean(tau), t, DEPOSIT_FRONT);
}

// Keeps what four slabs deposit, of which slab k is one.
fn keep(pixel: vec2u, k: u32, deposits: vec4f) {
    textureStore(ring, pixel, in_ring(i32(k / 4u), march.layers), deposits);
}

// Deposits with that of slab k replaced.
fn with_deposit(deposits: vec4f, k: u32, deposit: f32) -> vec4f {
    return select(deposits, vec4f(deposit), vec4u(0u, 1u, 2u, 3u) == vec4u(k % 4u));
}

// The same for all slabs of the texel behind slab k.
fn with_deposits_behind(deposits: vec4f, k: u32, deposit: f32) -> vec4f {
    return select(deposits, vec4f(deposit), vec4u(0u, 1u, 2u, 3u) > vec4u(k % 4u));
}
