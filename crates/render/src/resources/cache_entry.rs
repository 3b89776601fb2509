//! Cache entry: a GPU product with the key it was made from.

/// Product with the key of its inputs, and a flag for its completeness. It is valid for requests with the same key,
/// and stale for all others.
#[derive(Debug)]
pub(crate) struct CacheEntry<K, T> {
    key: K,
    is_complete: bool,
    /// Product itself, complete or in progress.
    pub product: T,
}

impl<K: PartialEq, T> CacheEntry<K, T> {
    /// Creates an entry whose product has yet to be filled.
    pub(crate) fn incomplete(key: K, value: T) -> Self {
        Self { key, is_complete: false, product: value }
    }

    /// Creates an entry whose product is complete from the start.
    pub(crate) fn complete(key: K, value: T) -> Self {
        Self { key, is_complete: true, product: value }
    }

    /// Returns the key of the product's inputs.
    pub(crate) fn key(&self) -> &K {
        &self.key
    }

    /// Marks the product as complete.
    pub(crate) fn mark_complete(&mut self) {
        self.is_complete = true;
    }

    /// Returns true if the product is complete.
    pub(crate) fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Returns true if the product is complete and was made from `key`.
    pub(crate) fn is_valid_for(&self, key: &K) -> bool {
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
        let mut cached = CacheEntry::incomplete(1, "product");
        assert!(!cached.is_valid_for(&1), "it is not there yet");
        cached.mark_complete();
        assert!(cached.is_valid_for(&1) && !cached.is_valid_for(&2));
        cached.restart(2);
        assert!(!cached.is_valid_for(&2) && !cached.is_valid_for(&1) && cached.key() == &2);
        assert!(CacheEntry::complete(3, ()).is_valid_for(&3));
    }
}
