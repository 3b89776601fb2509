//! Up axis of objects whose file states none: decides which end of the object along the scene's z axis goes down.
//!
//! Scans of heads, plants and parts often begin at what is above. Without strong evidence nothing is turned.

use glam::DVec3;

use super::super::domain::DataDomain;
use super::super::object::VisibleObject;
use super::super::transfer::{self, SkinVeil, TransferStyle};
use super::cross_section::{MaterialStarts, enclosed_share};
use crate::{SceneAxis, Settings};
use chiaroscuro_volume::{DataKind, Histogram, Volume};

/// Smallest section at a face of the volume, as a share of the object's median section, that is a cut end: a neck has
/// half of a head's section and more, a base that only touches the face less.
const MIN_CUT_SHARE: f64 = 0.3;

/// Largest such share of a free end: noise, or hair that touches the face.
const MAX_FREE_SHARE: f64 = 0.03;

/// Largest such share of each of the four other faces: an object that is cut there as well is a piece of something
/// larger, which may go on upwards. Holders and tables beside a head have less.
const MAX_SIDE_SHARE: f64 = 0.5;

/// Smallest compactness and smallest share of the largest part of objects that stand: nets and trees grow in any
/// direction, and pieces do not stand together. A bust of forty cells has 0.93 and 1.
const MIN_COMPACTNESS: f64 = 0.6;
const MIN_LARGEST_PART: f64 = 0.8;

/// Smallest area that dense material encloses in a section through a braincase, as a share of the section, and the
/// largest one in a section through a neck or a limb: brains take two thirds, spinal canals and marrow a fiftieth.
const MIN_BRAINCASE_SHARE: f64 = 0.4;
const MAX_NECK_SHARE: f64 = 0.1;

/// Height of the lowest and highest part of an object, as a share of its height.
const END_HEIGHT: f64 = 0.03;

/// Largest width of a tip in both directions, as a share of the object's, and the smallest width and the smallest
/// filled share of a base: a cone has 0.03 at its tip, a ball a third at either end, and nothing stands on less than a
/// sixth.
const MAX_TIP_WIDTH: f64 = 0.15;
const MIN_BASE_WIDTH: f64 = 0.8;
const MIN_BASE_FILL: f64 = 0.5;

/// Returns the axis of the scene that points up in a look at an object without orientation: −z if it stands on its
/// head.
///
/// A cut end, such as a neck, goes down where the other end is free; of two cut ends the one where dense material
/// encloses the section, a braincase, goes up; of two free ones the tip of a cone. Otherwise +z points up.
pub(crate) fn find_up_axis(
    look: &Settings,
    volume: &Volume,
    histogram: &Histogram,
    kind: DataKind,
    found: (DataDomain, TransferStyle),
) -> SceneAxis {
    let (domain, style) = found;
    // Fields, cells and molecules have no upper end, nor have slices that are seen as pictures.
    let is_thing = match domain {
        DataDomain::Simulation | DataDomain::Fluorescence | DataDomain::Molecule => false,
        _ => !matches!(kind, DataKind::Signed | DataKind::DarkOnBright),
    };
    if !is_thing || style == TransferStyle::Picture || super::slice_view(volume).is_some() {
        return SceneAxis::PlusZ;
    }
    let shown = &look.layer().transfer;
    let body = match kind {
        // Bones end within the body, which is what stands.
        DataKind::HounsfieldCt { water } if domain == DataDomain::Bone => {
            SkinVeil { water }.add_to(shown, 1.0)
        }
        _ => shown.clone(),
    };
    let body = look.clone().with_transfer(transfer::opaque_transfer(&body));
    let Some(axis) = VerticalAxis::find(volume) else { return SceneAxis::PlusZ };
    let object = VisibleObject::from_settings(&body, volume);
    let Some([bottom, top]) = axis.measure_ends(&object) else { return SceneAxis::PlusZ };
    let is_cut = |end: &ObjectEnd| end.cut_share >= MIN_CUT_SHARE;
    let is_free = |end: &ObjectEnd| end.cut_share <= MAX_FREE_SHARE;
    let is_upside_down = if is_cut(&top) && is_cut(&bottom) {
        let starts = MaterialStarts::find(&body, volume, histogram);
        let [below, above] =
            [false, true].map(|is_top| enclosed_share(volume, axis.axis, is_top != axis.is_reversed, starts));
        below >= MIN_BRAINCASE_SHARE && above <= MAX_NECK_SHARE
    } else if is_free(&top) && is_free(&bottom) {
        bottom.is_tip() && top.is_base()
    } else {
        is_cut(&top) && is_free(&bottom)
    };
    if is_upside_down { SceneAxis::MinusZ } else { SceneAxis::PlusZ }
}

/// Index axis along which the scene's z axis runs.
#[derive(Debug, Clone, Copy)]
struct VerticalAxis {
    axis: usize,
    /// True if indices grow downwards.
    is_reversed: bool,
}

