//! Baked layers: the transfer functions of all layers, for the eye or for light, and the cells where they have matter.

mod material_tables;

use self::material_tables::MaterialTable;
use super::GpuVolume;
use super::field_texture::FieldTexture;
use crate::pipelines::uniforms::{LayerUniform, LayersUniform};
use chiaroscuro_scene::{BakedTransfer, LayerBlend, Settings, VolumeLayer};
use chiaroscuro_volume::math::SceneSpace;
use chiaroscuro_volume::{BrickBounds, CellOccupancy, MAX_FIELDS, ValueRange, Volume};

/// Transfer functions of one side, the eye or light: one for each layer.
#[derive(Debug, Clone)]
pub(crate) struct BakedLayers {
    /// Tables, never empty.
    tables: Vec<BakedTransfer>,
    /// Materials of each layer that take the place of its table.
    materials: Vec<Vec<MaterialTable>>,
    /// Parameters of layers, if voxels are composed of them.
    parameters: Option<Box<LayersUniform>>,
    /// True if the layers that count are those that tint, instead of those with matter.
    are_tints: bool,
}

/// Layers whose voxels a mask hides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum MaskUse {
    /// None of them: there is no mask, or layers only tint.
    Unused,
    /// All layers, and so their sum.
    AllLayers,
    /// Those that do not ignore cuts.
    SomeLayers,
}

impl BakedLayers {
    /// Bakes the layers of a volume for one side: `has_effect` tells if a layer is seen, or attenuates light, and `bake`
    /// makes its table over a range of values.
    pub(crate) fn new(
        volume: &GpuVolume,
        settings: &Settings,
        has_effect: impl Fn(&VolumeLayer) -> bool,
        bake: impl Fn(&VolumeLayer, ValueRange, &SceneSpace) -> BakedTransfer,
    ) -> Self {
        let scene = &volume.scene;
        let Some(texture) = volume.fields.as_ref().filter(|_| settings.is_layered()) else {
            let table = bake(settings.layer(), volume.volume.table_range(), scene);
            return Self { tables: vec![table], materials: Vec::new(), parameters: None, are_tints: false };
        };
        let mut baked = Self::from_fields(texture, settings, scene, has_effect, bake);
        let largest = baked.max_extinction();
        if let Some(parameters) = &mut baked.parameters {
            parameters.largest = largest;
        }
        baked
    }

    /// Composes extinctions instead of opacities, in proportion to which coloured light is attenuated.
    #[must_use]
    pub(crate) fn with_extinctions(mut self) -> Self {
        if let Some(parameters) = &mut self.parameters {
            parameters.voxel = 0.0;
        }
        self.update_materials();
        self
    }

    /// Returns the edge of a voxel over which opacities are composed, in scene units; `None` for extinctions.
    fn opacity_length(&self) -> Option<f64> {
        let parameters = self.parameters.as_ref().filter(|parameters| parameters.voxel > 0.0)?;
        Some(f64::from(parameters.voxel))
    }

    /// Bakes the layers that tint the first field; `None` if there are none.
    pub(crate) fn from_tints(volume: &GpuVolume, settings: &Settings) -> Option<Self> {
        let texture = volume.fields.as_ref().filter(|_| settings.has_tints())?;
        let tints = |layer: &VolumeLayer| layer.is_seen() && layer.blend.changes_color_alone();
        let bake = |layer: &VolumeLayer, range: ValueRange, scene: &SceneSpace| {
            // A channel of colour is there at all densities.
            if layer.blend.channel().is_some() {
                BakedTransfer::constant(1.0)
            } else {
                layer.bake_eye(range, scene)
            }
        };
        let baked = Self::from_fields(texture, settings, &volume.scene, tints, bake);
        Some(Self { are_tints: true, ..baked })
    }

