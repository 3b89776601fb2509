//! Pseudo-random numbers, reproducible by their seed.

/// Marsaglia's xorshift generator with 64 bits.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        // Zero would remain zero.
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// Random number below a limit, which must not be zero.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }

    pub(crate) fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }
}

#[test]
fn numbers_are_the_same_again_and_differ_with_the_seed() {
    let first = |seed| {
        let mut random = Random::new(seed);
        [(); 8].map(|()| random.below(1000))
    };
    assert_eq!(first(7), first(7));
    assert_ne!(first(7), first(8));
    assert!(first(0).windows(2).any(|pair| pair[0] != pair[1]));
}
