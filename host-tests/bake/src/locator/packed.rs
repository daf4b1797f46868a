//! Lists of candidates as the target has them, with as few bits as they need.

use palpate::body::Lists;
use std::collections::HashMap;

/// [`Lists`] with the bytes owned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedLists {
    /// Number of entries.
    pub entries: u16,
    /// Bits of an entry.
    pub entry_bits: u8,
    /// Bits of its face.
    pub face_bits: u8,
    /// The rectangles, whole words.
    pub rectangles: Vec<u8>,
    /// The entries, whole words.
    pub candidates: Vec<u8>,
}

/// Bits of a rectangle, and of a face in [`palpate::body::Candidate::pack`].
const RECTANGLE_BITS: usize = 20;
const FACE_BITS: usize = 10;

impl PackedLists {
    /// Of entries as [`palpate::body::Candidate::pack`] makes them; the rectangles in the order in which they come.
    pub fn of(entries: &[u32]) -> Self {
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        let mut rectangles = Vec::new();
        let mut named = Vec::with_capacity(entries.len());
        for entry in entries {
            let rectangle = entry & ((1 << RECTANGLE_BITS) - 1);
            let number = *numbers.entry(rectangle).or_insert_with(|| {
                rectangles.push(rectangle);
                rectangles.len() as u32 - 1
            });
            let face = entry >> RECTANGLE_BITS & ((1 << FACE_BITS) - 1);
            let flags = entry >> 31 | (entry >> 30 & 1) << 1;
            named.push((number, face, flags));
        }
        let face_bits = bits(named.iter().map(|(_, face, _)| *face));
        let needed = 2 + face_bits + bits(named.iter().map(|(number, ..)| *number));
        // Of 27 a word that starts with a byte holds no more than 25 for sure.
        let entry_bits = if needed == 27 { 28 } else { needed };
        let codes = named.iter().map(|(number, face, flags)| (number << face_bits | face) << 2 | flags);
        Self {
            entries: entries.len() as u16,
            entry_bits: entry_bits as u8,
            face_bits: face_bits as u8,
            rectangles: packed(rectangles.iter().copied(), RECTANGLE_BITS),
            candidates: packed(codes, entry_bits),
        }
    }

    /// As the firmware has them; the bytes stay allocated for good.
    pub fn to_lists(&self) -> Lists<'static> {
        Lists {
            entries: self.entries,
            entry_bits: self.entry_bits,
            face_bits: self.face_bits,
            rectangles: self.rectangles.clone().leak(),
            candidates: self.candidates.clone().leak(),
        }
    }

    /// The entries, each as [`palpate::body::Candidate::pack`] makes it.
    pub fn unpacked(lists: &Lists<'_>) -> Vec<u32> {
        (0..).map_while(|index| lists.candidate(index)).map(|candidate| candidate.pack()).collect()
    }

    /// Bytes in flash.
    pub fn bytes(&self) -> usize {
        self.rectangles.len() + self.candidates.len()
    }
}

/// Bits that hold each of some numbers.
fn bits(numbers: impl Iterator<Item = u32>) -> usize {
    numbers.max().map_or(0, |most| (u32::BITS - most.leading_zeros()) as usize)
}

/// Numbers of `bits` bits without gaps, then zeros to the end of a word after the last one's first byte.
fn packed(numbers: impl ExactSizeIterator<Item = u32>, bits: usize) -> Vec<u8> {
    let last = numbers.len().saturating_sub(1) * bits / 8;
    let mut bytes = vec![0; (last + size_of::<u32>()).next_multiple_of(size_of::<u32>())];
    for (index, number) in numbers.enumerate() {
        let first = index * bits;
        for (byte, part) in bytes[first / 8..].iter_mut().zip((u64::from(number) << (first % 8)).to_le_bytes()) {
            *byte |= part;
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// As few and as many bits as there can be, and every width between.
    #[test]
    fn lists_are_the_same_unpacked() {
        let mut random = Random::new(7);
        for bits in 0..=RECTANGLE_BITS + FACE_BITS {
            let faces = bits.min(FACE_BITS);
            let mut below = |bits: usize| random.between(0.0, (1_u64 << bits) as f64) as u32;
            let mut entry = || below(bits - faces) | below(faces) << RECTANGLE_BITS | below(2) << 30;
            let mut entries: Vec<u32> = (0..65_535.min(4_u64 << bits)).map(|_| entry()).collect();
            *entries.last_mut().unwrap() &= !(1 << 31);
            let packed = PackedLists::of(&entries);
            let lists = packed.to_lists();
            assert!(lists.has_readable_entries(), "{bits}: {packed:?}");
            assert_eq!(PackedLists::unpacked(&lists), entries, "{bits}");
            assert!(lists.candidate(entries.len()).is_none());
        }
    }
}