    fn from_fields(
        texture: &FieldTexture,
        settings: &Settings,
        scene: &SceneSpace,
        has_effect: impl Fn(&VolumeLayer) -> bool,
        bake: impl Fn(&VolumeLayer, ValueRange, &SceneSpace) -> BakedTransfer,
    ) -> Self {
        let fields = || settings.layers.iter().zip(texture.fields.iter());
        let table = |layer: &VolumeLayer, range: ValueRange| {
            // An edit of a layer without effect changes nothing.
            if has_effect(layer) { bake(layer, range, scene) } else { BakedTransfer::linear_ramp(0.0) }
        };
        let tables = fields().map(|(layer, field)| table(layer, field.volume().table_range())).collect();
        let materials = fields().map(|(layer, field)| {
            let range = field.volume().table_range();
            let used = layer.materials.iter().filter(|_| layer.has_materials() && has_effect(layer));
            let bake = |layer: &VolumeLayer| bake(layer, range, scene);
            used.map(|material| MaterialTable::new(material, layer, range, bake)).collect()
        });
        let materials = materials.collect();
        let mut layers = [LayerUniform::default(); MAX_FIELDS];
        for (uniform, (layer, field)) in layers.iter_mut().zip(fields()) {
            *uniform = LayerUniform {
                blend: if has_effect(layer) { blend_number(layer.blend) } else { NO_EFFECT },
                is_label: u32::from(field.volume().shown_labels().is_some()),
                opacity_unit: layer.opacity_unit_in_scene(scene) as f32,
                edges: layer.edges as f32,
                ignores_cuts: u32::from(layer.is_never_cut()),
                ..LayerUniform::default()
            };
        }
        let count = fields().count() as u32;
        let parameters =
            LayersUniform { count, largest: 0.0, voxel: scene.mean_edge() as f32, pad0: 0, layers };
        let mut baked = Self { tables, materials, parameters: Some(Box::new(parameters)), are_tints: false };
        baked.update_materials();
        baked
    }

    /// Writes the materials into the parameters, with the opacities or extinctions that the tables have.
    fn update_materials(&mut self) {
        let length = self.opacity_length();
        let Some(parameters) = &mut self.parameters else { return };
        for (layer, materials) in parameters.layers.iter_mut().zip(&self.materials) {
            layer.material_count = materials.len() as u32;
            for (uniform, material) in layer.materials.iter_mut().zip(materials) {
                *uniform = material.uniform(length);
            }
        }
    }

    /// Returns true if the layers are those that tint.
    pub(crate) fn are_tints(&self) -> bool {
        self.are_tints
    }

    /// Returns the layers whose voxels a mask hides.
    pub(crate) fn mask_use(&self) -> MaskUse {
        let layers = self.parameters.as_ref().map_or(&[][..], |parameters| &parameters.layers);
        if self.are_tints {
            MaskUse::Unused
        } else if layers.iter().any(|layer| layer.ignores_cuts == 1) {
            MaskUse::SomeLayers
        } else {
            MaskUse::AllLayers
        }
    }

    /// Returns the tables for one colour of light.
    pub(crate) fn for_light_color(&self, color: usize) -> Self {
        let mut of_color = self.clone();
        of_color.tables = self.tables.iter().map(|table| table.for_light_color(color)).collect();
        for material in of_color.materials.iter_mut().flatten() {
            *material = material.for_light_color(color);
        }
        of_color.update_materials();
        of_color
    }

    /// Returns the parameters of layers, if voxels are composed of them.
    pub(crate) fn parameters(&self) -> Option<&LayersUniform> {
        self.parameters.as_deref()
    }

    /// Returns the tables as the shaders read them, one after the other.
    pub(crate) fn to_f32s(&self) -> Vec<f32> {
        match self.opacity_length() {
            None => self.tables.iter().flat_map(BakedTransfer::to_f32s).collect(),
            Some(length) => {
                self.tables.iter().flat_map(|table| table.with_opacities(length).to_f32s()).collect()
            }
        }
    }

    /// Returns the table that converts relative extinction of pre-classified voxels to extinction.
    pub(crate) fn conversion_table(&self, is_crisp: bool) -> BakedTransfer {
        match &self.tables[..] {
            [table] if is_crisp => table.crisp_ramp(),
            _ => match self.opacity_length() {
                None => BakedTransfer::linear_ramp(self.max_extinction()),
                Some(length) => BakedTransfer::opacity_ramp(self.max_extinction(), length),
            },
        }
    }

    /// Returns the maximum extinction of any densities, per scene unit.
    pub(crate) fn max_extinction(&self) -> f32 {
        let of_layer = |(at, table): (usize, &BakedTransfer)| match self.materials.get(at) {
            Some(materials) if !materials.is_empty() => materials.iter().map(MaterialTable::extinction).sum(),
            _ => table.max_extinction(),
        };
        self.with_matter().map(of_layer).sum()
    }

    /// Returns true if the lowest densities have extinction.
    pub(crate) fn is_lowest_visible(&self) -> bool {
        self.with_matter().any(|(_, table)| table.is_lowest_visible())
    }

