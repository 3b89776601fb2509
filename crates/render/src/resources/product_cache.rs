//! Cache of products of one kind that successive pictures share, such as light volumes: finding, claiming, completing
//! and evicting them.

use std::ops::{Index, IndexMut};

use super::cache_entry::CacheEntry;

/// Products of one kind, each with its key and the number of the picture that used it last. Incomplete ones are found
/// as well; removing or sorting changes the indices of others.
#[derive(Debug)]
pub(crate) struct ProductCache<K, T> {
    slots: Vec<CacheSlot<K, T>>,
}

/// Cached product with its last use.
#[derive(Debug)]
struct CacheSlot<K, T> {
    entry: CacheEntry<K, T>,
    /// Number of the picture that used it last.
    last_used: u64,
}

/// Product that a picture looks up among the cached ones, and the work `F` to fill it.
#[derive(Debug)]
pub(crate) struct ProductPlace<K, F> {
    /// Key of the product; `None` without one.
    pub key: Option<K>,
    /// Index of the product among the cached ones.
    pub slot: Option<usize>,
    /// Work to fill the product; `None` if it is already complete.
    pub build: Option<F>,
}

impl<K, T> Default for ProductCache<K, T> {
    fn default() -> Self {
        Self { slots: Vec::new() }
    }
}

impl<K, F> Default for ProductPlace<K, F> {
    fn default() -> Self {
        Self { key: None, slot: None, build: None }
    }
}

impl<K: PartialEq + Clone, T> ProductCache<K, T> {
    /// Returns the cached products, in the order of their indices.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &CacheEntry<K, T>> {
        self.slots.iter().map(|slot| &slot.entry)
    }

    /// Returns the number of cached products.
    pub(crate) fn len(&self) -> usize {
        self.slots.len()
    }

    /// Returns the cached product with an index.
    pub(crate) fn get(&self, index: usize) -> Option<&CacheEntry<K, T>> {
        self.slots.get(index).map(|slot| &slot.entry)
    }

    /// Returns the cached product with an index, to change it.
    pub(crate) fn get_mut(&mut self, index: usize) -> Option<&mut CacheEntry<K, T>> {
        self.slots.get_mut(index).map(|slot| &mut slot.entry)
    }

    /// Returns the cached products with a key.
    pub(crate) fn products_of(&self, key: &K) -> impl Iterator<Item = &T> {
        self.iter().filter(move |entry| entry.key() == key).map(|entry| &entry.product)
    }

    /// Returns the index of a usable product with the first of these keys that has any.
    pub(crate) fn find(&self, keys: [Option<&K>; 2], is_usable: impl Fn(&K, &T) -> bool) -> Option<usize> {
        let with_key =
            |key: &K| self.iter().position(|entry| entry.key() == key && is_usable(key, &entry.product));
        keys.into_iter().flatten().find_map(with_key)
    }

    /// Returns the product that was used last.
    pub(crate) fn last_used(&self) -> Option<&T> {
        self.slots.iter().max_by_key(|slot| slot.last_used).map(|slot| &slot.entry.product)
    }

    /// Adds a product that has yet to be filled. Returns its index.
    pub(crate) fn insert(&mut self, key: K, product: T, picture_number: u64) -> usize {
        let entry = CacheEntry::incomplete(key, product);
        self.slots.push(CacheSlot { entry, last_used: picture_number });
        self.slots.len() - 1
    }

    /// Counts a product as used by a picture. Returns its key.
    pub(crate) fn claim(&mut self, index: usize, picture_number: u64) -> K {
        let slot = &mut self.slots[index];
        slot.last_used = picture_number;
        slot.entry.key().clone()
    }

    /// Marks a product as complete.
    pub(crate) fn complete(&mut self, index: usize) -> &mut T {
        let entry = &mut self.slots[index].entry;
        entry.mark_complete();
        &mut entry.product
    }

    /// Removes the products that an interrupted picture left incomplete.
    pub(crate) fn take_incomplete(&mut self) -> Vec<T> {
        self.take(|entry| !entry.is_complete())
    }

    /// Removes the products whose keys meet a condition.
    pub(crate) fn remove(&mut self, is_removed: impl Fn(&K) -> bool) -> Vec<T> {
        self.take(|entry| is_removed(entry.key()))
    }

    /// Removes the least recently used product, except those whose keys are needed, if there are `most` or more.
    pub(crate) fn evict_oldest(&mut self, most: usize, is_needed: impl Fn(&K) -> bool) -> Option<T> {
        if self.slots.len() < most {
            return None;
        }
        let free = (0..self.slots.len()).filter(|&at| !is_needed(self.slots[at].entry.key()));
        let oldest = free.min_by_key(|&at| self.slots[at].last_used);
        oldest.map(|at| self.slots.swap_remove(at).entry.product)
    }

    /// Drops the products with a key, and the least recently used one if there are still `most` or more.
    pub(crate) fn make_room(&mut self, key: &K, most: usize) {
        self.remove(|known| known == key);
        self.evict_oldest(most, |_| false);
    }

    /// Sorts the products, most recently used first, and removes those after the first `most`.
    pub(crate) fn keep_latest(&mut self, most: usize) -> Vec<T> {
        self.slots.sort_by_key(|slot| std::cmp::Reverse(slot.last_used));
        self.slots.drain(self.slots.len().min(most)..).map(|slot| slot.entry.product).collect()
    }

    fn take(&mut self, is_taken: impl Fn(&CacheEntry<K, T>) -> bool) -> Vec<T> {
        self.slots.extract_if(.., |slot| is_taken(&slot.entry)).map(|slot| slot.entry.product).collect()
    }
}

