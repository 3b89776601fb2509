// Copy of the accumulated rays into the picture.
#import "scatter/slab.wgsl"

@group(0) @binding(0) var<storage, read> rays: array<vec4f>;
@group(0) @binding(1) var picture: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    scatter = bound_scatter;
    if (all(id.xy < scatter.frame.size)) {
        textureStore(picture, id.xy, rays[id.y * scatter.frame.size.x + id.x]);
    }
}
