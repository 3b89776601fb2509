//! GPU timestamps, where the adapter supports them.

use crate::{GpuContext, GpuError};

/// Pair of GPU timestamps, with the buffers they are resolved to and read from.
#[derive(Debug)]
pub(crate) struct GpuClock {
    timestamps: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readback: wgpu::Buffer,
    ms_per_tick: f64,
}

/// Size of two timestamps, in bytes.
const TIMESTAMP_BYTES: u64 = 16;

impl GpuClock {
    /// Device features that timestamps require.
    pub(crate) const FEATURES: wgpu::Features =
        wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

    /// Creates a clock, or returns `None` if the device has no timestamps. Software drivers take the timestamp when
    /// they read the command, not when the work before it is finished; they get none either.
    pub(crate) fn new(context: &GpuContext) -> Option<Self> {
        let device = &context.device;
        if context.is_software() || !device.features().contains(Self::FEATURES) {
            return None;
        }
        let buffer = |label, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: TIMESTAMP_BYTES,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            timestamps: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("Clock::stamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(
                "Clock::resolved",
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
            readback: buffer("Clock::read", wgpu::BufferUsages::MAP_READ),
            ms_per_tick: f64::from(context.queue.get_timestamp_period()) / 1e6,
        })
    }

    /// Records a timestamp in front of the commands to be timed.
    pub(crate) fn start(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.write_timestamp(&self.timestamps, 0);
    }

    /// Records a timestamp behind the timed commands, and copies both timestamps into the buffer for reading.
    pub(crate) fn stop(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.write_timestamp(&self.timestamps, 1);
        encoder.resolve_query_set(&self.timestamps, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readback, 0, TIMESTAMP_BYTES);
    }

    /// Waits for the timed commands and returns their duration in milliseconds.
    pub(crate) fn read_ms(&self, context: &GpuContext) -> Result<f64, GpuError> {
        self.readback.map_async(wgpu::MapMode::Read, .., |result| {
            if let Err(err) = result {
                log::error!("reading back failed: {err}");
            }
        });
        context.wait()?;
        let view = self.readback.get_mapped_range(..).map_err(|err| GpuError::Refused(err.to_string()))?;
        let timestamp = |at: usize| {
            let mut bytes = [0; 8];
            bytes.copy_from_slice(&view[8 * at..8 * at + 8]);
            u64::from_le_bytes(bytes)
        };
        let ticks = timestamp(1).saturating_sub(timestamp(0));
        drop(view);
        self.readback.unmap();
        Ok(ticks as f64 * self.ms_per_tick)
    }
}
