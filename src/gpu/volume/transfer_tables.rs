//! Transfer-function tables on the GPU, and the cells that are visible with them.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;

use super::materials::Materials;
use super::{GpuVolume, LevelViews, Pyramids, brick_dims};
use crate::data::CELL_EDGE;
use crate::gpu::pipelines::variant::Ends;
use crate::gpu::{Context, GpuError};
use crate::model::{BakedTransfer, COLORS, Settings};
use crate::plan::{BrickSet, CellDistances, CellSet, CellsAhead, TablesKey};

/// Distance in voxels between opposite faces from which on no unstretched kernel reaches both: twice `EDGE_REACH` in
/// `shaders/density/presence.wgsl`.
const KERNEL_AT_FACES: f64 = 3.0;

/// Baked transfer function: its lookup table and the cells where it has extinction (occupied cells).
#[derive(Debug, Clone)]
pub(crate) struct Table {
    /// Lookup table on the CPU.
    baked: Arc<BakedTransfer>,
    /// Lookup table in a storage buffer.
    pub buffer: wgpu::Buffer,
    /// Bricks with any extinction.
    pub occupied: Arc<BrickSet>,
    /// Distance of each cell to the nearest occupied cell.
    distances: Arc<CellDistances>,
    /// Minimum distance, in cells, from occupied cells to the cells at the faces of the grid.
    clearance: u8,
    /// Minimum distance, in cells, from occupied cells to cells with missing voxels; 255 if none are missing.
    from_missing: u8,
    /// `true` if no cell is occupied.
    pub is_empty: bool,
    /// Pre-classified voxels, if voxels are classified before reconstruction.
    pub materials: Option<Arc<Materials>>,
    /// Channel of the materials that holds relative extinction.
    pub component: u32,
}

impl Table {
    /// Uploads a transfer function and finds its occupied cells, reusing those of a `known` table with the same
    /// visible densities.
    fn new<'a>(
        context: &Context,
        volume: &GpuVolume,
        baked: BakedTransfer,
        bounded: bool,
        known: impl IntoIterator<Item = &'a Self>,
    ) -> Self {
        let buffer = context.buffer("Table::buffer", &baked.numbers(), wgpu::BufferUsages::STORAGE);
        if let Some(known) = known.into_iter().find(|known| baked.shows_like(&known.baked)) {
            return Self { baked: Arc::new(baked), buffer, materials: None, component: 0, ..known.clone() };
        }
        let dims = volume.bricks.dims;
        let occupied = BrickSet::new(dims, volume.bricks.occupancy(baked.visibility()));
        let masks = if bounded {
            volume.bricks.cell_masks(baked.visibility())
        } else {
            occupied.members.iter().map(|&member| if member { u64::MAX } else { 0 }).collect()
        };
        let is_empty = masks.iter().all(|mask: &u64| *mask == 0);
        let distances = Arc::new(CellDistances::of(&CellSet { dims, masks }));
        let clearance = distances.least_at_faces(volume.volume.dims().map(|n| (n - 1) / CELL_EDGE));
        let [width, height, _] = distances.dims;
        let distance_of = |voxel: [usize; 3]| {
            let [x, y, z] = voxel.map(|c| c / CELL_EDGE);
            distances.values[x + width * (y + height * z)]
        };
        let from_missing = volume.volume.missing().map_or(u8::MAX, |missing| missing.least(distance_of));
        Self {
            baked: Arc::new(baked),
            buffer,
            occupied: Arc::new(occupied),
            distances,
            clearance,
            from_missing,
            is_empty,
            materials: None,
            component: 0,
        }
    }

    /// Returns the tables for red, green and blue light, which share the occupied cells of this one.
    fn met_by_colors(&self, context: &Context) -> Vec<Self> {
        let met = |color| {
            let baked = self.baked.met_by(color);
            let buffer = context.buffer("Table::color", &baked.numbers(), wgpu::BufferUsages::STORAGE);
            Self { baked: Arc::new(baked), buffer, ..self.clone() }
        };
        (0..COLORS).map(met).collect()
    }

    /// Returns the grid boundaries near occupied cells, for samples that reach `dilation` cells beyond their own,
    /// with kernels stretched up to a level of the pyramid.
    pub(crate) fn ends(&self, volume: &GpuVolume, dilation: i32, level: f64) -> Ends {
        if self.materials.is_some() {
            // Pre-classified voxels outside the grid have no extinction, so no boundary test is needed.
            return Ends::Nowhere;
        }
        // Kernels reach two voxels of their level to either side, and their gradients one voxel more.
        let near_missing = dilation + (1.5 * level.exp2()).ceil() as i32 + 1;
        if i32::from(self.from_missing) <= near_missing {
            return volume.ends_of_all();
        }
        // Faces lie half a voxel outside the first cell.
        let layers = level.exp2().ceil() as i32;
        if i32::from(self.clearance) > layers - 1 + dilation {
            return Ends::Nowhere;
        }
        let thinnest = volume.volume.dims().into_iter().min().unwrap_or_default() as f64;
        if thinnest < KERNEL_AT_FACES * level.exp2() { Ends::BetweenFaces } else { Ends::AtFaces }
    }

    /// Returns true if a cell is occupied.
    pub(crate) fn occupies(&self, [x, y, z]: [usize; 3]) -> bool {
        let [width, height, _] = self.distances.dims;
        self.distances.values[x + width * (y + height * z)] == 0
    }

    /// Returns the cells of `divisor`³ voxels, on a grid of `bricks`, within `reach` data cells of occupied cells.
    pub(crate) fn around(&self, reach: u8, divisor: usize, bricks: [usize; 3]) -> CellSet {
        self.distances.within(reach, divisor, bricks)
    }

    /// Returns the lookup table on the CPU.
    pub(crate) fn baked(&self) -> &Arc<BakedTransfer> {
        &self.baked
    }

    /// Returns the table for gathered values: the transfer function, or for pre-classified voxels the conversion of
    /// relative extinction.
    pub(crate) fn gathered(&self) -> &wgpu::Buffer {
        self.materials.as_ref().map_or(&self.buffer, |materials| &materials.table)
    }

    /// Returns the pyramid that values are gathered from.
    pub(crate) fn pyramid<'a>(&'a self, volume: &'a GpuVolume) -> &'a LevelViews {
        self.materials.as_ref().map_or(&volume.pyramid_views, |materials| &materials.views)
    }

    /// Returns true if the lowest density has extinction.
    pub(crate) fn shows_empty_space(&self) -> bool {
        self.baked.shows_lowest()
    }

    /// Returns the maximum extinction of any density, per scene unit.
    pub(crate) fn largest_extinction(&self) -> f32 {
        self.baked.most_extinction()
    }
}

