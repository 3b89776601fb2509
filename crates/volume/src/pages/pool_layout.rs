//! Layout of pages in the slots of one texture.

use super::page::PAGE_STORED_EDGE;

/// Edges that a texture of pages may have, in texels: powers of two, so that texture coordinates are exact, and pictures do not
/// depend on the slots in which their pages are.
const EDGES: [usize; 5] = [128, 256, 512, 1024, 2048];

/// Size of a texel, in bytes.
const TEXEL_BYTES: u64 = 2;

/// Box of slots in a texture of pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PoolLayout {
    /// Edges of the texture, in texels.
    pub edges: [usize; 3],
}

impl PoolLayout {
    /// Returns all layouts with edges of at most `longest`.
    fn all(longest: usize) -> impl Iterator<Item = Self> {
        let boxes = EDGES.into_iter().flat_map(|x| {
            let flatter = EDGES.into_iter().take_while(move |y| *y <= x);
            flatter.flat_map(move |y| {
                EDGES.into_iter().take_while(move |z| *z <= y).map(move |z| Self { edges: [x, y, z] })
            })
        });
        boxes.filter(move |layout| layout.edges[0] <= longest.max(EDGES[0]))
    }

    /// Returns the smallest layout for a number of pages, with edges of at most `longest`; the largest if none holds them.
    pub fn for_pages(count: usize, longest: usize) -> Self {
        let by_size = |layout: &Self| (layout.bytes(), layout.edges[0]);
        let fitting = Self::all(longest).filter(|layout| layout.page_count() >= count).min_by_key(by_size);
        fitting.or_else(|| Self::all(longest).max_by_key(by_size)).unwrap_or(Self { edges: [EDGES[0]; 3] })
    }

    /// Returns the number of pages that a texture of at most `bytes` holds.
    pub fn max_pages(bytes: u64) -> usize {
        let within = Self::all(usize::MAX).filter(|layout| layout.bytes() <= bytes);
        within.map(|layout| layout.page_count()).max().unwrap_or(0)
    }

    /// Returns the number of slots along x, y and z.
    pub fn slots(&self) -> [usize; 3] {
        self.edges.map(|edge| edge / PAGE_STORED_EDGE)
    }

    /// Returns the number of pages that have a slot.
    pub fn page_count(&self) -> usize {
        self.slots().iter().product()
    }

    /// Returns the size of the texture, in bytes.
    pub fn bytes(&self) -> u64 {
        self.edges.iter().product::<usize>() as u64 * TEXEL_BYTES
    }

    /// Returns the place of a slot, counted along x, y and z.
    pub fn slot_place(&self, slot: usize) -> [usize; 3] {
        let [nx, ny, _] = self.slots();
        [slot % nx, slot / nx % ny, slot / (nx * ny)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_fill_the_smallest_box_within_the_limit() {
        let edges = |count: usize, longest: usize| PoolLayout::for_pages(count, longest).edges;
        assert_eq!(edges(1, 2048), [128, 128, 128]);
        assert_eq!(edges(27, 2048), [256, 256, 256]);
        assert_eq!(edges(28, 2048), [512, 256, 256]);
        assert_eq!(edges(1_000_000, 512), [512, 512, 512]);
        assert_eq!(PoolLayout { edges: [512, 256, 256] }.slot_place(7 + 2 * 21 + 7 * 2 + 3), [3, 0, 3]);
    }

    #[test]
    fn budgets_are_kept() {
        assert_eq!([0, 1 << 20, 4 << 20, 8 << 20].map(PoolLayout::max_pages), [0, 0, 1, 3]);
        for mebibytes in [16, 100, 256, 1024, 5000] {
            let count = PoolLayout::max_pages(mebibytes << 20);
            assert!(PoolLayout::for_pages(count, 2048).bytes() <= mebibytes << 20);
            assert!(PoolLayout::for_pages(count + 1, 2048).bytes() > mebibytes << 20);
        }
    }
}
