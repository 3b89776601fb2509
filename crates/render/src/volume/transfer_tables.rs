//! Transfer-function tables on the GPU, and the cells that are visible with them.

use std::cell::Cell;
use std::sync::Arc;

use rayon::prelude::*;

use super::cell_set_cache::{CellRequirement, CellSetCache, OccupiedCells};
use super::layers::BakedLayers;
use super::preclassified::PreclassifiedVoxels;
use super::{GpuVolume, PassPyramids, PyramidViews, brick_dims};
use crate::pipelines::pipeline_variant::GridBoundaries;
use crate::plan::{BrickSet, CellDistances, CellSet, FloorPlane, NearFieldOffset, TablesKey};
use crate::resources::cache_entry::CacheEntry;
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::{LIGHT_COLORS, Settings, VolumeLayer};
use chiaroscuro_volume::{CELL_EDGE, CellOccupancy, math::SceneSpace};

/// Distance in voxels between opposite faces from which on no unstretched kernel reaches both: twice `EDGE_REACH` in
/// `shaders/density/presence.wgsl`.
const MAX_FACE_DISTANCE: f64 = 3.0;

/// Baked transfer functions of all layers: their lookup tables and the cells where they have extinction (occupied cells).
#[derive(Debug, Clone)]
pub(crate) struct TransferTable {
    /// Lookup tables on the CPU.
    baked: Arc<BakedLayers>,
    /// Lookup tables in a storage buffer, that of the first layer first.
    pub buffer: wgpu::Buffer,
    /// Bricks with any extinction.
    pub occupied_bricks: Arc<BrickSet>,
    /// Distance of each cell to the nearest occupied cell.
    distances: Arc<CellDistances>,
    /// Minimum distance, in cells, from occupied cells to the cells at the faces of the grid.
    cells_to_faces: u8,
    /// Minimum distance, in cells, from occupied cells to cells with missing voxels; 255 if none are missing.
    cells_to_missing: u8,
    /// `true` if no cell is occupied.
    pub is_empty: bool,
    /// Pre-classified voxels, if voxels are classified before reconstruction.
    pub materials: Option<Arc<PreclassifiedVoxels>>,
    /// Channel of the materials that holds relative extinction.
    pub extinction_channel: u32,
}

