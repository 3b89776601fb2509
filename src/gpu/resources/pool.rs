//! Pool of small buffers, bind groups and a ring of sheets, reused from picture to picture: dragging a light or the
//! camera allocates nothing.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};

use super::pass;
use super::ring::Ring;
use crate::gpu::Context;
use crate::gpu::pipelines::binding::{Named, Pipeline};

/// Maximum number of cached bind groups. They bind a few dozen buffers and textures.
const MOST_GROUPS: usize = 1024;

/// Size of the smallest buffer, in bytes. Sizes are powers of two, so that lists of varying length reuse buffers.
const SMALLEST_BUFFER: u64 = 256;

/// Buffers, bind groups and a ring of sheets of one renderer.
#[derive(Debug, Default)]
pub(crate) struct ResourcePool(RefCell<Inner>);

#[derive(Debug, Default)]
struct Inner {
    /// Buffers by label, size and usage.
    shelves: BTreeMap<(&'static str, u64, u32), Shelf>,
    groups: HashMap<GroupKey, wgpu::BindGroup>,
    ring: Option<Ring>,
    /// Set if cached bind groups may keep a ring alive.
    binds_ring: bool,
    made: u64,
}

/// Buffers of one kind; the first `taken` are in use by the submission being recorded.
#[derive(Debug, Default)]
struct Shelf {
    buffers: Vec<wgpu::Buffer>,
    taken: usize,
}

#[derive(Debug, PartialEq, Eq, Hash)]
struct GroupKey {
    layout: wgpu::BindGroupLayout,
    bound: Vec<(&'static str, Bound)>,
}

#[derive(Debug, PartialEq, Eq, Hash)]
enum Bound {
    Buffer(wgpu::Buffer, u64, Option<wgpu::BufferSize>),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Bound {
    /// Returns the key of a resource; `None` for kinds that no pass binds.
    fn of(resource: &wgpu::BindingResource<'_>) -> Option<Self> {
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
    pub(crate) fn forget_groups(&self) {
        self.0.borrow_mut().groups.clear();
    }

    /// Begins a submission, for which all buffers are free again: writes from now on are ordered after the previous
    /// submission.
    pub(crate) fn next_submission(&self) {
        for shelf in self.0.borrow_mut().shelves.values_mut() {
            shelf.taken = 0;
        }
    }

    /// Drops all pooled resources, for example when another volume is loaded.
    pub(crate) fn clear(&self) {
        let inner = &mut *self.0.borrow_mut();
        inner.shelves.clear();
        inner.groups.clear();
        inner.ring = None;
    }

    /// Returns a buffer that begins with `contents`, for one submission. It may be longer.
    pub(crate) fn buffer<T: bytemuck::NoUninit>(
        &self,
        context: &Context,
        label: &'static str,
        contents: &[T],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        self.buffer_with_room(context, label, contents, usage, SMALLEST_BUFFER)
    }

    /// Returns a buffer of at least `room` bytes that begins with `contents`, for one submission.
    pub(crate) fn buffer_with_room<T: bytemuck::NoUninit>(
        &self,
        context: &Context,
        label: &'static str,
        contents: &[T],
        usage: wgpu::BufferUsages,
        room: u64,
    ) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        let size = (bytes.len() as u64).max(room).next_power_of_two();
        let inner = &mut *self.0.borrow_mut();
        let shelf = inner.shelves.entry((label, size, usage.bits())).or_default();
        if shelf.taken == shelf.buffers.len() {
            inner.made += 1;
            shelf.buffers.push(context.empty_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        let buffer = shelf.buffers[shelf.taken].clone();
        shelf.taken += 1;
        context.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// Returns a bind group as [`pass::bind`] makes it, cached by the resources that it binds.
    pub(crate) fn bind(
        &self,
        context: &Context,
        label: &str,
        pipeline: &Pipeline,
        group: usize,
        entries: &[Named<'_>],
    ) -> wgpu::BindGroup {
        let bound = entries.iter().map(|named| Some((named.name, Bound::of(&named.resource)?)));
        let Some(bound) = bound.collect() else {
            return pass::bind(context, label, pipeline, group, entries);
        };
        let key = GroupKey { layout: pipeline.groups[group].layout.clone(), bound };
        let inner = &mut *self.0.borrow_mut();
        if inner.groups.len() >= MOST_GROUPS {
            inner.groups.clear();
        }
        let made = &mut inner.made;
        let kept = inner.groups.entry(key).or_insert_with(|| {
            *made += 1;
            pass::bind(context, label, pipeline, group, entries)
        });
        kept.clone()
    }

    /// Takes the ring of sheets that the previous light volume left.
    pub(crate) fn take_ring(&self) -> Option<Ring> {
        self.0.borrow_mut().ring.take()
    }

    /// Stores a ring of sheets for the next light volume, unless a larger one is stored.
    pub(crate) fn leave_ring(&self, ring: Ring) {
        let inner = &mut *self.0.borrow_mut();
        if inner.ring.as_ref().is_none_or(|known| known.bytes() < ring.bytes()) {
            inner.ring = Some(ring);
        }
    }

    /// Records that a new ring was made, and drops the bind groups that would keep the previous one alive.
    pub(crate) fn made_ring(&self) {
        let inner = &mut *self.0.borrow_mut();
        inner.made += 1;
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
        self.0.borrow().ring.as_ref().map_or(0, Ring::bytes)
    }

    /// Returns the number of buffers, bind groups and rings made so far.
    pub(crate) fn made(&self) -> u64 {
        self.0.borrow().made
    }
}
