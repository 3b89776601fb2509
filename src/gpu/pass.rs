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

/// In which steps the rows of tiles are taken. A software driver gives each thread a run of workgroups: so
/// that all have the same share of what is costly, neighbouring rows are far apart there. Graphics cards
/// hand workgroups out one by one, and neighbours share what they read.
pub(super) fn row_stride(context: &Context, [_, rows, _]: [u32; 3]) -> u32 {
    if context.is_software() { spread(rows) } else { 1 }
}

/// A step near the golden section of `count` without a common divisor: multiples of it, modulo `count`, are
/// all numbers below, and evenly spread at any time.
fn spread(count: u32) -> u32 {
    let golden = (f64::from(count) * 0.618) as u32;
    (golden.max(1)..count).find(|&step| gcd(step, count) == 1).unwrap_or(1)
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_all_taken_once_and_halves_get_the_same_share() {
        for count in 1..300u32 {
            let stride = spread(count);
            let rows: Vec<u32> = (0..count).map(|row| row * stride % count).collect();
            let mut sorted = rows.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().zip(0..).all(|(&row, at)| row == at), "{count}");
            // Rows of the upper half in the first half of the workgroups.
            let upper = rows[..count as usize / 2].iter().filter(|&&row| row < count / 2).count();
            assert!(count < 16 || (upper as f64 / f64::from(count) - 0.25).abs() < 0.1, "{count}: {upper}");
        }
    }
}