/// Tables of both transfer functions of the settings.
#[derive(Debug)]
pub(crate) struct Tables {
    /// Table of the eye's transfer function.
    pub eye: Table,
    /// Table of the lighting transfer function.
    pub lighting: Table,
    /// Tables for red, green and blue light if shadows are coloured; else empty.
    colors: Vec<Table>,
    /// Distances in cells to the nearest cell that is visible to the eye.
    pub eye_distances: wgpu::TextureView,
    /// Distances in cells: r to the nearest cell occupied in either table, g to the nearest that attenuates light.
    pub light_distances: wgpu::TextureView,
    /// Distances to cells occupied in either table; the light of eye samples is looked up near them.
    shown: Arc<CellDistances>,
    /// Cells of light volumes that recent pictures have needed, most recent first.
    needed: RefCell<VecDeque<(Needs, Arc<CellSet>)>>,
}

/// Parameters of the cell set that a picture needs of a light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Needs {
    /// Maximum distance, in data cells, from cells occupied in either table.
    pub reach: u8,
    /// Number of data voxels per light voxel, along an axis.
    pub divisor: usize,
    /// Offset of near-field lookups towards the light.
    pub ahead: CellsAhead,
}

/// Maximum number of cached sets of needed cells: for eight lights, two settings and two resolutions.
const MOST_NEEDED: usize = 32;

