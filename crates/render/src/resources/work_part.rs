//! Division of work into parts of equal size.

/// Part `index`, from 0, of `count` parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct WorkPart {
    pub index: u32,
    pub count: u32,
}

impl WorkPart {
    /// Returns true for the first part.
    pub(crate) fn is_first(self) -> bool {
        self.index == 0
    }

    /// Returns true for the last part.
    pub(crate) fn is_last(self) -> bool {
        self.index + 1 == self.count
    }

    /// Returns the elements of a list that belong to this part.
    pub(crate) fn slice<T>(self, list: &[T]) -> &[T] {
        let end_of = |parts: u32| list.len() * parts as usize / self.count as usize;
        &list[end_of(self.index)..end_of(self.index + 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_up_the_whole() {
        let list = [1, 2, 3, 4, 5];
        let parts: Vec<_> = (0..3).map(|index| WorkPart { index, count: 3 }.slice(&list).to_vec()).collect();
        assert_eq!(parts.concat(), list);
        assert_eq!(WorkPart { index: 0, count: 1 }.slice(&list), list);
        assert!(WorkPart { index: 2, count: 3 }.is_last() && !WorkPart { index: 1, count: 3 }.is_first());
    }
}
