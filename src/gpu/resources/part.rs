//! Division of work into parts of equal size.

/// Part `index`, from 0, of `of` parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Part {
    pub index: u32,
    pub of: u32,
}

impl Part {
    /// Returns true for the first part.
    pub(crate) fn is_first(self) -> bool {
        self.index == 0
    }

    /// Returns true for the last part.
    pub(crate) fn is_last(self) -> bool {
        self.index + 1 == self.of
    }

    /// Returns the elements of a list that belong to this part.
    pub(crate) fn take<T>(self, list: &[T]) -> &[T] {
        let end_of = |parts: u32| list.len() * parts as usize / self.of as usize;
        &list[end_of(self.index)..end_of(self.index + 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_up_the_whole() {
        let list = [1, 2, 3, 4, 5];
        let parts: Vec<_> = (0..3).map(|index| Part { index, of: 3 }.take(&list).to_vec()).collect();
        assert_eq!(parts.concat(), list);
        assert_eq!(Part { index: 0, of: 1 }.take(&list), list);
        assert!(Part { index: 2, of: 3 }.is_last() && !Part { index: 1, of: 3 }.is_first());
    }
}