impl Tables {
    /// Bakes the tables that differ from `previous`, which belong to the same volume and another key. Returns the
    /// tables and the number of tables baked.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &Context,
        volume: &GpuVolume,
        settings: &Settings,
        key: &TablesKey,
        previous: Option<(&TablesKey, &Self)>,
    ) -> Result<(Self, u32), GpuError> {
        let range = volume.volume.table_range();
        let bounded = key.cells_are_bounds;
        let previous = previous.filter(|(known, _)| known.cells_are_bounds == bounded);
        let known = || previous.into_iter().flat_map(|(_, tables)| [&tables.eye, &tables.lighting]);
        let mut baked = 0;
        let eye = if let Some((_, tables)) = previous.filter(|(known, _)| known.eye == key.eye) {
            tables.eye.clone()
        } else {
            baked += 1;
            Table::new(context, volume, settings.baked_eye(range, &volume.scene), bounded, known())
        };
        let is_lit_alike =
            |known: &TablesKey| (&known.lighting, &known.transmission) == (&key.lighting, &key.transmission);
        let (lighting, colors) = if let Some((_, tables)) = previous.filter(|(known, _)| is_lit_alike(known))
        {
            (tables.lighting.clone(), tables.colors.clone())
        } else {
            baked += 1;
            let lighting = settings.baked_lighting(range, &volume.scene);
            let lighting = Table::new(context, volume, lighting, bounded, known().chain([&eye]));
            let colors = key.transmission.as_ref().map(|_| lighting.met_by_colors(context));
            (lighting, colors.unwrap_or_default())
        };
        if let Some((_, tables)) = previous {
            let is_same = |a: &Table, b: &Table| Arc::ptr_eq(&a.distances, &b.distances);
            if is_same(&eye, &tables.eye) && is_same(&lighting, &tables.lighting) {
                let (eye_distances, light_distances) =
                    (tables.eye_distances.clone(), tables.light_distances.clone());
                let (shown, needed) = (Arc::clone(&tables.shown), tables.needed.clone());
                let tables = Self { eye, lighting, colors, eye_distances, light_distances, shown, needed };
                return Ok((tables, baked));
            }
        }
        let shown = if Arc::ptr_eq(&eye.distances, &lighting.distances) {
            Arc::clone(&eye.distances)
        } else {
            Arc::new(eye.distances.nearest(&lighting.distances))
        };
        let dims = shown.dims;
        let pairs: Vec<u8> =
            shown.values.iter().zip(&lighting.distances.values).flat_map(|(r, g)| [*r, *g]).collect();
        let eye_distances = upload_distances(
            context,
            "Tables::eye_distances",
            dims,
            &eye.distances.values,
            wgpu::TextureFormat::R8Unorm,
        )?;
        let light_distances = upload_distances(
            context,
            "Tables::light_distances",
            dims,
            &pairs,
            wgpu::TextureFormat::Rg8Unorm,
        )?;
        let needed = RefCell::default();
        Ok((Self { eye, lighting, colors, eye_distances, light_distances, shown, needed }, baked))
    }

    /// Returns the table that attenuates light, or one of its colours.
    pub(crate) fn met(&self, color: Option<usize>) -> &Table {
        color.and_then(|color| self.colors.get(color)).unwrap_or(&self.lighting)
    }

    /// Sets the pre-classified voxels of the tables, if voxels are classified first.
    pub(crate) fn set_materials(&mut self, eye: Option<Arc<Materials>>, lighting: Option<Arc<Materials>>) {
        for (table, component) in self.colors.iter_mut().zip(1..) {
            table.component = if lighting.is_some() { component } else { 0 };
            table.materials.clone_from(&lighting);
        }
        (self.eye.materials, self.lighting.materials) = (eye, lighting);
    }

    /// Returns the pyramids for passes of the eye.
    pub(crate) fn pyramids<'a>(&'a self, volume: &'a GpuVolume) -> Pyramids<'a> {
        Pyramids { own: self.eye.pyramid(volume), lighting: Some(self.lighting.pyramid(volume)) }
    }

    /// Returns the pyramids for passes that follow light.
    pub(crate) fn lighting_pyramids<'a>(&'a self, volume: &'a GpuVolume) -> Pyramids<'a> {
        Pyramids { own: self.lighting.pyramid(volume), lighting: None }
    }

    /// Returns the grid boundaries near cells occupied in either table, for samples of the eye and rays from them.
    pub(crate) fn ends(&self, volume: &GpuVolume, dilation: i32, level: f64) -> Ends {
        self.eye.ends(volume, dilation, level).max(self.lighting.ends(volume, dilation, level))
    }

    /// Returns the cells of a light volume that a picture needs, cached.
    pub(crate) fn needed_cells(&self, volume: &GpuVolume, needs: Needs) -> Arc<CellSet> {
        let known =
            self.needed.borrow().iter().find(|(known, _)| *known == needs).map(|(_, set)| Arc::clone(set));
        if let Some(known) = known {
            return known;
        }
        let Needs { reach, divisor, ahead } = needs;
        let dims = volume.volume.dims();
        let coarse = brick_dims(dims.map(|n| n.div_ceil(divisor)));
        let fresh = if ahead == CellsAhead::default() {
            self.shown.within(reach, divisor, coarse)
        } else {
            let still = Needs { divisor: 1, ahead: CellsAhead::default(), ..needs };
            let around = self.needed_cells(volume, still);
            let moved = ahead.of((*around).clone(), dims.map(|n| (n - 1) / 2));
            if divisor > 1 { moved.coarsened(divisor, coarse) } else { moved }
        };
        let fresh = Arc::new(fresh);
        let mut needed = self.needed.borrow_mut();
        needed.truncate(MOST_NEEDED - 1);
        needed.push_front((needs, Arc::clone(&fresh)));
        fresh
    }

    /// Returns true if either transfer function has extinction at the lowest density, which is also the density
    /// outside the grid.
    pub(crate) fn shows_empty_space(&self) -> bool {
        self.eye.shows_empty_space() || self.lighting.shows_empty_space()
    }
}

/// Reach larger than any distance, which disables empty-space skipping.
pub(crate) const EVERYWHERE: i32 = 255;

/// Uploads a 3D texture of distances, one or two bytes per cell or brick. Shaders sample normalised formats and load
/// integer formats.
pub(crate) fn upload_distances(
    context: &Context,
    label: &'static str,
    dims: [usize; 3],
    distances: &[u8],
    format: wgpu::TextureFormat,
) -> Result<wgpu::TextureView, GpuError> {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = context.texture(&super::texture_3d(label, dims, format, usage))?;
    context.queue.write_texture(
        texture.as_image_copy(),
        distances,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some((distances.len() / dims[1].max(1) / dims[2].max(1)) as u32),
            rows_per_image: Some(dims[1] as u32),
        },
        texture.size(),
    );
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}
