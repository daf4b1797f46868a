//! Between bytes and packets.

/// Bytes of one packet at most, on their way in or out.
#[derive(Debug)]
pub struct Bytes<const SIZE: usize> {
    bytes: [u8; SIZE],
    /// Those from here on are still to be taken…
    from: usize,
    /// … up to here.
    to: usize,
}

impl<const SIZE: usize> Bytes<SIZE> {
    /// None.
    pub const fn new() -> Self {
        Self { bytes: [0; SIZE], from: 0, to: 0 }
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.from >= self.to
    }

    /// Adds one behind the others; false if the buffer is full.
    pub fn push(&mut self, byte: u8) -> bool {
        let Some(place) = self.bytes.get_mut(self.to) else { return false };
        *place = byte;
        self.to += 1;
        true
    }

    /// Takes the first.
    pub fn pop(&mut self) -> Option<u8> {
        let first = self.waiting().first().copied()?;
        self.drop_first(1);
        Some(first)
    }

    /// All of them.
    pub fn waiting(&self) -> &[u8] {
        self.bytes.get(self.from..self.to).unwrap_or_default()
    }

    /// Drops `number` of the first. The buffer accepts bytes again once all are gone: a packet goes whole, or not at
    /// all.
    pub fn drop_first(&mut self, number: usize) {
        self.from = self.from.saturating_add(number);
        if self.is_empty() {
            self.clear();
        }
    }

    /// Replaces the content by a read; empty if nothing is read.
    pub fn fill(&mut self, read: impl FnOnce(&mut [u8]) -> Option<usize>) {
        self.clear();
        self.to = read(&mut self.bytes).map_or(0, |number| number.min(SIZE));
    }

    /// Forgets all of them.
    pub const fn clear(&mut self) {
        (self.from, self.to) = (0, 0);
    }
}

impl<const SIZE: usize> Default for Bytes<SIZE> {
    fn default() -> Self {
        Self::new()
    }
}
