//! What every compute pass is made of: bind groups, and a dispatch.

use super::Context;

/// Binds resources to a group of a pipeline.
pub(super) fn bind(
    context: &Context,
    label: &str,
    pipeline: &wgpu::ComputePipeline,
    group: u32,
    entries: &[wgpu::BindGroupEntry<'_>],
) -> wgpu::BindGroup {
    context.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &pipeline.get_bind_group_layout(group),
        entries,
    })
}

/// Records a pass of one dispatch; the groups are bound in their order.
pub(super) fn dispatch(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &wgpu::ComputePipeline,
    groups: &[&wgpu::BindGroup],
    [x, y, z]: [u32; 3],
) {
    let mut pass = encoder
        .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None });
    pass.set_pipeline(pipeline);
    for (group, bound) in (0..).zip(groups) {
        pass.set_bind_group(group, *bound, &[]);
    }
    pass.dispatch_workgroups(x, y, z);
}

/// Workgroups of 8 × 8 that cover a sheet or a picture.
pub(super) fn tiles([width, height]: [u32; 2]) -> [u32; 3] {
    [width.div_ceil(8), height.div_ceil(8), 1]
}