impl TransferTable {
    /// Uploads transfer functions and finds their occupied cells, reusing those of a `known` table with the same
    /// visible densities.
    fn new<'a>(
        context: &GpuContext,
        volume: &GpuVolume,
        baked: BakedLayers,
        bounded: bool,
        known: impl IntoIterator<Item = &'a Self>,
    ) -> Self {
        let buffer = context.buffer("Table::buffer", &baked.to_f32s(), wgpu::BufferUsages::STORAGE);
        if let Some(known) = known.into_iter().find(|known| baked.has_same_visibility(&known.baked)) {
            return Self {
                baked: Arc::new(baked),
                buffer,
                materials: None,
                extinction_channel: 0,
                ..known.clone()
            };
        }
        let dims = volume.bricks.dims;
        let CellOccupancy { bricks, cells: masks } = baked.occupancy(volume, bounded);
        let occupied = BrickSet::new(dims, bricks);
        let is_empty = masks.iter().all(|mask: &u64| *mask == 0);
        let distances = Arc::new(CellDistances::from_set(&CellSet { dims, masks }));
        let clearance = distances.min_at_faces(volume.volume.dims().map(|n| (n - 1) / CELL_EDGE));
        let [width, height, _] = distances.dims;
        let distance_of = |voxel: [usize; 3]| {
            let [x, y, z] = voxel.map(|c| c / CELL_EDGE);
            distances.values[x + width * (y + height * z)]
        };
        let from_missing = volume.volume.min_over_absent(distance_of);
        Self {
            baked: Arc::new(baked),
            buffer,
            occupied_bricks: Arc::new(occupied),
            distances,
            cells_to_faces: clearance,
            cells_to_missing: from_missing,
            is_empty,
            materials: None,
            extinction_channel: 0,
        }
    }

    /// Returns the tables for red, green and blue light, which share the occupied cells of this one.
    fn color_tables(&self, context: &GpuContext) -> Vec<Self> {
        let met = |color| {
            let baked = self.baked.for_light_color(color);
            let buffer = context.buffer("Table::color", &baked.to_f32s(), wgpu::BufferUsages::STORAGE);
            Self { baked: Arc::new(baked), buffer, ..self.clone() }
        };
        (0..LIGHT_COLORS).map(met).collect()
    }

    /// Returns the grid boundaries near occupied cells, for samples that reach `dilation` cells beyond their own,
    /// with kernels stretched up to a level of the pyramid.
    pub(crate) fn boundaries(&self, volume: &GpuVolume, dilation: i32, level: f64) -> GridBoundaries {
        if self.materials.is_some() {
            // Pre-classified voxels outside the grid have no extinction, so no boundary test is needed.
            return GridBoundaries::None;
        }
        // Kernels reach two voxels of their level to either side, and their gradients one voxel more.
        let near_missing = dilation + (1.5 * level.exp2()).ceil() as i32 + 1;
        if i32::from(self.cells_to_missing) <= near_missing {
            return volume.possible_boundaries();
        }
        // Faces lie half a voxel outside the first cell.
        let layers = level.exp2().ceil() as i32;
        if i32::from(self.cells_to_faces) > layers - 1 + dilation {
            return GridBoundaries::None;
        }
        let thinnest = volume.volume.dims().into_iter().min().unwrap_or_default() as f64;
        if thinnest < MAX_FACE_DISTANCE * level.exp2() {
            GridBoundaries::OppositeFaces
        } else {
            GridBoundaries::Faces
        }
    }

    /// Returns true if a cell is occupied.
    pub(crate) fn occupies(&self, [x, y, z]: [usize; 3]) -> bool {
        let [width, height, _] = self.distances.dims;
        self.distances.values[x + width * (y + height * z)] == 0
    }

    /// Returns the lookup tables on the CPU.
    pub(crate) fn baked(&self) -> &Arc<BakedLayers> {
        &self.baked
    }

    /// Returns the table for gathered values: the transfer function, or for pre-classified voxels the conversion of
    /// relative extinction.
    pub(crate) fn lookup_buffer(&self) -> &wgpu::Buffer {
        self.materials.as_ref().map_or(&self.buffer, |materials| &materials.table)
    }

    /// Returns the pyramid that values are gathered from.
    pub(crate) fn pyramid<'a>(&'a self, volume: &'a GpuVolume) -> &'a PyramidViews {
        self.materials.as_ref().map_or(volume.pyramid_views(), |materials| &materials.views)
    }

    /// Returns true if the lowest density has extinction.
    pub(crate) fn has_extinction_at_zero(&self) -> bool {
        self.baked.is_lowest_visible()
    }

    /// Returns the maximum extinction of any density, per scene unit.
    pub(crate) fn largest_extinction(&self) -> f32 {
        self.baked.max_extinction()
    }
}

/// Tables of both transfer functions of the settings.
#[derive(Debug, Clone)]
pub(crate) struct TransferTables {
    /// Table of the eye's transfer function.
    pub eye: TransferTable,
    /// Table of the lighting transfer function.
    pub lighting: TransferTable,
    /// Tables of layers that tint the first one, if there are some.
    pub tints: Option<TransferTable>,
    /// Tables for red, green and blue light if shadows are coloured; else empty.
    colors: Vec<TransferTable>,
    /// Distances in cells to the nearest cell that is visible to the eye.
    pub eye_distances: wgpu::TextureView,
    /// Distances in cells: r to the nearest cell occupied in either table, g the bits in which the distance to the
    /// nearest cell that attenuates light differs, if they differ anywhere.
    pub light_distances: wgpu::TextureView,
    /// Distances to cells occupied in either table; the light of eye samples is looked up near them.
    occupied_distances: Arc<CellDistances>,
    /// Cells of light volumes and of blocks that recent pictures have needed.
    cell_sets: CellSetCache,
    /// Floor asked about last, and whether something below it attenuates light.
    below_floor: Cell<Option<(FloorPlane, bool)>>,
}

/// Transfer tables for a key, and how many of them had to be baked.
pub(crate) struct TableBakeResult {
    pub tables: TransferTables,
    /// Number of tables that were baked; the others were taken from earlier ones.
    pub baked: u32,
}

