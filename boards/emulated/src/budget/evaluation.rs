//! One evaluation: point and both tangents, and with all second derivatives.

use core::hint::black_box;

use palpate::patch::{CurvedPoint, Patch, SplinePatch, SurfacePoint};
use semihosting::println;

use super::patches::{POLYNOMIAL, POLYNOMIAL_CURVE, RATIONAL, RATIONAL_CURVE};
use super::tables::table1c::PATCHES;
use super::tally::Tally;
use crate::timer::InstructionCounter;

/// Places along each parameter of a patch of several spans.
const PLACES: u8 = 13;

#[inline(never)]
fn evaluate(patch: &SplinePatch, u: f32, v: f32) -> SurfacePoint {
    patch.evaluate(u, v)
}

#[inline(never)]
fn evaluate_curved(patch: &SplinePatch, u: f32, v: f32) -> CurvedPoint {
    patch.evaluate_curved(u, v)
}

pub fn run(counter: &mut InstructionCounter) {
    for (kind, patches) in [("polynomial", &POLYNOMIAL), ("rational", &RATIONAL)] {
        for patch in black_box(patches) {
            let (u, v) = black_box((0.3, 0.7));
            let (point, instructions) = counter.count(|| evaluate(patch, u, v));
            black_box(point);
            let [degree_u, degree_v] = patch.degree();
            println!("\"evaluation, {kind}, degree ({degree_u}, {degree_v})\" = {instructions}");
            let (point, instructions) = counter.count(|| evaluate_curved(patch, u, v));
            black_box(point);
            println!("\"second order, {kind}, degree ({degree_u}, {degree_v})\" = {instructions}");
        }
    }
    for (kind, curve) in [("polynomial", &POLYNOMIAL_CURVE), ("rational", &RATIONAL_CURVE)] {
        let (curve, t) = black_box((curve, 0.3));
        let (point, instructions) = counter.count(|| curve.evaluate(t));
        black_box(point);
        println!("\"curve, {kind}, degree {}\" = {instructions}", curve.degree);
    }
    let mut spans = Tally::new();
    let body = black_box(&PATCHES[0]);
    for place in 0..u16::from(PLACES) * u16::from(PLACES) {
        let at = |index: u16| f32::from(index) / f32::from(PLACES - 1);
        let (u, v) = black_box((at(place / u16::from(PLACES)), at(place % u16::from(PLACES))));
        let (point, instructions) = counter.count(|| evaluate(body, u, v));
        black_box(point);
        spans.add(instructions);
    }
    spans.print("evaluation, 3 x 3 spans of degree (2, 2)");
}
