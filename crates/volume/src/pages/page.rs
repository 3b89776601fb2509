//! Page: the prefiltered densities of 64³ voxels with a border, and the bounds of cells that see them.

use std::ops::Range;

use super::PageSource;
use super::levels::{PAGE_EDGE, PageAddress};
use crate::LoadError;
use crate::occupancy::bricks::CellRanges;
use crate::occupancy::cells::CELL_EDGE;

/// Width of the border that is stored around a page, in voxels: gradients are differences over two voxels to either
/// side, and a trilinear fetch sees one more.
pub const PAGE_BORDER: usize = 3;

/// Edge of a stored page, in texels.
pub const PAGE_STORED_EDGE: usize = PAGE_EDGE + 2 * PAGE_BORDER;

/// Width of the border that is read around a page, in voxels: prefiltering sees one voxel beyond those that are stored.
pub const PAGE_READ_MARGIN: usize = PAGE_BORDER + 1;

/// Edge of the box that is read, in voxels.
const READ_EDGE: usize = PAGE_EDGE + 2 * PAGE_READ_MARGIN;

/// Reach of the kernel of a sample, in voxels of its own level.
const KERNEL_REACH: isize = 2;

/// Cube of 64³ voxels of a level, in a form for the graphics adapter.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Prefiltered densities with their border, 70³ of them, x fastest, as normalised integers; none if nothing of them is
    /// visible, or all are the same.
    pub texels: Vec<u16>,
    /// Minimum and maximum density of all voxels that were read.
    pub range: [f32; 2],
    /// Densities that samples can see in the cells of the volume in memory; none if all are the same.
    pub cells: CellRanges,
}

impl Page {
    /// Reads the voxels of a page and prepares them; texels only if they differ and `is_visible` holds for the range of their
    /// densities.
    /// Beyond the grid its border is repeated.
    ///
    /// # Errors
    /// Fails like [`PageSource::read`].
    pub fn from_source(
        source: &dyn PageSource,
        address: PageAddress,
        is_visible: impl Fn([f32; 2]) -> bool,
    ) -> Result<Self, LoadError> {
        let level = &source.levels().0[address.level];
        let low = address.at.map(|at| (at * PAGE_EDGE) as isize - PAGE_READ_MARGIN as isize);
        let region: [Range<usize>; 3] = std::array::from_fn(|axis| {
            let end = low[axis] + READ_EDGE as isize;
            low[axis].max(0) as usize..(end as usize).min(level.dims[axis])
        });
        let voxels = source.read(address.level, &region)?;
        let range = range_of(&voxels);
        if range[0] >= range[1] {
            return Ok(Self { texels: Vec::new(), range, cells: CellRanges::default() });
        }
        let read = with_repeated_border(&voxels, low, &region);
        let cells = cell_ranges(&read, low, level.per_voxel);
        let texels = if Self::has_texels(range, is_visible) { prefiltered(read) } else { Vec::new() };
        Ok(Self { texels, range, cells })
    }

    /// Returns true if pages with this range of densities have texels: if the densities differ, and show something.
    pub fn has_texels(range: [f32; 2], is_visible: impl Fn([f32; 2]) -> bool) -> bool {
        range[0] < range[1] && is_visible(range)
    }

    /// Returns the size of the stored texels, in bytes.
    pub const fn bytes() -> u64 {
        2 * STORED_TEXELS as u64
    }
}

/// Number of texels of a stored page.
const STORED_TEXELS: usize = PAGE_STORED_EDGE * PAGE_STORED_EDGE * PAGE_STORED_EDGE;

