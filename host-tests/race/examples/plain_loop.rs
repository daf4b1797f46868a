//! The plain loop in Rust that the wheel is held to: closest points of a `.palp` for points in a file of `f64`, three
//! each, in the frame of the model. Writes (face, u, v, x, y, z) as words a point, and prints the seconds it took.
//!
//! `plain_loop BODY.palp POINTS.f64 OUT.u32`; the tests find it by `PALPATE_PLAIN_LOOP`.

use palpate::body::{Body, BodyBuffer, Edge, Face, FileHead};
use palpate::math::vec3;
use palpate::patch::Patch as _;
use std::time::Instant;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let paths: Vec<_> = env::args().skip(1).collect();
    let [body, points, out] = &paths[..] else { return Err(io::Error::other("BODY.palp POINTS.f64 OUT.u32")) };
    // The library takes a file where it lies, at a multiple of four: three bytes of room are enough to find one.
    let mut room = vec![0; 3];
    room.extend(fs::read(body)?);
    let shift = room.as_ptr().addr().wrapping_neg() % 4;
    room.rotate_left(3 - shift);
    let file = &room[shift..shift + room.len() - 3];
    let refused = |error: palpate::body::FileError| io::Error::other(error.to_string());
    let head = FileHead::of(file).map_err(refused)?;
    let (mut faces, mut edges) = (vec![Face::VACANT; head.faces], vec![Edge::VACANT; head.edges]);
    let body = Body::from_bytes(file, BodyBuffer { faces: &mut faces, edges: &mut edges }).map_err(refused)?;

    let numbers = fs::read(points)?;
    let numbers: Vec<f64> = numbers.as_chunks().0.iter().map(|number| f64::from_le_bytes(*number)).collect();
    let [x, y, z] = head.centre.to_array().map(f64::from);
    let mut answers: Vec<[u32; 6]> = Vec::with_capacity(numbers.len() / 3);
    let start = Instant::now();
    for point in numbers.as_chunks::<3>().0 {
        let probe = vec3((point[0] - x) as f32, (point[1] - y) as f32, (point[2] - z) as f32);
        let found = body.locate(probe);
        let [u, v] = found.parameters;
        let at = body.faces()[usize::from(found.face)].patch.evaluate(u, v).point;
        answers.push([u32::from(found.face), u.to_bits(), v.to_bits(), at.x.to_bits(), at.y.to_bits(), at.z.to_bits()]);
    }
    println!("{:.6}", start.elapsed().as_secs_f64());
    fs::write(out, answers.iter().flatten().flat_map(|word| word.to_le_bytes()).collect::<Vec<_>>())
}
