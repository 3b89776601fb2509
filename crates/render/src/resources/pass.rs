//! Bind groups and dispatches of compute passes.

use crate::GpuContext;
use crate::pipelines::binding::{NamedResource, ShaderPipeline};

/// Creates a bind group for one of a pipeline's groups.
pub(crate) fn bind(
    context: &GpuContext,
    label: &str,
    pipeline: &ShaderPipeline,
    group: usize,
    named: &[NamedResource<'_>],
) -> wgpu::BindGroup {
    let group = &pipeline.groups[group];
    context.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &group.layout,
        entries: &group.entries(named),
    })
}

/// Records a compute pass with one dispatch; the groups are bound to indices from 0 on.
pub(crate) fn dispatch(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &ShaderPipeline,
    groups: &[&wgpu::BindGroup],
    [x, y, z]: [u32; 3],
) {
    begin(encoder, label, pipeline, groups).dispatch_workgroups(x, y, z);
}

/// Records a compute pass like [`dispatch`], with the numbers of workgroups at the beginning of a buffer.
pub(crate) fn dispatch_indirect(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &ShaderPipeline,
    groups: &[&wgpu::BindGroup],
    counts: &wgpu::Buffer,
) {
    begin(encoder, label, pipeline, groups).dispatch_workgroups_indirect(counts, 0);
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &ShaderPipeline,
    groups: &[&wgpu::BindGroup],
) -> wgpu::ComputePass<'e> {
    let mut pass = encoder
        .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None });
    pass.set_pipeline(&pipeline.raw);
    for (group, bound) in (0..).zip(groups) {
        pass.set_bind_group(group, *bound, &[]);
    }
    pass
}

/// Returns the number of 8 × 8 workgroups that cover a sheet or a picture.
pub(crate) fn tile_workgroups([width, height]: [u32; 2]) -> [u32; 3] {
    [width.div_ceil(8), height.div_ceil(8), 1]
}

/// Returns the number of interleaved runs into which rows of tiles are sorted (`sheets/tiles.wgsl`).
///
/// A software driver gives each thread a contiguous run of workgroups, so there are as many runs as threads, which
/// balances expensive rows among them. Graphics cards dispatch workgroups one by one, in order.
pub(crate) fn interleaved_runs(context: &GpuContext, [_, rows, _]: [u32; 3]) -> u32 {
    driver_threads(context).min(rows.max(1))
}

/// Returns the number of threads of a software driver; 1 for a graphics card.
pub(crate) fn driver_threads(context: &GpuContext) -> u32 {
    let threads = || std::thread::available_parallelism().map_or(1, |threads| threads.get() as u32);
    if context.is_software() { threads() } else { 1 }
}

#[cfg(test)]
mod tests {
    /// Row of tiles that a row of workgroups processes, as computed by the shader.
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
