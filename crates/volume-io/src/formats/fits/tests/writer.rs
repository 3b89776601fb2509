//! Writer of FITS files for tests, card by card.

/// Builder of a header and data unit.
#[derive(Clone)]
pub(super) struct TestUnit {
    cards: Vec<String>,
    data: Vec<u8>,
}

/// Pads bytes to a multiple of the block size of 2880.
fn filled(mut bytes: Vec<u8>, with: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(2880), with);
    bytes
}

impl TestUnit {
    /// Makes the primary unit of a file: an array of `bits` bits per pixel, fastest axis first.
    pub(super) fn primary(bits: i32, axes: &[u64], data: Vec<u8>) -> Self {
        Self::new("SIMPLE  =                    T", bits, axes, data)
    }

    /// Makes an extension, a unit that follows the primary one.
    pub(super) fn extension(kind: &str, bits: i32, axes: &[u64], data: Vec<u8>) -> Self {
        Self::new(&format!("XTENSION= '{kind:<8}'"), bits, axes, data).with("PCOUNT", "0").with("GCOUNT", "1")
    }

    fn new(first: &str, bits: i32, axes: &[u64], data: Vec<u8>) -> Self {
        let mut unit = Self { cards: vec![first.to_owned()], data };
        unit = unit.with("BITPIX", bits).with("NAXIS", axes.len());
        for (axis, length) in axes.iter().enumerate() {
            unit = unit.with(&format!("NAXIS{}", axis + 1), length);
        }
        unit
    }

    /// Sets the value of a keyword, replacing an earlier one.
    pub(super) fn with(mut self, keyword: &str, value: impl std::fmt::Display) -> Self {
        let start = format!("{keyword:<8}= ");
        let card = format!("{start}{value:>20} / a comment");
        match self.cards.iter_mut().find(|card| card.starts_with(&start)) {
            Some(old) => *old = card,
            None => self.cards.push(card),
        }
        self
    }

    /// Removes a keyword from the header.
    pub(super) fn without(mut self, keyword: &str) -> Self {
        self.cards.retain(|card| !card.starts_with(&format!("{keyword:<8}=")));
        self
    }

    /// Returns the header without its `END` card.
    pub(super) fn header_without_end(&self) -> Vec<u8> {
        self.cards.iter().flat_map(|card| format!("{card:<80}").into_bytes()).collect()
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let end = format!("{:<80}", "END").into_bytes();
        [filled([self.header_without_end(), end].concat(), b' '), filled(self.data.clone(), 0)].concat()
    }
}
