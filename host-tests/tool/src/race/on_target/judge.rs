//! Figures of a contestant: the errors of its answers.

use super::path::Row;
use crate::spread::Spread;
use glam::DVec3;
use palpate_rivals::{ANSWER_WORDS, Answer};

/// A distance that is wrong by more, in sizes of the body, is a miss.
pub const MISS: f64 = 1e-3;
/// Stiffness of the spring whose force shows a false step, N/m.
pub const STIFFNESS: f64 = 1_000.0;

/// Figures of a contestant on a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Instructions of a tick.
    pub instructions: Spread<u32>,
    /// Error of the distance, in sizes.
    pub distance: Spread<f64>,
    /// Largest error of the normal, degrees.
    pub normal: f64,
    /// Ticks whose distance is wrong by more than `MISS`.
    pub misses: usize,
    /// Largest change in a tick of the error of a spring's force over the gap, N.
    pub false_step: f64,
}

/// The instructions and answers in a contestant's file.
pub fn read(bytes: &[u8]) -> Vec<(u32, Answer)> {
    let words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let row = |[instructions, numbers @ ..]: &[u32; ANSWER_WORDS]| {
        let [gap_m, a, b, c, d, e, f] = numbers.map(f32::from_bits);
        (*instructions, Answer { gap_m, normal: [a, b, c].into(), point: [d, e, f].into() })
    };
    words.as_chunks().0.iter().map(row).collect()
}

/// Judges a contestant by the truth.
///
/// # Errors
/// If it has not answered every row with numbers.
pub fn score(rows: &[Row], answers: &[(u32, Answer)], size: f64) -> anyhow::Result<Score> {
    anyhow::ensure!(rows.len() == answers.len(), "{} rows, {} answers", rows.len(), answers.len());
    let (mut distances, mut normals, mut forces) = (Vec::new(), Vec::new(), Vec::<DVec3>::new());
    for (row, (_, answer)) in rows.iter().zip(answers) {
        let (gap, normal) = (f64::from(answer.gap_m), answer.normal.as_dvec3());
        anyhow::ensure!(gap.is_finite() && normal.is_finite(), "an answer that is no number: {answer:?}");
        distances.push((gap - row.gap).abs() / size);
        let angle = |truth: &DVec3| normal.cross(*truth).length().atan2(normal.dot(*truth)).to_degrees();
        let Some(truth) = row.normals.iter().min_by(|a, b| angle(a).total_cmp(&angle(b))) else { continue };
        normals.push(angle(truth));
        forces.push(STIFFNESS * (gap * normal - row.gap * *truth));
    }
    let spread = |values: &[f64]| Spread::of(values).ok_or_else(|| anyhow::anyhow!("no rows"));
    let instructions: Vec<u32> = answers.iter().map(|(instructions, _)| *instructions).collect();
    Ok(Score {
        instructions: Spread::of(&instructions).ok_or_else(|| anyhow::anyhow!("no rows"))?,
        misses: distances.iter().filter(|error| **error > MISS).count(),
        distance: spread(&distances)?,
        normal: normals.into_iter().fold(0.0, f64::max),
        false_step: forces.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f64::max),
    })
}
