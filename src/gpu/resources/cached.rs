//! A product on the GPU together with what it was made from.

/// A product, the key of everything that it is made from, and whether it is complete. It serves those who need
/// that key, and is otherwise stale.
#[derive(Debug)]
pub(crate) struct Cached<K, T> {
    key: K,
    is_complete: bool,
    /// The product itself.
    pub value: T,
}

impl<K: PartialEq, T> Cached<K, T> {
    /// A product that is yet to be filled.
    pub(crate) fn unfilled(key: K, value: T) -> Self {
        Self { key, is_complete: false, value }
    }

    /// A product that is there at once.
    pub(crate) fn complete(key: K, value: T) -> Self {
        Self { key, is_complete: true, value }
    }

    /// What it is made from.
    pub(crate) fn key(&self) -> &K {
        &self.key
    }

    /// Everything of it is there from now on.
    pub(crate) fn finish(&mut self) {
        self.is_complete = true;
    }

    /// Whether everything of it is there.
    pub(crate) fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Whether it is what this key asks for, and complete.
    pub(crate) fn holds(&self, key: &K) -> bool {
        self.is_complete && self.key == *key
    }

    /// It will be filled anew, from something else.
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
