//! What every compute pass is made of: bind groups, and a dispatch.

use crate::gpu::Context;
use crate::gpu::pipelines::binding::{Named, Pipeline};

/// Binds resources to a group of a pipeline.
pub(crate) fn bind(
    context: &Context,
    label: &str,
    pipeline: &Pipeline,
    group: usize,
    named: &[Named<'_>],
) -> wgpu::BindGroup {
    let group = &pipeline.groups[group];
    context.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &group.layout,
        entries: &group.entries(named),
    })
}

/// Records a pass of one dispatch; the groups are bound in their order.
pub(crate) fn dispatch(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &Pipeline,
    groups: &[&wgpu::BindGroup],
    [x, y, z]: [u32; 3],
) {
    let mut pass = encoder
        .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None });
    pass.set_pipeline(&pipeline.raw);
    for (group, bound) in (0..).zip(groups) {
        pass.set_bind_group(group, *bound, &[]);
    }
    pass.dispatch_workgroups(x, y, z);
}

/// Workgroups of 8 × 8 that cover a sheet or a picture.
pub(crate) fn tiles([width, height]: [u32; 2]) -> [u32; 3] {
    [width.div_ceil(8), height.div_ceil(8), 1]
}

/// Into how many runs the rows of tiles are sorted (`sheets/tiles.wgsl`). A software driver gives each thread a
/// run of workgroups: there as many as threads, so that all have the same share of what is costly. Graphics
/// cards hand workgroups out one by one, in their order.
pub(crate) fn runs(context: &Context, [_, rows, _]: [u32; 3]) -> u32 {
    threads(context).min(rows.max(1))
}

/// Threads of a software driver; 1 for a graphics card.
pub(crate) fn threads(context: &Context) -> u32 {
    let threads = || std::thread::available_parallelism().map_or(1, |threads| threads.get() as u32);
    if context.is_software() { threads() } else { 1 }
}

#[cfg(test)]
mod tests {
    /// As in the shader.
    fn row(group: u32, rows: u32, runs: u32) -> u32 {
        let (each, longer) = (rows / runs, rows % runs);
        let of_longer = longer * (each + 1);
        let (at, length, first) =
            if group < of_longer { (group, each + 1, 0) } else { (group - of_longer, each.max(1), longer) };
        at % length * runs + at / length + first
    }

    #[test]
    fn every_row_is_taken_once() {
        assert_eq!((0..5).map(|group| row(group, 5, 2)).collect::<Vec<_>>(), [0, 2, 4, 1, 3]);
        assert_eq!((0..5).map(|group| row(group, 5, 1)).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
        for rows in 1..200 {
            for runs in 1..=rows.min(17) {
                let mut taken: Vec<u32> = (0..rows).map(|group| row(group, rows, runs)).collect();
                taken.sort_unstable();
                assert!(taken.iter().zip(0..).all(|(&row, at)| row == at), "{rows} rows in {runs} runs");
            }
        }
    }
}
