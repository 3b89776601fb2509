//! Pool of small buffers, bind groups and a ring of sheets, reused from picture to picture: dragging a light or the
//! camera allocates nothing.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};

use super::pass;
use super::sheet_ring::SheetRing;
use crate::GpuContext;
use crate::pipelines::binding::{NamedResource, ShaderPipeline};

/// Maximum number of cached bind groups. They bind a few dozen buffers and textures.
const MAX_BIND_GROUPS: usize = 1024;

/// Size of the smallest buffer, in bytes. Sizes are powers of two, so that lists of varying length reuse buffers.
const MIN_BUFFER_BYTES: u64 = 256;

/// Buffers, bind groups and a ring of sheets of one renderer.
#[derive(Debug, Default)]
pub(crate) struct ResourcePool(RefCell<PoolState>);

#[derive(Debug, Default)]
struct PoolState {
    /// Buffers by label, size and usage.
    buckets: BTreeMap<(&'static str, u64, u32), BufferBucket>,
    groups: HashMap<BindGroupKey, wgpu::BindGroup>,
    ring: Option<SheetRing>,
    /// Set if cached bind groups may keep a ring alive.
    binds_ring: bool,
    created_count: u64,
}

/// Buffers of one kind; the first `in_use` are in use by the submission being recorded.
#[derive(Debug, Default)]
struct BufferBucket {
    buffers: Vec<wgpu::Buffer>,
    in_use: usize,
}

#[derive(Debug, PartialEq, Eq, Hash)]
struct BindGroupKey {
    layout: wgpu::BindGroupLayout,
    bound: Vec<(&'static str, BoundResource)>,
}

#[derive(Debug, PartialEq, Eq, Hash)]
enum BoundResource {
    Buffer(wgpu::Buffer, u64, Option<wgpu::BufferSize>),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl BoundResource {
    /// Returns the key of a resource; `None` for kinds that no pass binds.
    fn from_binding(resource: &wgpu::BindingResource<'_>) -> Option<Self> {
        match resource {
            wgpu::BindingResource::Buffer(part) => {
                Some(Self::Buffer(part.buffer.clone(), part.offset, part.size))
            }
            wgpu::BindingResource::TextureView(view) => Some(Self::View((*view).clone())),
            wgpu::BindingResource::Sampler(sampler) => Some(Self::Sampler((*sampler).clone())),
            _ => None,
        }
    }
}

impl ResourcePool {
    /// Drops all cached bind groups, which would keep dropped resources alive.
    pub(crate) fn drop_bind_groups(&self) {
        self.0.borrow_mut().groups.clear();
    }

    /// Begins a submission, for which all buffers are free again: writes from now on are ordered after the previous
    /// submission.
    pub(crate) fn begin_submission(&self) {
        for bucket in self.0.borrow_mut().buckets.values_mut() {
            bucket.in_use = 0;
        }
    }

    /// Drops all pooled resources, for example when another volume is loaded.
    pub(crate) fn clear(&self) {
        let inner = &mut *self.0.borrow_mut();
        inner.buckets.clear();
        inner.groups.clear();
        inner.ring = None;
    }

    /// Returns a buffer that begins with `contents`, for one submission. It may be longer.
    pub(crate) fn buffer<T: bytemuck::NoUninit>(
        &self,
        context: &GpuContext,
        label: &'static str,
        contents: &[T],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        self.buffer_of_at_least(context, label, contents, usage, MIN_BUFFER_BYTES)
    }

    /// Returns a buffer of at least `room` bytes that begins with `contents`, for one submission.
    pub(crate) fn buffer_of_at_least<T: bytemuck::NoUninit>(
        &self,
        context: &GpuContext,
        label: &'static str,
        contents: &[T],
        usage: wgpu::BufferUsages,
        room: u64,
    ) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        let size = (bytes.len() as u64).max(room).next_power_of_two();
        let inner = &mut *self.0.borrow_mut();
        let bucket = inner.buckets.entry((label, size, usage.bits())).or_default();
        if bucket.in_use == bucket.buffers.len() {
            inner.created_count += 1;
            bucket.buffers.push(context.uninitialised_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        let buffer = bucket.buffers[bucket.in_use].clone();
        bucket.in_use += 1;
        context.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// Returns a bind group as [`pass::bind`] makes it, cached by the resources that it binds.
    pub(crate) fn bind(
        &self,
        context: &GpuContext,
        label: &str,
        pipeline: &ShaderPipeline,
        group: usize,
        entries: &[NamedResource<'_>],
    ) -> wgpu::BindGroup {
        let bound =
            entries.iter().map(|named| Some((named.name, BoundResource::from_binding(&named.resource)?)));
        let Some(bound) = bound.collect() else {
            return pass::bind(context, label, pipeline, group, entries);
        };
        let key = BindGroupKey { layout: pipeline.groups[group].layout.clone(), bound };
        let inner = &mut *self.0.borrow_mut();
        if inner.groups.len() >= MAX_BIND_GROUPS {
            inner.groups.clear();
        }
        let made = &mut inner.created_count;
        let kept = inner.groups.entry(key).or_insert_with(|| {
            *made += 1;
            pass::bind(context, label, pipeline, group, entries)
        });
        kept.clone()
    }

    /// Takes the ring of sheets that the previous light volume left.
    pub(crate) fn take_ring(&self) -> Option<SheetRing> {
        self.0.borrow_mut().ring.take()
    }

    /// Stores a ring of sheets for the next light volume, unless a larger one is stored.
    pub(crate) fn put_ring(&self, ring: SheetRing) {
        let inner = &mut *self.0.borrow_mut();
        if inner.ring.as_ref().is_none_or(|known| known.bytes() < ring.bytes()) {
            inner.ring = Some(ring);
        }
    }

    /// Records that a new ring was made, and drops the bind groups that would keep the previous one alive.
    pub(crate) fn record_new_ring(&self) {
        let inner = &mut *self.0.borrow_mut();
        inner.created_count += 1;
        inner.groups.clear();
        inner.binds_ring = true;
    }

    /// Drops the ring, for pictures that fill no light volume.
    pub(crate) fn drop_ring(&self) {
        let inner = &mut *self.0.borrow_mut();
        inner.ring = None;
        if std::mem::take(&mut inner.binds_ring) {
            inner.groups.clear();
        }
    }

    /// Returns the size of the stored ring, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.0.borrow().ring.as_ref().map_or(0, SheetRing::bytes)
    }

    /// Returns the number of buffers, bind groups and rings made so far.
    #[cfg(feature = "testing")]
    pub(crate) fn created_count(&self) -> u64 {
        self.0.borrow().created_count
    }
}
