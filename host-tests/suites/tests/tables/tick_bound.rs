//! The bound of a tick ([`Body::worst_tick`]): no tick on a body that a file may hold takes longer, and on a body that
//! ships the worst takes at least half of it.
//!
//! `PALPATE_FILES` says how many files are made.

use super::spoiled_files::{baked, mend, section, with_body};
use palpate::body::{
    Body, BodyBuffer, BodyError, BodyWitness, Edge, Effort, FILE_VERSION, Face, FileError, Lists, Section, Soft,
    TickLimit, TickWork,
};
use palpate::field::{Bump, FieldBounds, Mode, Quadratic};
use palpate::math::{Vec3, vec3};
use palpate::tally;
use palpate::track::{Contact, Controller, Probe};
use palpate_bake::locator::PackedLists;
use palpate_truth::generate::Random;
use rayon::prelude::*;
use std::collections::BTreeMap;

const PERIOD: f32 = 1.0 / 4_000.0;

/// Weights with which a bound is checked: each kind of evaluation alone counts most in one of them.
const WEIGHTS: [TickWork; 4] = [
    TickWork::EACH,
    TickWork { patches: 100, curves: 10, spokes: 1 },
    TickWork { patches: 1, curves: 100, spokes: 1 },
    TickWork { patches: 1, curves: 1, spokes: 100 },
];

// A file in pieces, so that it can be put together again after a change.

#[derive(Clone)]
struct Pieces {
    source: Vec<u32>,
    body: Vec<u32>,
    borders: Vec<u32>,
    /// Each face's record, with the coefficients of its patch and of its four sides.
    faces: Vec<(Vec<u32>, [Vec<u32>; 5])>,
    /// Each edge's record with its coefficients.
    edges: Vec<(Vec<u32>, Vec<u32>)>,
    /// Records without spokes.
    vertices: Vec<Vec<u32>>,
    /// The direction of each end of each edge.
    directions: Vec<[[u32; 3]; 2]>,
    nodes: Vec<u32>,
    /// Each as [`palpate::body::Candidate::pack`] makes it.
    entries: Vec<u32>,
    notes: Vec<u32>,
}

/// Number of coefficients of a curve's record.
fn of_curve(curve: &[u32]) -> usize {
    let [degree, kind, ..] = curve[0].to_le_bytes();
    let spans = (curve[0] >> 16) as usize - 1;
    spans * (usize::from(degree) + 1) * components(kind)
}

