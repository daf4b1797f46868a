//! A walk over the numbers of a thing: to take them down, or to fill them in.

use alloc::vec::Vec;
use palpate::math::{Vec2, Vec3};

/// Operation on each number of a walk.
pub trait Walk {
    /// One number.
    fn number(&mut self, number: &mut f32);

    /// Several.
    fn numbers(&mut self, numbers: &mut [f32]) {
        for number in numbers {
            self.number(number);
        }
    }

    /// A vector.
    fn vector(&mut self, vector: &mut Vec3) {
        self.number(&mut vector.x);
        self.number(&mut vector.y);
        self.number(&mut vector.z);
    }

    /// A vector in a plane.
    fn flat(&mut self, vector: &mut Vec2) {
        self.number(&mut vector.x);
        self.number(&mut vector.y);
    }

    /// A small count or an index: `f32` represents every one below 2²⁴ exactly.
    fn count(&mut self, count: u32) -> u32 {
        let mut number = count as f32;
        self.number(&mut number);
        // The cast saturates, and takes what is no number for 0.
        number as u32
    }

    /// An optional value; to read a present one, the walk starts from `vacant`.
    fn maybe<T>(&mut self, thing: &mut Option<T>, vacant: T, walk: impl FnOnce(&mut Self, &mut T)) {
        let is_there = self.count(u32::from(thing.is_some())) != 0;
        if !is_there {
            *thing = None;
            return;
        }
        walk(self, thing.get_or_insert(vacant));
    }
}

/// Takes all numbers down.
#[derive(Debug, Default)]
pub struct Taken(pub Vec<f32>);

impl Walk for Taken {
    fn number(&mut self, number: &mut f32) {
        self.0.push(*number);
    }
}

/// Fills all numbers in, those that are missing with zeros.
#[derive(Debug)]
pub struct Filled<'a> {
    numbers: core::slice::Iter<'a, f32>,
    /// Whether there were too few.
    is_short: bool,
}

impl<'a> Filled<'a> {
    /// From these.
    pub fn new(numbers: &'a [f32]) -> Self {
        Self { numbers: numbers.iter(), is_short: false }
    }

    /// Whether there were as many numbers as places.
    pub fn is_whole(&self) -> bool {
        !self.is_short && self.numbers.as_slice().is_empty()
    }
}

impl Walk for Filled<'_> {
    fn number(&mut self, number: &mut f32) {
        let next = self.numbers.next();
        self.is_short |= next.is_none();
        *number = next.copied().unwrap_or_default();
    }
}