fn stored(density: f32) -> u16 {
    (density.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16
}

fn range_of(values: &[f32]) -> [f32; 2] {
    // In one pass each, which compilers turn into vector instructions.
    let low = values.iter().fold(f32::INFINITY, |low, &d| if d < low { d } else { low });
    let high = values.iter().fold(f32::NEG_INFINITY, |high, &d| if d > high { d } else { high });
    [low, high]
}

/// Copies the voxels of a region into the box that begins at `low`, and repeats its outermost voxels beyond.
fn with_repeated_border(voxels: &[f32], low: [isize; 3], region: &[Range<usize>; 3]) -> Vec<f32> {
    let size = region.each_ref().map(ExactSizeIterator::len);
    let within = |axis: usize, c: usize| {
        let place = low[axis] + c as isize - region[axis].start as isize;
        place.clamp(0, size[axis] as isize - 1) as usize
    };
    let before = (region[0].start as isize - low[0]) as usize;
    let mut read = Vec::with_capacity(READ_EDGE.pow(3));
    for z in 0..READ_EDGE {
        for y in 0..READ_EDGE {
            let row = &voxels[size[0] * (within(1, y) + size[1] * within(2, z))..][..size[0]];
            read.resize(read.len() + before, row[0]);
            read.extend_from_slice(row);
            read.resize(read.len() + READ_EDGE - before - size[0], row[size[0] - 1]);
        }
    }
    read
}

/// Blurs a read box with [1, 10, 1]/12 along each axis, so that a trilinear fetch has the variance of a cubic B-spline
/// (`shaders/volume/prefilter.wgsl`), and cuts it to the stored texels.
fn prefiltered(read: Vec<f32>) -> Vec<u16> {
    const MIDDLE: f32 = 10.0 / 12.0;
    const SIDE: f32 = 1.0 / 12.0;
    let (mut source, mut blurred) = (read.clone(), read);
    for stride in [1, READ_EDGE, READ_EDGE * READ_EDGE] {
        let last = source.len() - stride;
        // Texels at the sides of the box mix with those of another row; they are cut off below.
        let sides = source[..last - stride].iter().zip(&source[2 * stride..]);
        for ((target, middle), (before, behind)) in
            blurred[stride..last].iter_mut().zip(&source[stride..last]).zip(sides)
        {
            *target = MIDDLE * middle + SIDE * (before + behind);
        }
        std::mem::swap(&mut source, &mut blurred);
    }
    let inner = 1..=PAGE_STORED_EDGE;
    let mut texels = Vec::with_capacity(STORED_TEXELS);
    for z in inner.clone() {
        for y in inner.clone() {
            let row = &source[READ_EDGE * (y + READ_EDGE * z)..][..READ_EDGE];
            texels.extend(row[inner.clone()].iter().copied().map(stored));
        }
    }
    texels
}

/// Returns the cells of the volume in memory, first and last along an axis, with samples whose kernel reaches a voxel of a
/// level that has `per_voxel` voxels in the edge of one in memory.
fn cells_around(voxel: isize, per_voxel: usize) -> [isize; 2] {
    let cell = |place: f64| (((place + 0.5) / per_voxel as f64 - 0.5) / CELL_EDGE as f64).floor() as isize;
    [voxel - KERNEL_REACH, voxel + KERNEL_REACH].map(|place| cell(place as f64))
}

/// Returns the ranges of densities that samples can see in each cell of the volume in memory, from a box that begins at
/// `low`. Cells before the grid count as its first.
fn cell_ranges(read: &[f32], low: [isize; 3], per_voxel: [usize; 3]) -> CellRanges {
    let spans: [Vec<[usize; 2]>; 3] = std::array::from_fn(|axis| {
        let around = |c: usize| cells_around(low[axis] + c as isize, per_voxel[axis]);
        (0..READ_EDGE).map(|c| around(c).map(|cell| cell.max(0) as usize)).collect()
    });
    let first = spans.each_ref().map(|spans| spans[0][0]);
    let dims = [0, 1, 2].map(|axis| spans[axis][READ_EDGE - 1][1] - first[axis] + 1);
    let (mut lows, mut highs) = (read.to_vec(), read.to_vec());
    let mut shape = [READ_EDGE; 3];
    // Axis by axis the box shrinks from voxels to cells: z first, whose slices lie in one piece.
    for axis in [2, 1, 0] {
        let inner: usize = shape[..axis].iter().product();
        let outer: usize = shape[axis + 1..].iter().product();
        let count = inner * dims[axis] * outer;
        let (mut least, mut most) = (vec![f32::INFINITY; count], vec![f32::NEG_INFINITY; count]);
        for o in 0..outer {
            for (c, [begin, end]) in spans[axis].iter().enumerate() {
                let from = inner * (c + READ_EDGE * o)..inner * (c + 1 + READ_EDGE * o);
                for cell in *begin..=*end {
                    let to = inner * (cell - first[axis] + dims[axis] * o);
                    let pairs = least[to..to + inner].iter_mut().zip(&lows[from.clone()]);
                    pairs.for_each(|(wide, &low)| *wide = if low < *wide { low } else { *wide });
                    let pairs = most[to..to + inner].iter_mut().zip(&highs[from.clone()]);
                    pairs.for_each(|(wide, &high)| *wide = if high > *wide { high } else { *wide });
                }
            }
        }
        shape[axis] = dims[axis];
        (lows, highs) = (least, most);
    }
    let ranges = lows.into_iter().zip(highs).map(|(low, high)| [low, high]).collect();
    CellRanges { first, dims, ranges }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FinerLevel, FinerLevels};

    /// Level of a ramp along x with a single bright voxel.
    #[derive(Debug)]
    struct RampSource {
        levels: FinerLevels,
        bright: [usize; 3],
    }

    impl PageSource for RampSource {
        fn levels(&self) -> &FinerLevels {
            &self.levels
        }

        fn read(&self, level: usize, region: &[Range<usize>; 3]) -> Result<Vec<f32>, LoadError> {
            let width = self.levels.0[level].dims[0] as f32;
            let [xs, ys, zs] = region.clone();
            let mut densities = Vec::new();
            for z in zs {
                for y in ys.clone() {
                    densities.extend(
                        xs.clone().map(
                            |x| {
                                if [x, y, z] == self.bright { 1.0 } else { x as f32 / (2.0 * width) }
                            },
                        ),
                    );
                }
            }
            Ok(densities)
        }
    }

    fn source() -> RampSource {
        let level = FinerLevel { dims: [150, 70, 40], per_voxel: [2, 2, 1], key: "0".to_owned() };
        RampSource { levels: FinerLevels(vec![level]), bright: [70, 66, 30] }
    }

    fn page(at: [usize; 3]) -> Page {
        Page::from_source(&source(), PageAddress { level: 0, at }, |_| true).unwrap()
    }

    #[test]
    fn texels_are_the_prefiltered_voxels_with_a_border() {
        let page = page([1, 0, 0]);
        assert_eq!(page.texels.len(), PAGE_STORED_EDGE.pow(3));
        let texel = |place: [isize; 3]| {
            let [x, y, z] = place.map(|c| (c + PAGE_BORDER as isize) as usize);
            f32::from(page.texels[x + PAGE_STORED_EDGE * (y + PAGE_STORED_EDGE * z)]) / 65535.0
        };
        for x in [-3, 0, 17, 66] {
            let wanted = (64 + x) as f32 / 300.0;
            assert!((texel([x, 20, 10]) - wanted).abs() < 2e-5, "a ramp stays as it is");
        }
        let ramp = 70.0 / 300.0;
        let middle = texel([6, 66, 30]);
        assert!((middle - (ramp + (1.0 - ramp) * (5.0f32 / 6.0).powi(3))).abs() < 2e-5, "{middle}");
        assert!(texel([7, 65, 29]) > 71.0 / 300.0 + 1e-4, "the corner beside the voxel sees it");
        // Beyond the grid, which ends after 40 slices.
        assert_eq!(texel([20, 20, 50]), texel([20, 20, 39]));
    }

    #[test]
    fn cells_know_every_voxel_that_a_sample_in_them_can_see() {
        let source = source();
        let page = page([1, 1, 0]);
        let bright = source.bright;
        for offset in [[-1.9, 0.0, 0.0], [0.0, 1.9, 0.0], [0.4, -1.2, 1.9]] {
            // Sample whose kernel reaches the bright voxel.
            let cell: [usize; 3] = std::array::from_fn(|axis| {
                let place: f64 = bright[axis] as f64 + offset[axis];
                let per = source.levels.0[0].per_voxel[axis] as f64;
                (((place + 0.5) / per - 0.5) / 2.0).floor() as usize
            });
            assert_eq!(page.cells.get(cell).unwrap()[1], 1.0, "{offset:?}");
        }
        let far = [bright[0] / 4 + 4, bright[1] / 4, bright[2] / 2];
        assert!(page.cells.get(far).unwrap()[1] < 0.5, "a cell eight voxels away does not see it");
        assert_eq!(page.range[1], 1.0);
    }
}