fn components(kind: u8) -> usize {
    if kind == 0 { 3 } else { 4 }
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn whole_words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

/// Where the record of a face's side begins.
const fn side(number: usize) -> usize {
    19 + 5 * number
}

impl Pieces {
    fn of(words: &[u32]) -> Self {
        let get = |of| {
            let (start, count) = section(words, of);
            words[start..start + count].to_vec()
        };
        let coefficients = get(Section::Coefficients);
        let mut rest = &coefficients[..];
        let mut cut = |count: usize| {
            let (these, left) = rest.split_at(count);
            rest = left;
            these.to_vec()
        };
        let records = get(Section::Faces);
        let faces = records.chunks(39).map(|face| {
            let [degree_u, degree_v, kind, _] = face[0].to_le_bytes();
            let spans = ((face[1] & 0xffff) as usize - 1) * ((face[1] >> 16) as usize - 1);
            let count = spans * (usize::from(degree_u) + 1) * (usize::from(degree_v) + 1) * components(kind);
            let patch = cut(count);
            let of_side = |number: usize| {
                let record = &face[side(number)..];
                if record[0] & 0xff == 2 { of_curve(&record[1..]) } else { 0 }
            };
            let [a, b, c, d] = [0, 1, 2, 3].map(|number| cut(of_side(number)));
            (face.to_vec(), [patch, a, b, c, d])
        });
        let faces: Vec<_> = faces.collect();
        let edges: Vec<_> = get(Section::Edges).chunks(8).map(|edge| (edge.to_vec(), cut(of_curve(edge)))).collect();
        let mut directions = vec![[[0; 3]; 2]; edges.len()];
        for spoke in get(Section::Spokes).chunks(4) {
            directions[(spoke[3] & 0xffff) as usize][(spoke[3] >> 16) as usize & 1] = [spoke[0], spoke[1], spoke[2]];
        }
        let body = get(Section::Body);
        let [low, high, entry_bits, face_bits] = body[10].to_le_bytes();
        let [rectangles, candidates] = [Section::Rectangles, Section::Entries].map(|of| bytes(&get(of)));
        let entries = u16::from_le_bytes([low, high]);
        let lists = Lists { entries, entry_bits, face_bits, rectangles: &rectangles, candidates: &candidates };
        Self {
            source: get(Section::Source),
            body,
            borders: get(Section::Borders),
            faces,
            edges,
            vertices: get(Section::Vertices).chunks(8).map(<[u32]>::to_vec).collect(),
            directions,
            nodes: get(Section::Nodes),
            entries: PackedLists::unpacked(&lists),
            notes: get(Section::Notes),
        }
    }

    /// The file, with the spokes that its edges have.
    fn words(&self) -> Vec<u32> {
        let (mut vertices, mut spokes) = (Vec::new(), Vec::new());
        for (index, vertex) in self.vertices.iter().enumerate() {
            let first = spokes.len() / 4;
            for (edge, (record, _)) in self.edges.iter().enumerate() {
                for end in 0..2 {
                    if (record[7] >> (16 * end)) as usize & 0xffff == index {
                        spokes.extend(self.directions[edge][end]);
                        spokes.push((edge | end << 16) as u32);
                    }
                }
            }
            let mut vertex = vertex.clone();
            vertex[6] = (first | (spokes.len() / 4 - first) << 16) as u32;
            vertices.extend(vertex);
        }
        let coefficients = self.faces.iter().flat_map(|(_, chunks)| chunks.iter().flatten());
        let coefficients = coefficients.chain(self.edges.iter().flat_map(|(_, chunk)| chunk)).copied().collect();
        let lists = PackedLists::of(&self.entries);
        let mut body = self.body.clone();
        body[10] = u32::from(lists.entries) | u32::from(lists.entry_bits) << 16 | u32::from(lists.face_bits) << 24;
        let mut words = vec![u32::from_le_bytes(*b"PALP"), FILE_VERSION, 0];
        for (of, data) in [
            (Section::Source, self.source.clone()),
            (Section::Body, body),
            (Section::Borders, self.borders.clone()),
            (Section::Coefficients, coefficients),
            (Section::Faces, self.faces.iter().flat_map(|(record, _)| record).copied().collect()),
            (Section::Edges, self.edges.iter().flat_map(|(record, _)| record).copied().collect()),
            (Section::Vertices, vertices),
            (Section::Spokes, spokes),
            (Section::Nodes, self.nodes.clone()),
            (Section::Rectangles, whole_words(&lists.rectangles)),
            (Section::Entries, whole_words(&lists.candidates)),
            (Section::Notes, self.notes.clone()),
        ] {
            let letters: &[u8; 4] = of.letters().as_bytes().first_chunk().expect("four letters");
            words.extend([u32::from_le_bytes(*letters), 4 * data.len() as u32]);
            words.extend(data);
        }
        words.push(0);
        mend(&mut words);
        words
    }

    /// Changes something that a tick may walk. All but the last leave a file that may be accepted.
    fn change(&mut self, random: &mut Random) {
        let mut below = |count: usize| (random.between(0.0, count as f64) as usize).min(count - 1);
        let (faces, edges) = (self.faces.len(), self.edges.len());
        let (some_face, some_edge) = (below(faces), below(edges));
        let vertex = below(self.vertices.len());
        match below(14) {
            0 => {
                // Many edges at one vertex.
                for _ in 0..=below(edges) {
                    let shift = 16 * below(2);
                    let ends = &mut self.edges[below(edges)].0[7];
                    *ends = *ends & !(0xffff << shift) | (vertex as u32) << shift;
                }
            }
            1 => {
                let kind = [0, 1, 1, 2, 3, 0][below(6)];
                for _ in 0..=below(2 * edges) {
                    let first = &mut self.edges[below(edges)].0[5];
                    *first = *first & 0x00ff_ffff | kind << 24;
                }
            }
            2 => {
                // Three sharp edges at a vertex, the others smooth: the planes between them decide.
                let ends = |record: &[u32]| [record[7] & 0xffff, record[7] >> 16];
                let mut sharp = 0;
                for (record, _) in &mut self.edges {
                    if ends(record).contains(&(vertex as u32)) {
                        record[5] = record[5] & 0x00ff_ffff | u32::from(sharp >= 3) << 24;
                        sharp += 1;
                    }
                }
            }
            3 => self.body[1] ^= 1,
            4 => {
                // A curve of a higher degree.
                let (record, chunk) = &mut self.edges[some_edge];
                elevate(&mut record[..3], chunk);
            }
            5 | 6 => {
                // A separator of a higher degree, or one that was a plane.
                let (record, chunks) = &mut self.faces[some_face];
                let number = below(4);
                let words = &mut record[side(number)..side(number) + 5];
                match words[0] & 0xff {
                    1 => {
                        chunks[1 + number] = words[1..4].to_vec();
                        let unit = self.borders.windows(2).position(|pair| pair == [0, 1_f32.to_bits()]);
                        let first = unit.unwrap_or_else(|| {
                            self.borders.extend([0, 1_f32.to_bits()]);
                            self.borders.len() - 2
                        });
                        words[0] += 1;
                        words[1..].copy_from_slice(&[2 << 16, first as u32, 0, 0]);
                    }
                    2 => elevate(&mut words[1..4], &mut chunks[1 + number]),
                    _ => {}
                }
            }
            7 => {
                // A patch of a higher degree along u: a row of zeros for each span.
                let (record, [patch, ..]) = &mut self.faces[some_face];
                let [degree_u, degree_v, kind, _] = record[0].to_le_bytes();
                if degree_u < 5 {
                    let row = (usize::from(degree_v) + 1) * components(kind);
                    let span = row * (usize::from(degree_u) + 1);
                    let zeros = vec![0; row];
                    *patch = patch.chunks(span).flat_map(|span| [span, &zeros].concat()).collect();
                    record[0] += 1;
                }
            }
            8 => {
                // Hollow faces: their bulge hides what lies behind.
                let hollow = -(10_f32.powf(below(60) as f32 / 10.0 - 2.0));
                for (record, _) in &mut self.faces {
                    record[13] = hollow.to_bits();
                }
            }
            9 => {
                let outward = [0, 1, 2].map(|_| below(201) as f32 / 100.0 - 1.0).map(f32::to_bits);
                self.vertices[vertex][3..6].copy_from_slice(if below(3) == 0 { &[0; 3] } else { &outward });
            }
            10 => self.vertices[vertex][7] ^= 1,
            11 => {
                for _ in 0..=below(12) {
                    let direction = [0, 1, 2].map(|_| (below(201) as f32 / 100.0 - 1.0).to_bits());
                    self.directions[below(edges)][below(2)] = direction;
                }
            }
            12 => {
                // A list of one candidate, which a search soon ends, convex or not.
                self.entries[0] = (some_face as u32) << 20 | (below(2) as u32) << 30 | 31 << 15 | 31 << 5;
            }
            _ => {
                let (record, _) = &mut self.faces[some_face];
                record[below(39)] ^= 1 << below(32);
            }
        }
    }
}

/// A curve's record with one degree more: a coefficient of zero for each span.
fn elevate(curve: &mut [u32], chunk: &mut Vec<u32>) {
    let [degree, kind, ..] = curve[0].to_le_bytes();
    if degree < 10 {
        let span = (usize::from(degree) + 1) * components(kind);
        let zeros = vec![0; components(kind)];
        *chunk = chunk.chunks(span).flat_map(|span| [span, &zeros].concat()).collect();
        curve[0] += 1;
    }
}

// The work of ticks.

fn in_body(random: &mut Random, size: f32) -> Vec3 {
    let mut side = || size * random.between(-1.0, 1.0) as f32;
    vec3(side(), side(), side())
}

/// The bound of a body under each weight, and the most that ticks took.
#[derive(Clone, Copy)]
struct Worst {
    bounds: [u32; 4],
    measured: [u32; 4],
    work: TickWork,
}

impl Worst {
    fn of(body: &Body<'_>) -> Self {
        let bounds = WEIGHTS.map(|weights| body.worst_tick(weights).cost);
        Self { bounds, measured: [0; 4], work: TickWork::default() }
    }

    fn tick(&mut self, body: &Body<'_>, state: &mut BodyWitness, probe: Vec3) {
        tally::take();
        body.step(&Controller::SecondOrder, state, Probe::at(probe), PERIOD);
        let work = tally::take();
        for ((bound, measured), weights) in self.bounds.iter().zip(&mut self.measured).zip(WEIGHTS) {
            let cost = work.weighed(weights);
            if cost > *measured {
                *measured = cost;
                if weights == TickWork::EACH {
                    self.work = work;
                }
            }
            assert!(cost <= *bound, "{work:?} by {weights:?}, at most {bound}; {:?}", state.feature);
        }
    }

    /// Walks of a probe around a point of the body, in steps that a tracker follows, from its front and back.
    fn walk(&mut self, body: &Body<'_>, centre: Vec3, radius: f32, ticks: u32, random: &mut Random) {
        let mut state = body.start();
        let mut at = in_body(random, radius);
        // From in front, where the first search ends.
        for _ in 0..2_000 {
            if state.contact != Contact::Behind {
                break;
            }
            self.tick(body, &mut state, centre + at);
        }
        let mut towards = at;
        for tick in 0..ticks {
            if tick % 16 == 0 {
                towards = in_body(random, radius);
            }
            at += (towards - at) * 0.2;
            self.tick(body, &mut state, centre + at);
        }
    }

    /// Ticks from every vertex, from the middle of every edge and on every face.
    fn everywhere(&mut self, body: &Body<'_>, ticks: u32, random: &mut Random) {
        let edges = body.edges().iter().map(|edge| edge.curve.point(0.5));
        let faces = body.faces().iter().map(|face| palpate::patch::Patch::evaluate(&face.patch, 0.5, 0.5).point);
        let centres: Vec<_> = body.vertices().iter().map(|vertex| vertex.point).chain(edges).chain(faces).collect();
        for centre in centres {
            for radius in [0.1, 0.03, 0.01, 0.003, 0.001] {
                self.walk(body, centre, radius * body.size(), ticks, random);
            }
        }
    }
}

fn load<R>(mut words: Vec<u32>, work: impl Fn(&Body<'_>) -> R) -> Result<R, FileError> {
    match with_body(&words, &work) {
        Err(FileError::Tables { found, .. }) => {
            let at = section(&words, Section::Body).0;
            words[at] = found;
            mend(&mut words);
            with_body(&words, work)
        }
        found => found,
    }
}

const SPOILED: [&str; 6] = ["capped_box", "thin_plate", "ellipsoid_poles", "rounded_cylinder", "sphere_body", "teapot"];

/// One of them with changes.
fn spoiled(good: &[Pieces; 6], seed: u32) -> (usize, Pieces) {
    let mut random = Random::new(0x71c4 + u64::from(seed));
    // Most of them small: large ones take longer to load.
    let of = [0, 0, 0, 1, 1, 2, 2, 3, 4, 5][(seed % 10) as usize];
    let mut pieces = good[of].clone();
    // Half of them with the list of a single face: their searches end within a few ticks.
    if seed.is_multiple_of(2) {
        pieces.entries[0] = 31 << 15 | 31 << 5;
    }
    for _ in 0..=(seed / 10) % 12 {
        pieces.change(&mut random);
    }
    (of, pieces)
}

#[test]
fn no_tick_takes_more_than_its_file_allows() {
    let files: u32 = std::env::var("PALPATE_FILES").map_or(200, |count| count.parse().expect("PALPATE_FILES"));
    let good = SPOILED.map(|name| Pieces::of(&baked(name)));
    let one = |seed: u32| {
        let (of, pieces) = spoiled(&good, seed);
        let work = |body: &Body<'_>| {
            let mut random = Random::new(u64::from(seed));
            let mut worst = Worst::of(body);
            // Half of the walks are where the bound is reached.
            let most = body.worst_tick(TickWork::EACH).vertex;
            for walk in 0..8 {
                let count = body.vertices().len();
                let any = (random.between(0.0, count as f64) as usize).min(count - 1);
                let vertex = most.map_or(any, |most| if walk % 2 == 0 { usize::from(most) } else { any });
                let radius = body.size() * 10_f32.powf(random.between(-3.0, -0.5) as f32);
                worst.walk(body, body.vertices()[vertex].point, radius, 64, &mut random);
            }
            worst
        };
        load(pieces.words(), work).map(|worst| (SPOILED[of], worst))
    };
    let found: Vec<_> = (0..files).into_par_iter().map(one).collect();
    let mut reasons: BTreeMap<String, u32> = BTreeMap::new();
    // Of each body: files, the highest bound and the longest tick.
    let mut rows: BTreeMap<&str, [u32; 3]> = BTreeMap::new();
    for one in &found {
        match one {
            Ok((name, worst)) => {
                let [count, bound, measured] = rows.entry(name).or_default();
                (*count, *bound, *measured) =
                    (*count + 1, worst.bounds[0].max(*bound), worst.measured[0].max(*measured));
            }
            Err(error) => {
                let text = error.to_string();
                let reason = text.split(['(', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']).next();
                *reasons.entry(reason.unwrap_or_default().to_owned()).or_default() += 1;
            }
        }
    }
    let accepted: u32 = rows.values().map(|[count, ..]| count).sum();
    println!("{files} files, {accepted} accepted; bound and longest tick in evaluations");
    for (name, [count, bound, measured]) in rows {
        println!("  {name:<18}{count:>7} files{bound:>6}{measured:>6}");
    }
    println!("refused: {reasons:#?}");
    assert!(accepted >= files / 10, "{accepted} of {files} accepted");
}

/// Modes that stretch space by 0.3 in all, one in three with a bump.
fn random_modes(body: &Body<'_>, random: &mut Random) -> Vec<Mode> {
    let size = body.size();
    let count = random.between(1.0, 9.0) as usize;
    (0..count)
        .map(|_| {
            let mut vector = || vec3(0.0, 0.0, 0.0).map(|_| random.between(-0.3, 0.3) as f32);
            let (constant, linear, quadratic) = (vector(), [(); 3].map(|()| vector()), [(); 6].map(|()| vector()));
            let field = Quadratic {
                constant,
                linear: linear.map(|entry| entry / size),
                quadratic: quadratic.map(|entry| entry / (size * size)),
            };
            let at = 0.5 * size * vector();
            let bump = random.between(0.0, 3.0) < 1.0;
            let bump = bump.then_some(Bump { direction: Vec3::splat(0.2), at, radius: 0.5 * size });
            let bounds = FieldBounds { motion: 3.0, stretch: 6.0 / size, bend: 9.0 / (size * size), twist: 0.0 };
            Mode { field, bump, limit: 0.05 * size / count as f32, bounds }
        })
        .collect()
}

#[test]
fn no_tick_on_a_soft_body_takes_more_than_its_bound() {
    let files: u32 = std::env::var("PALPATE_FILES").map_or(200, |count| count.parse().expect("PALPATE_FILES"));
    let good = SPOILED.map(|name| Pieces::of(&baked(name)));
    // The longest tick as a part of its bound.
    let one = |seed: u32| {
        let (_, pieces) = spoiled(&good, seed);
        let work = |body: &Body<'_>| {
            let mut random = Random::new(u64::from(seed));
            // With more effort a tick takes its longest way at most as often.
            let body = &if seed.is_multiple_of(3) { *body } else { body.with_effort(Effort::ONE) };
            let modes = random_modes(body, &mut random);
            let soft = Soft::new(*body, &modes).expect("modes");
            let bounds = WEIGHTS.map(|weights| soft.worst_tick(weights).cost);
            let mut most = 0.0_f64;
            for walk in 0..8_u32 {
                let vertex = body.worst_tick(TickWork::EACH).vertex.map_or(0, usize::from);
                let any = (random.between(0.0, body.vertices().len() as f64) as usize).min(body.vertices().len() - 1);
                let centre = body.vertices()[if walk.is_multiple_of(2) { vertex } else { any }].point;
                let radius = body.size() * 10_f32.powf(random.between(-3.0, -0.5) as f32);
                let mut state = soft.start();
                let mut at = in_body(&mut random, radius);
                let mut towards = at;
                for tick in 0..2_000 {
                    let is_in = state.body.contact != Contact::Behind;
                    if is_in && tick % 16 == 0 {
                        towards = in_body(&mut random, radius);
                    }
                    at += (towards - at) * 0.2;
                    let q: Vec<f32> = modes
                        .iter()
                        .enumerate()
                        .map(|(mode, of)| of.limit * (0.003 * (mode + 1) as f32 * tick as f32).sin())
                        .collect();
                    tally::take();
                    soft.step(&Controller::SecondOrder, &mut state, Probe::at(centre + at), &q, PERIOD);
                    soft.material_point(&state);
                    let work = tally::take();
                    for (bound, weights) in bounds.iter().zip(WEIGHTS) {
                        let cost = work.weighed(weights);
                        assert!(cost <= *bound, "{work:?} by {weights:?}, at most {bound}; {:?}", state.body.feature);
                    }
                    most = most.max(f64::from(work.evaluations()) / f64::from(bounds[0]));
                    if is_in && tick > 1_000 {
                        break;
                    }
                }
            }
            most
        };
        load(pieces.words(), work)
    };
    let found: Vec<_> = (0..files).into_par_iter().filter_map(|seed| one(seed).ok()).collect();
    let most = found.iter().copied().fold(0.0, f64::max);
    println!("{} of {files} files, the longest tick {most:.2} of its bound", found.len());
    assert!(found.len() as u32 >= files / 10 && most > 0.5, "{} files, {most}", found.len());
}

#[test]
fn the_worst_tick_of_a_body_that_ships_takes_at_least_half_of_its_bound() {
    let rows: Vec<_> = palpate_suites::models()
        .into_par_iter()
        .map(|name| {
            let mut random = Random::new(0xb0d7);
            let found = with_body(&baked(name), |body| {
                // With more effort a tick takes its longest way at most as often.
                assert!(body.fits(TickLimit::BENCH), "{name}: {} cycles", body.worst_cycles());
                let body = &body.with_effort(Effort::ONE);
                let mut worst = Worst::of(body);
                worst.everywhere(body, 800, &mut random);
                worst
            });
            (name, found.expect(name))
        })
        .collect();
    println!("{:<18}{:>8}{:>8}", "evaluations", "bound", "longest");
    for (name, Worst { bounds: [bound, ..], measured: [measured, ..], work }) in &rows {
        println!("{name:<18}{bound:>8}{measured:>8}  {work:?}");
    }
    for (name, Worst { bounds: [bound, ..], measured: [measured, ..], .. }) in rows {
        assert!(bound <= 2 * measured, "{name}: {bound}, {measured}");
    }
}

/// A file with many spokes at its first vertex.
fn with_spokes(count: usize) -> Vec<u32> {
    let mut words = baked("capped_box");
    let (vertex, _) = section(&words, Section::Vertices);
    let (spokes, there) = section(&words, Section::Spokes);
    let first = words[spokes..spokes + 4].to_vec();
    let more = count - (words[vertex + 6] >> 16) as usize;
    let added: Vec<u32> = first.iter().copied().cycle().take(4 * more).collect();
    words.splice(spokes..spokes, added);
    words[spokes - 1] = 4 * (there + 4 * more) as u32;
    words[vertex + 6] = (count as u32) << 16;
    for other in 1..8 {
        words[vertex + 8 * other + 6] += more as u32;
    }
    mend(&mut words);
    words
}

#[test]
fn a_vertex_of_thousands_of_spokes_is_refused() {
    for count in [2_400, 15_000] {
        let error = load(with_spokes(count), |body| body.vertices().len());
        assert_eq!(error, Err(FileError::Body(BodyError::Spokes { vertex: 0, spokes: count as u16 })));
        let words = error.unwrap_err().to_string();
        assert!(words.contains("64 edges end at a vertex") && words.contains(&format!("has {count}")), "{words}");
    }
}

#[test]
fn spokes_are_the_ends_of_edges() {
    let at = |words: &[u32], of, index: usize| section(words, of).0 + index;
    let refused = |spoil: &dyn Fn(&mut Vec<u32>)| {
        let mut words = baked("capped_box");
        spoil(&mut words);
        mend(&mut words);
        load(words, |_| ()).unwrap_err()
    };
    // Another spoke's edge, the other end, a vertex that shares spokes with the one before it.
    let edge = refused(&|words| {
        let place = at(words, Section::Spokes, 3);
        words[place] ^= 7;
    });
    let end = refused(&|words| {
        let place = at(words, Section::Spokes, 3);
        words[place] ^= 1 << 16;
    });
    for error in [edge, end] {
        assert_eq!(error, FileError::Body(BodyError::Spoke { spoke: 0 }));
    }
    let shared = refused(&|words| {
        let place = at(words, Section::Vertices, 8 + 6);
        words[place] -= 1;
    });
    assert_eq!(shared, FileError::Body(BodyError::Vertex { vertex: 1 }));
    // One spoke less than two for each edge.
    let missing = refused(&|words| {
        let last = at(words, Section::Vertices, 7 * 8 + 6);
        words[last] -= 1 << 16;
    });
    assert_eq!(missing, FileError::Body(BodyError::SpokeCount));
}

#[test]
fn a_body_above_the_limit_is_refused_with_its_vertex() {
    let words = baked("ellipsoid_poles");
    let bound = with_body(&words, |body| body.with_effort(Effort::BENCH).worst_tick(TickWork::EACH)).unwrap();
    let load = |evaluations| {
        let (mut faces, mut edges) = (vec![Face::VACANT; 8], vec![Edge::VACANT; 16]);
        let buffer = BodyBuffer { faces: &mut faces, edges: &mut edges };
        let bytes = bytemuck::cast_slice(&words);
        Body::from_bytes_with(bytes, buffer, TickLimit { evaluations, ..TickLimit::NONE }, &mut || ()).map(|_| ())
    };
    assert_eq!(load(bound.cost), Ok(()));
    let error = load(bound.cost - 1).unwrap_err();
    let FileError::Tick { evaluations, limit, vertex: Some((vertex, spokes)) } = error else { panic!("{error}") };
    assert_eq!((evaluations, limit, Some(vertex), spokes), (bound.cost, bound.cost - 1, bound.vertex, 4));
}

#[test]
fn the_modelled_cost_of_a_tick_is_at_least_what_the_emulator_counts() {
    use palpate::body::tick_cost::{CURVE, SERVO, STEP, evaluation, modes};
    #[derive(serde::Deserialize)]
    struct Budget {
        instructions: BTreeMap<String, u32>,
    }
    for board in ["m4", "m7", "m33"] {
        let file = palpate_suites::repository(&format!("host-tests/budgets/{board}.toml"));
        let rows: Budget = toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
        let row = |name: &str| rows.instructions[name];
        for (kind, (is_rational, curve)) in
            ["polynomial", "rational"].into_iter().zip([false, true].into_iter().zip(CURVE))
        {
            for degree in 1..=5 {
                let counted = row(&format!("second order, {kind}, degree ({degree}, {degree})"));
                assert!(evaluation([degree; 2], is_rational) >= counted, "{board} {kind} {degree}");
            }
            assert!(curve >= row(&format!("curve, {kind}, degree 10")), "{board}");
        }
        let step = row("closest point of the capped box, any, worst") - row("second order, polynomial, degree (3, 3)");
        assert!(STEP >= step, "{board}: {step}");
        let soft = |count: &str| row(&format!("servo tick, a soft body of {count}, touched, worst"));
        // Of one core alone they are counted.
        for (count, more) in [(4, "4 modes"), (8, "8 modes")].into_iter().filter(|_| board == "m4") {
            assert!(modes(count) - modes(1) >= soft(more) - soft("1 mode"), "{board}: {count} modes");
        }
        for servo in ["protected", "folded back", "smooth"] {
            assert!(SERVO >= row(&format!("servo tick, {servo}, worst")), "{board}");
        }
    }
}

/// [`load`] with a limit.
fn load_with<R>(mut words: Vec<u32>, limit: TickLimit, work: impl Fn(&Body<'_>) -> R) -> Result<R, FileError> {
    let load = |words: &[u32]| {
        let (mut faces, mut edges) = (vec![Face::VACANT; 8], vec![Edge::VACANT; 16]);
        let buffer = BodyBuffer { faces: &mut faces, edges: &mut edges };
        Body::from_bytes_with(bytemuck::cast_slice(words), buffer, limit, &mut || ()).map(|body| work(&body))
    };
    match load(&words) {
        Err(FileError::Tables { found, .. }) => {
            let at = section(&words, Section::Body).0;
            words[at] = found;
            mend(&mut words);
            load(&words)
        }
        found => found,
    }
}

/// The capped box, not convex, its patches raised to this degree along u and v by zeros.
fn of_degree(degree: u8) -> Vec<u32> {
    let mut pieces = Pieces::of(&baked("capped_box"));
    for (record, [patch, ..]) in &mut pieces.faces {
        let [u, v, kind, _] = record[0].to_le_bytes();
        let [u, v] = [u, v].map(usize::from);
        let (now, width) = (usize::from(degree), components(kind));
        let span = (u + 1) * (v + 1) * width;
        let row = (v + 1) * width;
        *patch = patch
            .chunks(span)
            .flat_map(|span| {
                let mut rows: Vec<u32> = Vec::new();
                for row in span.chunks(row) {
                    rows.extend(row);
                    rows.extend(std::iter::repeat_n(0, (now - v) * width));
                }
                rows.extend(std::iter::repeat_n(0, (now - u) * (now + 1) * width));
                rows
            })
            .collect();
        record[0] = record[0] & 0xffff_0000 | u32::from(degree) | u32::from(degree) << 8;
    }
    // Not convex: tracker and search share a tick.
    pieces.body[1] &= !1;
    pieces.words()
}

#[test]
fn a_body_that_does_not_fit_the_period_is_given_less_effort_and_then_refused() {
    let words = of_degree(5);
    let load = |cycles| {
        load_with(words.clone(), TickLimit { cycles, ..TickLimit::BENCH }, |body| (body.effort(), body.worst_cycles()))
    };
    let (all, most) = load(u32::MAX).unwrap();
    let (effort, cycles) = load(TickLimit::BENCH.cycles).unwrap();
    println!("degree 5: {most} cycles at {all:?}; {cycles} at {effort:?}");
    assert!(all == Effort::BENCH && most > TickLimit::BENCH.cycles && cycles <= TickLimit::BENCH.cycles);
    let (lowest, least) = load_with(words.clone(), TickLimit { cycles: 0, ..TickLimit::BENCH }, |_| ()).map_or_else(
        |error| match error {
            FileError::Cycles { cycles, limit: 0 } => (Effort::ONE, cycles),
            other => panic!("{other}"),
        },
        |()| panic!("accepted"),
    );
    assert_eq!(load(least).unwrap(), (lowest, least));
    assert_eq!(load(least - 1), Err(FileError::Cycles { cycles: least, limit: least - 1 }));
    // The work of its ticks, at the weights of the model, stays within the bound.
    for limit in [TickLimit::BENCH.cycles, least] {
        load_with(words.clone(), TickLimit { cycles: limit, ..TickLimit::BENCH }, |body| {
            let mut worst = Worst::of(body);
            worst.everywhere(body, 100, &mut Random::new(5));
        })
        .unwrap();
    }
}
