//! Cache entry: a GPU product with the key it was made from.

/// Product with the key of its inputs, and a flag for its completeness. It is valid for requests with the same key,
/// and stale for all others.
#[derive(Debug)]
pub(crate) struct Cached<K, T> {
    key: K,
    is_complete: bool,
    /// Product itself, complete or in progress.
    pub value: T,
}

impl<K: PartialEq, T> Cached<K, T> {
    /// Creates an entry whose product has yet to be filled.
    pub(crate) fn unfilled(key: K, value: T) -> Self {
        Self { key, is_complete: false, value }
    }

    /// Creates an entry whose product is complete from the start.
    pub(crate) fn complete(key: K, value: T) -> Self {
        Self { key, is_complete: true, value }
    }

    /// Returns the key of the product's inputs.
    pub(crate) fn key(&self) -> &K {
        &self.key
    }

    /// Marks the product as complete.
    pub(crate) fn finish(&mut self) {
        self.is_complete = true;
    }

    /// Returns true if the product is complete.
    pub(crate) fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Returns true if the product is complete and was made from `key`.
    pub(crate) fn holds(&self, key: &K) -> bool {
        self.is_complete && self.key == *key
    }

    /// Marks the product as incomplete, to be filled for another key.
    pub(crate) fn restart(&mut self, key: K) {
        (self.key, self.is_complete) = (key, false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_serve_when_they_are_complete_and_made_from_the_same() {
        let mut cached = Cached::unfilled(1, "product");
        assert!(!cached.holds(&1), "it is not there yet");
        cached.finish();
        assert!(cached.holds(&1) && !cached.holds(&2));
        cached.restart(2);
        assert!(!cached.holds(&2) && !cached.holds(&1) && cached.key() == &2);
        assert!(Cached::complete(3, ()).holds(&3));
    }
}
