//! A body's file that is not what was baked: refused with its reason, or, where what was changed means something, a
//! body that can be felt without a panic.

use palpate::body::{Aligned, Body, BodyBuffer, BodyError, Edge, FILE_VERSION, Face, FileError, FileHead, Section};
use palpate::math::vec3;
use palpate::track::{Controller, Probe};
use palpate_bake::file::{self, BakedFile};
use palpate_truth::generate::Random;
use palpate_truth::measured::{grouped, measured};
use rayon::prelude::*;
use std::collections::BTreeMap;

pub(super) fn baked(name: &str) -> Vec<u32> {
    let bytes = file::write([7; 32], &palpate_suites::model(name), &palpate_suites::body(name)).expect(name);
    bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// CRC-32, bit by bit: not the library's.
pub(super) fn crc(words: &[u32]) -> u32 {
    !bytes(words).iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 })
    })
}

/// Makes length and CRC those of the words before them.
pub(super) fn mend(words: &mut [u32]) {
    let count = words.len();
    words[2] = 4 * count as u32;
    words[count - 1] = crc(&words[..count - 1]);
}

/// Where a section's data begin, and how many words there are.
pub(super) fn section(words: &[u32], wanted: Section) -> (usize, usize) {
    let mut at = 3;
    for of in Section::ALL {
        let count = words[at + 1] as usize / 4;
        if of == wanted {
            return (at + 2, count);
        }
        at += 2 + count;
    }
    unreachable!("all sections are there")
}

