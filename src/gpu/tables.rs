//! Transfer functions on the GPU, and the bricks that they show.

use super::volume::{GpuVolume, entry};
use super::{Context, GpuError};
use crate::model::{BakedTransfer, Settings};
use crate::plan::BrickSet;

/// A baked transfer function: its table and the bricks in which it shows anything.
#[derive(Debug)]
pub(super) struct Table {
    /// What it was baked to.
    pub baked: BakedTransfer,
    /// The table as a storage buffer.
    pub buffer: wgpu::Buffer,
    /// Bricks with any extinction.
    pub occupied: BrickSet,
    /// Which octants of them have any, a bit each.
    pub octants: Vec<u8>,
}

impl Table {
    fn new(context: &Context, volume: &GpuVolume, baked: BakedTransfer) -> Self {
        let buffer = context.buffer("Table::entries", &baked.entries, wgpu::BufferUsages::STORAGE);
        let occupied = BrickSet::new(volume.bricks.dims, volume.bricks.occupancy(baked.visibility()));
        let octants = volume.bricks.octant_masks(baked.visibility());
        Self { baked, buffer, occupied, octants }
    }

    /// Whether the lowest density has any extinction.
    pub(super) fn shows_nothing(&self) -> bool {
        self.baked.entries[0][3] > 0.0
    }

    /// The largest extinction of any density, per scene unit.
    pub(super) fn largest_extinction(&self) -> f32 {
        self.baked.entries.iter().map(|[.., extinction]| *extinction).fold(0.0, f32::max)
    }
}

/// Both transfer functions of the settings.
#[derive(Debug)]
pub(super) struct Tables {
    /// What the eye sees.
    pub eye: Table,
    /// What the light meets.
    pub lighting: Table,
    /// Bricks in which an eye sample can look up attenuation: those that either shows. A sample that
    /// sees a voxel is less than two voxels from it, and the texels around the sample are one further:
    /// that is what a brick's range announces.
    pub lit: BrickSet,
    /// The same, and one brick further on every side: for stretched kernels, a light bias, and light
    /// volumes with larger voxels.
    pub lit_widely: BrickSet,
    /// Distances in bricks to the nearest that the eye sees, and the octants that it sees …
    pub eye_distances: wgpu::TextureView,
    /// … and the same for what attenuates light.
    pub lighting_distances: wgpu::TextureView,
}

impl Tables {
    /// Bakes both and finds their bricks.
    pub(super) fn new(context: &Context, volume: &GpuVolume, settings: &Settings) -> Result<Self, GpuError> {
        let range = volume.volume.value_range();
        let eye = Table::new(context, volume, settings.baked_eye(range, &volume.scene));
        let lighting = Table::new(context, volume, settings.baked_lighting(range, &volume.scene));
        let upload = |label: &'static str, table: &Table| {
            let pairs = table.occupied.distances().into_iter().zip(&table.octants);
            let bytes: Vec<u8> = pairs.flat_map(|(distance, octants)| [distance, *octants]).collect();
            upload_bricks(context, label, table.occupied.dims, &bytes, 2)
        };
        let eye_distances = upload("Tables::eye_distances", &eye)?;
        let lighting_distances = upload("Tables::lighting_distances", &lighting)?;
        // Once per transfer function: at 512³ voxels this takes longer than the rest of a picture's plan.
        let lit = eye.occupied.union(&lighting.occupied);
        let lit_widely = lit.dilated(1);
        Ok(Self { eye, lighting, lit, lit_widely, eye_distances, lighting_distances })
    }

    /// Whether either shows the lowest density, which is also that of what lies around the grid.
    pub(super) fn show_nothing(&self) -> bool {
        self.eye.shows_nothing() || self.lighting.shows_nothing()
    }

    /// Brings the tables up to date with changed settings.
    pub(super) fn refresh(
        &mut self,
        context: &Context,
        volume: &GpuVolume,
        settings: &Settings,
    ) -> Result<(), GpuError> {
        let range = volume.volume.value_range();
        let eye = settings.baked_eye(range, &volume.scene);
        let lighting = settings.baked_lighting(range, &volume.scene);
        if eye != self.eye.baked || lighting != self.lighting.baked {
            *self = Self::new(context, volume, settings)?;
        }
        Ok(())
    }
}

/// A 3D texture of `channels` unsigned bytes per brick: two or four.
pub(super) fn upload_bricks(
    context: &Context,
    label: &'static str,
    dims: [usize; 3],
    bytes: &[u8],
    channels: u32,
) -> Result<wgpu::TextureView, GpuError> {
    let format = if channels == 2 { wgpu::TextureFormat::Rg8Uint } else { wgpu::TextureFormat::Rgba8Uint };
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = context.texture(&super::volume::texture_3d(label, dims, format, usage))?;
    context.queue.write_texture(
        texture.as_image_copy(),
        bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(channels * dims[0] as u32),
            rows_per_image: Some(dims[1] as u32),
        },
        texture.size(),
    );
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// The distance, in bricks, up to which a kernel stretched to a pyramid level can see beyond the
/// range that a brick announces: at level 2 it reaches 9.4 voxels, the announcement three.
pub(super) fn dilation(max_stretch_level: f64) -> i32 {
    i32::from(max_stretch_level > 0.0)
}

/// A bind group entry for a texture view.
pub(super) fn view_entry(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    entry(binding, wgpu::BindingResource::TextureView(view))
}
