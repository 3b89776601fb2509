//! Copies of the elements that a block and a wanted box of an array share.

/// Box of an array that is copied to memory, with the place of its elements there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ElementBox {
    /// First element along each dimension of the array, slowest first.
    pub(super) low: Vec<u64>,
    /// Elements along each dimension.
    pub(super) counts: Vec<u64>,
    /// Bytes from one element to the next along each dimension, in memory.
    pub(super) strides: Vec<usize>,
    /// Bytes of an element.
    pub(super) element: usize,
}

impl ElementBox {
    /// Copies the elements of a block that begins at `low` and has the given shape. Elements that the block or the
    /// memory lacks are left out.
    pub(super) fn copy_from(&self, block: &[u8], low: &[u64], shape: &[u64], memory: &mut [u8]) {
        let rank = self.low.len();
        let element = self.element;
        let (mut counts, mut from, mut to, mut steps) = (vec![1; rank], 0usize, 0usize, vec![0usize; rank]);
        let mut step = element;
        for axis in (0..rank).rev() {
            let first = low[axis].max(self.low[axis]);
            let end =
                (low[axis].saturating_add(shape[axis])).min(self.low[axis].saturating_add(self.counts[axis]));
            let Some(count) = end.checked_sub(first).filter(|&count| count > 0) else { return };
            counts[axis] = count as usize;
            steps[axis] = step;
            from += (first - low[axis]) as usize * step;
            to += (first - self.low[axis]) as usize * self.strides[axis];
            step = step.saturating_mul(shape[axis] as usize);
        }
        // Rows are copied at once where they are whole in memory, too.
        let last = rank.checked_sub(1);
        let (row, stride) = last.map_or((1, element), |last| (counts[last], self.strides[last]));
        let mut place = vec![0usize; rank.saturating_sub(1)];
        loop {
            if row == 1 || stride == element {
                if let (Some(source), Some(target)) =
                    (block.get(from..from + row * element), memory.get_mut(to..to + row * element))
                {
                    target.copy_from_slice(source);
                }
            } else if let (Some(source), Some(target)) =
                (block.get(from..from + row * element), memory.get_mut(to..))
            {
                for (source, target) in source.chunks_exact(element).zip(target.chunks_mut(stride)) {
                    target[..element].copy_from_slice(source);
                }
            }
            let Some(axis) = (0..place.len()).rev().find(|&axis| place[axis] + 1 < counts[axis]) else {
                return;
            };
            for after in axis + 1..place.len() {
                from -= place[after] * steps[after];
                to -= place[after] * self.strides[after];
                place[after] = 0;
            }
            place[axis] += 1;
            from += steps[axis];
            to += self.strides[axis];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_elements_are_copied_in_both_orders() {
        // A block of 2 x 3 elements at (1, 2) of an array, whose numbers are 10 times the row plus the column.
        let block = [12, 13, 14, 22, 23, 24];
        let (low, shape) = ([1, 2], [2, 3]);
        let mut rows = ElementBox { low: vec![0, 0], counts: vec![3, 4], strides: vec![4, 1], element: 1 };
        let mut memory = [0; 12];
        rows.copy_from(&block, &low, &shape, &mut memory);
        assert_eq!(memory, [0, 0, 0, 0, 0, 0, 12, 13, 0, 0, 22, 23]);
        rows.strides = vec![1, 3];
        let mut columns = [0; 12];
        rows.copy_from(&block, &low, &shape, &mut columns);
        assert_eq!(columns, [0, 0, 0, 0, 0, 0, 0, 12, 22, 0, 13, 23]);
        rows.low = vec![3, 0];
        rows.copy_from(&block, &low, &shape, &mut columns);
        assert_eq!(columns[7], 12, "nothing is shared");
    }
}