/// Loads the bytes as firmware does, and hands the body to `work`.
pub(super) fn with_body<R>(words: &[u32], work: impl FnOnce(&Body<'_>) -> R) -> Result<R, FileError> {
    loaded(bytemuck::cast_slice(words), work)
}

fn loaded<R>(bytes: &[u8], work: impl FnOnce(&Body<'_>) -> R) -> Result<R, FileError> {
    let head = FileHead::of(bytes)?;
    let (mut faces, mut edges) = (vec![Face::VACANT; head.faces], vec![Edge::VACANT; head.edges]);
    Ok(work(&Body::from_bytes(bytes, BodyBuffer { faces: &mut faces, edges: &mut edges })?))
}

/// What is done to a file.
type Spoil<'a> = Box<dyn Fn(&mut Vec<u32>) + 'a>;

#[test]
fn what_is_wrong_with_a_file_is_told() {
    let good = baked("capped_box");
    assert_eq!(with_body(&good, |body| body.faces().len()), Ok(6));
    let spoilt = |spoil: &dyn Fn(&mut Vec<u32>)| {
        let mut words = good.clone();
        spoil(&mut words);
        mend(&mut words);
        with_body(&words, |_| ()).err()
    };
    let of = |section_: Section| section(&good, section_).0;
    let code = |section, record| Some(FileError::Code { section, record });
    let cases: Vec<(&str, Spoil<'_>, Option<FileError>)> = vec![
        ("another beginning", Box::new(|words| words[0] ^= 1), Some(FileError::Magic)),
        (
            "an older version",
            Box::new(|words| words[1] = 1),
            Some(FileError::Version { found: 1, wanted: FILE_VERSION }),
        ),
        (
            "a newer version",
            Box::new(|words| words[1] = 3),
            Some(FileError::Version { found: 3, wanted: FILE_VERSION }),
        ),
        (
            "a section of another name",
            Box::new(move |words| words[of(Section::Edges) - 2] ^= 0x20),
            Some(FileError::Section { section: Section::Edges }),
        ),
        (
            "half a record",
            Box::new(move |words| words[of(Section::Vertices) - 1] -= 4),
            Some(FileError::Section { section: Section::Vertices }),
        ),
        (
            "a length that is no number of words",
            Box::new(move |words| words[of(Section::Borders) - 1] += 1),
            Some(FileError::Section { section: Section::Borders }),
        ),
        (
            "a length past the end",
            Box::new(move |words| words[of(Section::Notes) - 1] = !3),
            Some(FileError::Section { section: Section::Notes }),
        ),
        (
            "words behind the notes",
            Box::new(|words| words.push(0)),
            Some(FileError::Section { section: Section::Notes }),
        ),
        (
            "an infinite coefficient",
            Box::new(move |words| words[of(Section::Coefficients) + 7] = f32::INFINITY.to_bits()),
            Some(FileError::Number { section: Section::Coefficients, index: 7 }),
        ),
        (
            "a border that is NaN",
            Box::new(move |words| words[of(Section::Borders) + 1] = f32::NAN.to_bits()),
            Some(FileError::Number { section: Section::Borders, index: 1 }),
        ),
        ("neither convex nor not", Box::new(move |words| words[of(Section::Body) + 1] = 2), code(Section::Body, 0)),
        (
            "a centre that is NaN",
            Box::new(move |words| words[of(Section::Body) + 8] = f32::NAN.to_bits()),
            code(Section::Body, 0),
        ),
        (
            "no kind of coefficients",
            Box::new(move |words| words[of(Section::Faces) + 39] |= 2 << 16),
            code(Section::Faces, 1),
        ),
        (
            "entries of more bits than a word is sure to hold",
            Box::new(move |words| words[of(Section::Body) + 10] ^= (5 ^ 27) << 16),
            Some(FileError::Body(BodyError::LocatorEntry { entry: 0 })),
        ),
        (
            "an entry behind the last one",
            Box::new(move |words| words[of(Section::Body) + 10] += 100),
            Some(FileError::Body(BodyError::LocatorEntry { entry: 8 })),
        ),
        (
            "a rectangle that is not there",
            Box::new(move |words| words[of(Section::Body) + 10] += 1 << 16),
            Some(FileError::Body(BodyError::LocatorEntry { entry: 0 })),
        ),
        ("no orientation", Box::new(move |words| words[of(Section::Faces)] |= 2 << 24), code(Section::Faces, 0)),
        ("no kind of side", Box::new(move |words| words[of(Section::Faces) + 19] |= 3), code(Section::Faces, 0)),
        ("no kind of edge", Box::new(move |words| words[of(Section::Edges) + 13] |= 7 << 24), code(Section::Edges, 1)),
        ("no flag", Box::new(move |words| words[of(Section::Vertices) + 15] = 2), code(Section::Vertices, 1)),
        (
            "no flag of a spoke",
            Box::new(move |words| words[of(Section::Spokes) + 11] |= 2 << 16),
            code(Section::Spokes, 2),
        ),
        (
            "borders that are not there",
            Box::new(move |words| words[of(Section::Edges)] += 1 << 16),
            Some(FileError::Missing { section: Section::Edges, record: 0 }),
        ),
        (
            "coefficients that are not there",
            Box::new(move |words| words[of(Section::Edges) + 11 * 8] += 1),
            Some(FileError::Missing { section: Section::Edges, record: 11 }),
        ),
        (
            "coefficients that nothing needs",
            Box::new(move |words| words[of(Section::Edges) + 11 * 8] -= 1),
            Some(FileError::UnusedCoefficients { numbers: 3 }),
        ),
    ];
    for (what, spoil, expected) in &cases {
        assert_eq!(spoilt(spoil), *expected, "{what}");
    }
    // What the constructors of patch and body find is said as they say it.
    let degree = spoilt(&|words| words[of(Section::Faces)] ^= 4);
    assert_eq!(
        degree.map(|error| error.to_string()).as_deref(),
        Some("face 0: degree: must be 1 to 5 along u and along v")
    );
    let spoke = spoilt(&|words| words[of(Section::Spokes) + 3] = 12);
    assert_eq!(
        spoke.map(|error| error.to_string()).as_deref(),
        Some("spokes: a spoke's edge does not end at its vertex, or it is not finite (number 0)")
    );
    // A number that means something is not the one that was baked.
    let other = spoilt(&|words| words[of(Section::Coefficients)] ^= 1);
    assert!(matches!(other, Some(FileError::Tables { .. })), "{other:?}");
    let damaged = with_body(&[&good[..20], &[good[20] ^ 1], &good[21..]].concat(), |_| ());
    assert!(matches!(damaged, Err(FileError::Damaged { .. })), "{damaged:?}");
}

#[test]
fn a_file_at_an_odd_address_or_without_room_is_refused() {
    let good = bytes(&baked("capped_box"));
    let mut moved = Box::new(Aligned([0; 32 << 10]));
    for by in 0..4 {
        let place = &mut moved.0[by..by + good.len()];
        place.copy_from_slice(&good);
        let expected = if by == 0 { Ok(()) } else { Err(FileError::Unaligned) };
        assert_eq!(loaded(place, |_| ()), expected, "{by}");
    }
    let place = &mut moved.0[..good.len()];
    place.copy_from_slice(&good);
    let small = Some(FileError::BufferTooSmall { faces: 6, edges: 12 });
    for [faces, edges] in [[5, 12], [6, 11], [0, 0]] {
        let (mut faces, mut edges) = (vec![Face::VACANT; faces], vec![Edge::VACANT; edges]);
        assert_eq!(Body::from_bytes(place, BodyBuffer { faces: &mut faces, edges: &mut edges }).err(), small);
    }
}

/// Words that mean something else than the one that was there.
const STRANGE: [u32; 14] = [
    0,
    1,
    2,
    7,
    0xff,
    0xffff,
    0x1_0000,
    0x7fff_ffff,
    0x8000_0000,
    u32::MAX,
    0x7f80_0000,
    0xff80_0000,
    0x7fc0_0000,
    0x7f7f_ffff,
];

/// Spoils a file in one of many ways; all but the first two have a CRC and a length that are right.
fn spoil(words: &mut Vec<u32>, random: &mut Random) -> Option<usize> {
    let mut below = |count: usize| (random.between(0.0, count as f64) as usize).min(count - 1);
    match below(8) {
        0 => {
            // Damage on the way.
            for _ in 0..=below(3) {
                let at = below(words.len());
                words[at] ^= 1 << below(32);
            }
            return None;
        }
        1 => return Some(below(4 * words.len())),
        2 => {
            for _ in 0..=below(3) {
                let at = below(words.len());
                words[at] ^= 1 << below(32);
            }
        }
        3 => {
            let at = 3 + below(words.len() - 4);
            words[at] = STRANGE[below(STRANGE.len())];
        }
        4 => {
            let at = 3 + below(words.len() - 4);
            let shift = 8 * below(4);
            words[at] = words[at] & !(0xff << shift) | (below(256) as u32) << shift;
        }
        5 => {
            // Lengths.
            let of = Section::ALL[below(Section::ALL.len())];
            let at = section(words, of).0 - 1;
            words[at] =
                words[at].wrapping_add(4 * below(80) as u32).wrapping_sub(4 * below(80) as u32 + below(2) as u32);
        }
        6 => {
            // Words too many or too few, with the section's length as it should be.
            let (start, count) = section(words, Section::ALL[below(Section::ALL.len())]);
            let at = start + below(count + 1);
            if below(2) == 0 || count == 0 {
                words.insert(at, STRANGE[below(STRANGE.len())]);
                words[start - 1] += 4;
            } else {
                words.remove(at.min(start + count - 1));
                words[start - 1] -= 4;
            }
        }
        _ => {
            let end = 4 + below(words.len() - 4);
            words.truncate(end);
        }
    }
    mend(words);
    None
}

/// Feels a body with a few probes: whatever it is, nothing panics.
fn feel(body: &Body<'_>, random: &mut Random) {
    let mut place = || (body.size() * random.between(-2.0, 2.0) as f32).clamp(-1e3, 1e3);
    let mut state = body.start();
    for _ in 0..3 {
        let probe = vec3(place(), place(), place());
        body.locate(probe);
        for _ in 0..8 {
            body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), 1.0 / 4_000.0);
        }
    }
}