/// End of an object along the vertical axis.
#[derive(Debug, Clone, Copy)]
struct ObjectEnd {
    /// Section at the face of the volume, as a share of the object's median section.
    cut_share: f64,
    /// Extents of the end in both horizontal directions, as shares of the object's.
    extents: [f64; 2],
    /// Share of the bounding box of the end that its cells fill, seen from above.
    fill: f64,
}

impl ObjectEnd {
    fn is_tip(&self) -> bool {
        self.extents.iter().all(|&extent| extent <= MAX_TIP_WIDTH)
    }

    fn is_base(&self) -> bool {
        self.extents.iter().all(|&extent| extent >= MIN_BASE_WIDTH) && self.fill >= MIN_BASE_FILL
    }
}

impl VerticalAxis {
    /// Finds the axis; `None` where slices are more than 25° oblique, and their faces cut neither above nor below.
    fn find(volume: &Volume) -> Option<Self> {
        let upwards =
            volume.scene().scene_from_index.inverse().transform_vector3(DVec3::Z).normalize_or_zero();
        let along = upwards.abs();
        let axis = (0..3).max_by(|&a, &b| along[a].total_cmp(&along[b]))?;
        (along[axis] > 25.0f64.to_radians().cos()).then_some(Self { axis, is_reversed: upwards[axis] < 0.0 })
    }

    fn horizontal_axes(self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// Measures the lower and the upper end; `None` for an object that does not stand: nothing, a net, several pieces,
    /// or a piece cut out of something larger.
    fn measure_ends(self, object: &VisibleObject) -> Option<[ObjectEnd; 2]> {
        if object.is_empty()
            || object.compactness() < MIN_COMPACTNESS
            || object.largest_part_share() < MIN_LARGEST_PART
        {
            return None;
        }
        let layers = [0, 1, 2].map(|axis| LayerAreas::count(object, axis));
        if self.horizontal_axes().iter().any(|&axis| {
            let sides = layers[axis].face_shares();
            sides[0].max(sides[1]) > MAX_SIDE_SHARE
        }) {
            return None;
        }
        let own = &layers[self.axis];
        let [low, high] = own.occupied_range()?;
        let height = (((high + 1 - low) as f64 * END_HEIGHT).ceil() as usize).max(1);
        let whole = self.extents_of(object, [low, high]).map(|(extent, _)| extent);
        let shares = own.face_shares();
        let end = |layers: [usize; 2], cut_share: f64| {
            let [(width, _), (depth, filled)] = self.extents_of(object, layers);
            ObjectEnd {
                cut_share,
                extents: [width / whole[0], depth / whole[1]],
                fill: filled / (width * depth),
            }
        };
        let [below, above] =
            [end([low, low + height - 1], shares[0]), end([high + 1 - height, high], shares[1])];
        Some(if self.is_reversed { [above, below] } else { [below, above] })
    }

    /// Returns the extents of an object's cells within a range of layers in both horizontal directions, each with the
    /// number of columns that hold a cell.
    fn extents_of(self, object: &VisibleObject, [low, high]: [usize; 2]) -> [(f64, f64); 2] {
        let [u, v] = self.horizontal_axes();
        let (mut first, mut last) = ([usize::MAX; 2], [0; 2]);
        let mut columns = vec![false; object.cells[u] * object.cells[v]];
        for cell in object.occupied_cells().filter(|cell| (low..=high).contains(&cell[self.axis])) {
            columns[cell[v] * object.cells[u] + cell[u]] = true;
            first = [first[0].min(cell[u]), first[1].min(cell[v])];
            last = [last[0].max(cell[u]), last[1].max(cell[v])];
        }
        let count = columns.iter().filter(|is_there| **is_there).count() as f64;
        [0, 1].map(|at| ((last[at] + 1).saturating_sub(first[at]) as f64, count))
    }
}

/// Number of cells that an object occupies in each layer along an axis.
struct LayerAreas(Vec<usize>);

impl LayerAreas {
    fn count(object: &VisibleObject, axis: usize) -> Self {
        let mut areas = vec![0; object.cells[axis]];
        object.occupied_cells().for_each(|cell| areas[cell[axis]] += 1);
        Self(areas)
    }

    fn occupied_range(&self) -> Option<[usize; 2]> {
        let is_occupied = |area: &usize| *area > 0;
        Some([self.0.iter().position(is_occupied)?, self.0.iter().rposition(is_occupied)?])
    }

    /// Returns the areas on the first and the last face, as shares of the median of the layers that are not empty.
    fn face_shares(&self) -> [f64; 2] {
        let mut areas: Vec<usize> = self.0.iter().copied().filter(|&area| area > 0).collect();
        areas.sort_unstable();
        let median = areas.get(areas.len() / 2).copied().unwrap_or(1) as f64;
        [self.0.first(), self.0.last()].map(|area| area.copied().unwrap_or(0) as f64 / median)
    }
}
