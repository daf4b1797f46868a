//! A body's file, checked and built, for as long as the instance lives.

use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec;
use palpate::body::{Body, BodyBuffer, Edge, Face, FileHead};
use palpate::math::Vec3;

use crate::felt::Felt;

/// What is felt, and where its tables lie in the model.
#[derive(Clone, Copy)]
pub struct Loaded {
    /// The body, with all features.
    pub body: &'static Body<'static>,
    /// What the loop touches: the body, or its only patch.
    pub felt: &'static Felt,
    /// Where the origin of the tables lies in the model, metres.
    pub centre: Vec3,
}

impl Loaded {
    /// Takes a file with all the checks that a device makes.
    ///
    /// # Errors
    /// The file's first fault, in a sentence.
    pub fn new(words: &'static [u32], length: usize) -> Result<Self, String> {
        let bytes = bytemuck::cast_slice(words).get(..length).unwrap_or_default();
        let head = FileHead::of(bytes).map_err(|error| error.to_string())?;
        let faces = Box::leak(vec![Face::VACANT; head.faces].into_boxed_slice());
        let edges = Box::leak(vec![Edge::VACANT; head.edges].into_boxed_slice());
        let body = Body::from_bytes(bytes, BodyBuffer { faces, edges }).map_err(|error| error.to_string())?;
        let body: &'static Body<'static> = Box::leak(Box::new(body));
        // As the tool's commands take a file: a body of one face is felt as its patch.
        let felt = match body.faces() {
            [face] => Felt::Patch(face.patch.with_crc(face.patch.table_crc())),
            _ => Felt::Body(*body),
        };
        Ok(Self { body, felt: Box::leak(Box::new(felt)), centre: head.centre })
    }
}