#[test]
fn spoiled_files_are_refused_or_felt() {
    let files: u64 = std::env::var("PALPATE_SPOILED").map_or(100_000, |count| count.parse().expect("PALPATE_SPOILED"));
    let chunks = files.div_ceil(1_000);
    let bodies = ["capped_box", "ellipsoid_poles", "table1", "sphere_body"].map(baked);
    let chunk = |seed: u64| {
        let mut random = Random::new(0x9a17 + seed);
        let mut reasons: BTreeMap<&'static str, u32> = BTreeMap::new();
        for index in 0..1_000 {
            let good = &bodies[index % bodies.len()];
            let mut words = good.clone();
            let cut = spoil(&mut words, &mut random);
            let given = bytes(&words);
            let mut spoilt = match cut {
                // Cut anywhere: the words that hold it are longer.
                Some(length) => loaded(&bytemuck::cast_slice(&words)[..length], |_| ()),
                None => with_body(&words, |_| ()),
            };
            // With the CRC of the tables right too, it is what was baked: of another body.
            let was_another = matches!(spoilt, Err(FileError::Tables { .. }));
            if let Err(FileError::Tables { found, .. }) = spoilt {
                let at = section(good, Section::Body).0;
                words[at] = found;
                mend(&mut words);
                spoilt = with_body(&words, |body| feel(body, &mut random));
                assert_eq!(spoilt, Ok(()), "a body whose only fault was its CRC");
                // And as the host reads it, surfaces in double precision and all.
                let _ = BakedFile::read(&bytes(&words));
            } else {
                let _ = BakedFile::read(&given[..cut.unwrap_or(given.len())]);
            }
            let reason = match spoilt {
                Ok(()) if was_another => "felt: another body",
                Ok(()) if words == *good => "the same",
                // What the library does not read: the hash, the centre, the notes.
                Ok(()) => "felt: the same tables",
                Err(error) => name(error),
            };
            *reasons.entry(reason).or_default() += 1;
        }
        reasons
    };
    let reasons = (0..chunks).into_par_iter().map(chunk).reduce(BTreeMap::new, |mut all, part| {
        part.into_iter().for_each(|(reason, count)| *all.entry(reason).or_default() += count);
        all
    });
    println!("{reasons:#?}");
    for reason in [
        "magic",
        "version",
        "length",
        "damaged",
        "section",
        "number",
        "code",
        "missing",
        "unused coefficients",
        "patch",
        "body",
        "felt: another body",
        "felt: the same tables",
    ] {
        assert!(reasons.get(reason).is_some_and(|count| u64::from(*count) > chunks / 10), "{reason}: {reasons:?}");
    }
    measured(&format!("of {} spoiled body files, those that panic", grouped(chunks * 1_000)), 0);
}

const fn name(error: FileError) -> &'static str {
    match error {
        FileError::Unaligned => "unaligned",
        FileError::Magic => "magic",
        FileError::Version { .. } => "version",
        FileError::Length { .. } => "length",
        FileError::Damaged { .. } => "damaged",
        FileError::Section { .. } => "section",
        FileError::Number { .. } => "number",
        FileError::Code { .. } => "code",
        FileError::Missing { .. } => "missing",
        FileError::UnusedCoefficients { .. } => "unused coefficients",
        FileError::BufferTooSmall { .. } => "buffer",
        FileError::Patch { .. } => "patch",
        FileError::Body(_) => "body",
        FileError::Tables { .. } => "tables",
        _ => "unknown",
    }
}