impl<K, T> Index<usize> for ProductCache<K, T> {
    type Output = CacheEntry<K, T>;

    fn index(&self, index: usize) -> &Self::Output {
        &self.slots[index].entry
    }
}

impl<K, T> IndexMut<usize> for ProductCache<K, T> {
    fn index_mut(&mut self, index: usize) -> &mut Self::Output {
        &mut self.slots[index].entry
    }
}

impl<K, F> ProductPlace<K, F> {
    /// Creates the place of a product that is already complete.
    pub(crate) fn with_complete(key: K, slot: usize) -> Self {
        Self { key: Some(key), slot: Some(slot), build: None }
    }

    /// Creates the place of a product that has yet to be filled.
    pub(crate) fn with_build(key: K, slot: usize, build: F) -> Self {
        Self { key: Some(key), slot: Some(slot), build: Some(build) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cache with products `a`, `b` and `c` for the keys 1, 2 and 3, used in this order.
    fn cache() -> ProductCache<u32, char> {
        let mut cache = ProductCache::default();
        for (at, product) in ['a', 'b', 'c'].into_iter().enumerate() {
            let slot = cache.insert(at as u32 + 1, product, at as u64);
            cache.complete(slot);
        }
        cache
    }

    #[test]
    fn the_first_key_with_a_usable_product_is_found() {
        let cache = cache();
        assert_eq!(cache.find([Some(&2), Some(&1)], |_, _| true), Some(1));
        assert_eq!(cache.find([Some(&2), Some(&1)], |_, product| *product != 'b'), Some(0));
        assert_eq!(cache.find([Some(&4), None], |_, _| true), None);
    }

    #[test]
    fn the_least_recently_used_product_is_evicted_unless_it_is_needed() {
        let mut cache = cache();
        assert_eq!(cache.evict_oldest(4, |_| false), None);
        assert_eq!(cache.claim(0, 9), 1);
        assert_eq!(cache.last_used(), Some(&'a'));
        assert_eq!(cache.evict_oldest(3, |key| *key == 2), Some('c'));
        assert_eq!(cache.keep_latest(1), ['b']);
        assert_eq!((cache.len(), cache[0].product), (1, 'a'));
    }

    #[test]
    fn interrupted_products_are_taken() {
        let mut cache = cache();
        cache.insert(4, 'd', 3);
        assert_eq!(cache.take_incomplete(), ['d']);
        assert_eq!(cache.remove(|key| *key < 3), ['a', 'b']);
        assert_eq!(cache.products_of(&3).collect::<Vec<_>>(), [&'c']);
    }
}