impl TransferTables {
    /// Bakes the tables that differ from `previous`, which belong to the same volume and another key.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn bake(
        context: &GpuContext,
        volume: &GpuVolume,
        settings: &Settings,
        key: &TablesKey,
        previous: Option<&CacheEntry<TablesKey, Self>>,
    ) -> Result<TableBakeResult, GpuError> {
        let bounded = key.cells_are_bounds;
        let previous = previous
            .filter(|known| known.key().cells_are_bounds == bounded && known.key().bounds == key.bounds);
        let known = || previous.into_iter().flat_map(|known| [&known.product.eye, &known.product.lighting]);
        let mut baked = 0;
        let (eye, tints) = if let Some(known) = previous.filter(|known| known.key().eye == key.eye) {
            (known.product.eye.clone(), known.product.tints.clone())
        } else {
            baked += 1;
            let eye = BakedLayers::new(volume, settings, VolumeLayer::is_seen, VolumeLayer::bake_eye);
            let known_tints = previous.and_then(|known| known.product.tints.as_ref());
            let tints = BakedLayers::from_tints(volume, settings);
            let tints = tints.map(|tints| TransferTable::new(context, volume, tints, bounded, known_tints));
            (TransferTable::new(context, volume, eye, bounded, known()), tints)
        };
        let is_lit_alike =
            |known: &TablesKey| (&known.lighting, &known.transmission) == (&key.lighting, &key.transmission);
        let (lighting, colors) = if let Some(known) = previous.filter(|known| is_lit_alike(known.key())) {
            (known.product.lighting.clone(), known.product.colors.clone())
        } else {
            baked += 1;
            let bake = |layer: &VolumeLayer, range, scene: &SceneSpace| {
                settings.bake_lighting_of(layer, range, scene)
            };
            let mut lighting = BakedLayers::new(volume, settings, VolumeLayer::casts_shadows, bake);
            if key.transmission.is_some() {
                lighting = lighting.with_extinctions();
            }
            let lighting = TransferTable::new(context, volume, lighting, bounded, known().chain([&eye]));
            let colors = key.transmission.as_ref().map(|_| lighting.color_tables(context));
            (lighting, colors.unwrap_or_default())
        };
        if let Some(CacheEntry { product: tables, .. }) = previous {
            let is_same = |a: &TransferTable, b: &TransferTable| Arc::ptr_eq(&a.distances, &b.distances);
            if is_same(&eye, &tables.eye) && is_same(&lighting, &tables.lighting) {
                return Ok(TableBakeResult {
                    tables: Self { eye, lighting, tints, colors, ..tables.clone() },
                    baked,
                });
            }
        }
        let shown = if Arc::ptr_eq(&eye.distances, &lighting.distances) {
            Arc::clone(&eye.distances)
        } else {
            Arc::new(eye.distances.min(&lighting.distances))
        };
        let dims = shown.dims;
        let upload_one = |label, distances: &CellDistances| {
            upload_distances(context, label, dims, &distances.values, wgpu::TextureFormat::R8Unorm)
        };
        let eye_distances = upload_one("Tables::eye_distances", &eye.distances)?;
        let light_distances = if Arc::ptr_eq(&shown, &lighting.distances) {
            if Arc::ptr_eq(&shown, &eye.distances) {
                eye_distances.clone()
            } else {
                upload_one("Tables::light_distances", &shown)?
            }
        } else {
            let mut pairs = vec![[0; 2]; shown.values.len()];
            let distances = shown.values.par_iter().zip(&lighting.distances.values);
            // As `density/cells.wgsl` reads them.
            pairs.par_iter_mut().zip(distances).for_each(|(pair, (any, light))| *pair = [*any, any ^ light]);
            upload_distances(
                context,
                "Tables::light_distances",
                dims,
                pairs.as_flattened(),
                wgpu::TextureFormat::Rg8Unorm,
            )?
        };
        let tables = Self {
            eye,
            lighting,
            tints,
            colors,
            eye_distances,
            light_distances,
            occupied_distances: shown,
            cell_sets: CellSetCache::default(),
            below_floor: Cell::default(),
        };
        Ok(TableBakeResult { tables, baked })
    }

    /// Returns the table that attenuates light, or one of its colours.
    pub(crate) fn lighting_of_color(&self, color: Option<usize>) -> &TransferTable {
        color.and_then(|color| self.colors.get(color)).unwrap_or(&self.lighting)
    }

    /// Sets the pre-classified voxels of the tables, if voxels are classified first.
    pub(crate) fn set_materials(
        &mut self,
        eye: Option<Arc<PreclassifiedVoxels>>,
        lighting: Option<Arc<PreclassifiedVoxels>>,
    ) {
        for (table, component) in self.colors.iter_mut().zip(1..) {
            table.extinction_channel = if lighting.is_some() { component } else { 0 };
            table.materials.clone_from(&lighting);
        }
        (self.eye.materials, self.lighting.materials) = (eye, lighting);
    }

    /// Returns the pyramids for passes of the eye.
    pub(crate) fn pyramids<'a>(&'a self, volume: &'a GpuVolume) -> PassPyramids<'a> {
        let lighting = Some(self.lighting.pyramid(volume));
        PassPyramids { primary: self.eye.pyramid(volume), lighting, tints: self.tint_views() }
    }

    /// Returns the pyramid of tints, if there is one.
    pub(crate) fn tint_views(&self) -> Option<&PyramidViews> {
        Some(&self.tints.as_ref()?.materials.as_ref()?.views)
    }

    /// Returns the pyramids for passes that follow light.
    pub(crate) fn lighting_pyramids<'a>(&'a self, volume: &'a GpuVolume) -> PassPyramids<'a> {
        PassPyramids { primary: self.lighting.pyramid(volume), lighting: None, tints: None }
    }

    /// Returns the grid boundaries near cells occupied in either table, for samples of the eye and rays from them.
    pub(crate) fn boundaries(&self, volume: &GpuVolume, dilation: i32, level: f64) -> GridBoundaries {
        self.eye.boundaries(volume, dilation, level).max(self.lighting.boundaries(volume, dilation, level))
    }

    /// Returns the cells of a light volume that a picture needs, cached.
    pub(crate) fn needed_cells(&self, volume: &GpuVolume, needs: CellRequirement) -> Arc<CellSet> {
        self.cell_sets.get_or_make(OccupiedCells::Any, needs, || {
            let CellRequirement { reach, divisor, offset: ahead } = needs;
            let dims = volume.volume.dims();
            let coarse = brick_dims(dims.map(|n| n.div_ceil(divisor)));
            if ahead == NearFieldOffset::default() {
                return self.occupied_distances.cells_within(reach, divisor, coarse);
            }
            let still = CellRequirement { divisor: 1, offset: NearFieldOffset::default(), ..needs };
            let around = self.needed_cells(volume, still);
            let moved = ahead.shifted_cells((*around).clone(), dims.map(|n| (n - 1) / 2));
            if divisor > 1 { moved.coarsened(divisor, coarse) } else { moved }
        })
    }

    /// Returns the cells of `divisor`³ voxels, on a grid of `bricks`, within `reach` data cells of those that attenuate
    /// light; cached.
    pub(crate) fn attenuating_cells(&self, reach: u8, divisor: usize, bricks: [usize; 3]) -> Arc<CellSet> {
        let needs = CellRequirement { reach, divisor, offset: NearFieldOffset::default() };
        self.cell_sets.get_or_make(OccupiedCells::Attenuating, needs, || {
            self.lighting.distances.cells_within(reach, divisor, bricks)
        })
    }

    /// Returns true if something below a floor attenuates light; known for the floor asked last.
    pub(crate) fn has_attenuation_below(&self, floor: FloorPlane, scene: &SceneSpace) -> bool {
        if let Some((_, has_below)) = self.below_floor.get().filter(|(known, _)| *known == floor) {
            return has_below;
        }
        let table = &self.lighting;
        let has_below = floor.has_below(scene, &table.occupied_bricks, |cell| table.occupies(cell));
        self.below_floor.set(Some((floor, has_below)));
        has_below
    }

    /// Returns true if either transfer function has extinction at the lowest density, which is also the density
    /// outside the grid.
    pub(crate) fn has_extinction_at_zero(&self) -> bool {
        self.eye.has_extinction_at_zero() || self.lighting.has_extinction_at_zero()
    }
}

/// Reach larger than any distance, which disables empty-space skipping.
pub(crate) const UNLIMITED_REACH: i32 = 255;

/// Uploads a 3D texture of distances, one or two bytes per cell or brick. Shaders sample normalised formats and load
/// integer formats.
pub(crate) fn upload_distances(
    context: &GpuContext,
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