    /// Returns a test for matter at any density of a range.
    pub(crate) fn visibility_test(&self) -> impl Fn([f32; 2]) -> bool + use<> {
        let tests: Vec<_> = self.with_matter().map(|(_, table)| table.visibility_test()).collect();
        move |[low, high]| tests.iter().any(|is_visible| is_visible(low, high))
    }

    /// Returns true if other layers have matter at the same densities.
    pub(crate) fn has_same_visibility(&self, other: &Self) -> bool {
        let (mut own, mut others) = (self.with_matter(), other.with_matter());
        loop {
            match (own.next(), others.next()) {
                (None, None) => return true,
                (Some((at, a)), Some((b_at, b))) if at == b_at && a.has_same_visibility(b) => {}
                _ => return false,
            }
        }
    }

    /// Returns true if voxels classified with other layers are the same.
    pub(crate) fn has_same_matter(&self, other: &Self) -> bool {
        let entries = |layers: &Self| layers.tables.len();
        entries(self) == entries(other)
            && self.are_tints == other.are_tints
            && self.parameters == other.parameters
            && self.tables.iter().zip(&other.tables).all(|(a, b)| a.entries == b.entries)
    }

    /// Returns the bricks and cells in which any layer has extinction.
    pub(crate) fn occupancy(&self, volume: &GpuVolume, bounded: bool) -> CellOccupancy {
        let Some(texture) = volume.fields.as_ref().filter(|_| self.parameters.is_some()) else {
            return occupancy_of(&volume.volume, &volume.bricks, &self.tables[0], bounded);
        };
        let mut found: Option<CellOccupancy> = None;
        for (at, table) in self.with_matter() {
            let field = &texture.fields[at];
            let of_layer = occupancy_of(field.volume(), field.bricks(), table, bounded);
            match &mut found {
                None => found = Some(of_layer),
                Some(found) => {
                    found.bricks.iter_mut().zip(of_layer.bricks).for_each(|(any, member)| *any |= member);
                    found.cells.iter_mut().zip(of_layer.cells).for_each(|(any, mask)| *any |= mask);
                }
            }
        }
        let bricks = volume.bricks.dims.iter().product();
        found.unwrap_or_else(|| CellOccupancy { bricks: vec![false; bricks], cells: vec![0; bricks] })
    }

    /// Returns the layers with matter of their own, or those that tint, with their indices.
    fn with_matter(&self) -> impl Iterator<Item = (usize, &BakedTransfer)> {
        let counted: Vec<u32> = LayerBlend::ALL
            .into_iter()
            .filter(|blend| if self.are_tints { blend.changes_color_alone() } else { blend.adds_matter() })
            .map(blend_number)
            .collect();
        let counts = move |at: usize| {
            let parameters = self.parameters.as_ref();
            parameters.is_none_or(|layers| counted.contains(&layers.layers[at].blend))
        };
        self.tables.iter().enumerate().filter(move |(at, _)| counts(*at))
    }
}

/// Number of a layer without effect in `shaders/volume/layers.wgsl`: a hidden gate removes nothing.
const NO_EFFECT: u32 = 3;

/// Returns the number of a blend in `shaders/volume/layers.wgsl`.
fn blend_number(blend: LayerBlend) -> u32 {
    match blend {
        LayerBlend::Add => 0,
        LayerBlend::Tint => 1,
        LayerBlend::Gate => 2,
        LayerBlend::Red => 4,
        LayerBlend::Green => 5,
        LayerBlend::Blue => 6,
    }
}

/// Returns the bricks and cells in which a transfer function has extinction: all cells of such bricks unless the cells'
/// bounds hold (`bounded`). Labels are looked up voxel by voxel: ranges of their numbers would include others that are
/// visible.
fn occupancy_of(volume: &Volume, known: &BrickBounds, baked: &BakedTransfer, bounded: bool) -> CellOccupancy {
    let mut found = if volume.shown_labels().is_some() {
        CellOccupancy::from_labels(volume, known, baked.exact_visibility_test())
    } else {
        let cells = if bounded { known.cell_masks(baked.visibility_test()) } else { Vec::new() };
        CellOccupancy { bricks: known.occupancy(baked.visibility_test()), cells }
    };
    if !bounded {
        found.cells = found.bricks.iter().map(|&member| if member { u64::MAX } else { 0 }).collect();
    }
    found
}
