//! The whole way: read, heal, outline, divide, fit, measure.

use crate::bezier::Bezier;
use crate::divide::{self, Manner, Turning};
use crate::error::ImportError;
use crate::measure::{self, Measured};
use crate::mesh::Mesh;
use crate::part::{Face, Part, Sweep, Use};
use crate::patches::{self, Made};
use crate::spheres::Hollow;
use crate::wires::{FINEST, Fine, outlined};
use crate::{check, emit, heal, pinch, read, report, reread, sew, spheres, split, turn};
use glam::DVec3;
use std::f64::consts::FRAC_PI_4;
use std::path::Path;

/// How often faces that are too much at once are made easier.
const ROUNDS: usize = 16;
/// How often a part of too many patches is tried with an easier face: each time changes some per cent of them.
const TOO_MANY: usize = 3;
/// How often what took far more patches than quads is tried otherwise.
const SECOND_THOUGHTS: usize = 3;
/// A face with more loops than this, or more edges, is split before it is tried.
const MOST_LOOPS: usize = 12;
const MOST_EDGES: usize = 64;
/// Of the tolerance, what patches are fitted within after one was measured to be farther off.
const FINER: f64 = 0.7;
const FINEST_FIT: f64 = 0.2;
const HEALED: &str = "healed: with their whole shell, these faces lie inside out in the file: ";
const NOT_COMPARED: &str = "a second reading of the file does not follow its products: units and placements of the \
                            result are not compared with it";

/// Settings of an import.
#[derive(Clone, Debug)]
pub struct Options {
    /// Maximum deviation, millimetres.
    pub tolerance: f64,
    /// Only the solids of this name.
    pub solid: Option<String>,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 0.01, solid: None }
    }
}

/// A polynomial Bézier patch of the result.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Its face's name, with a number where the face has more patches than one.
    pub name: String,
    /// Degrees and control points, millimetres.
    pub surface: Bezier,
    /// Whether the outward normal is against `f_u × f_v`.
    pub flip: bool,
}

/// A part as patches.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The model file.
    pub model: String,
    /// Its patches.
    pub patches: Vec<Patch>,
    /// The results, for the terminal.
    pub report: Vec<String>,
    /// The volume inside the patches, mm³, which means nothing where they are open, and their area, mm².
    pub volume_and_area: [f64; 2],
}

/// Imports a part.
///
/// # Errors
/// A fault of the file or of the part; or the first face that cannot be divided into patches within the tolerance.
pub fn import(path: &Path, options: &Options) -> Result<Imported, ImportError> {
    let mut is_swept_twice = false;
    let first = import_by(path, options, Sweep::Start, &mut is_swept_twice);
    // The other of two sweeps has its normal the other way: with the wrong one a sound file seems inside out.
    let is_right = |result: &Result<Imported, ImportError>| {
        result.as_ref().is_ok_and(|imported| !imported.report.iter().any(|line| line.contains(HEALED)))
    };
    if !is_swept_twice || is_right(&first) {
        return first;
    }
    let others = [Sweep::Outline, Sweep::Outward, Sweep::Inward];
    let mut others = others.into_iter().map(|sweep| import_by(path, options, sweep, &mut is_swept_twice));
    others.find(is_right).unwrap_or(first)
}

/// Imports a part with surfaces that are swept twice chosen in one way.
fn import_by(path: &Path, options: &Options, sweep: Sweep, is_swept_twice: &mut bool) -> Result<Imported, ImportError> {
    let mut part = read::read(path, options.solid.as_deref(), options.tolerance, sweep)?;
    *is_swept_twice = part.is_swept_twice;
    let reread = reread::read(path);
    match &reread {
        Some(reread) => reread.compare_outlines(&part, options.solid.is_none())?,
        None => part.remarks.push(NOT_COMPARED.to_owned()),
    }
    sew::sew(&mut part, options.tolerance)?;
    refuse_too_many(&part)?;
    let seams = heal::take_out_seams(&mut part);
    let gap = pinch::refuse(&part, options.tolerance)?;
    turn::turn(&mut part, &seams, options.tolerance)?;
    // A vertex may be as far off its edge, and the patches off that.
    let near = options.tolerance + part.precision.max(options.tolerance);
    let mut options = options.clone();
    if let Some(gap) = gap {
        options.tolerance = options.tolerance.min(gap.width / pinch::TOLERANCES_IN_A_GAP);
        part.remarks.push(format!("{}: imported within {:.6} mm", gap.reason, options.tolerance));
    }
    let named = part.clone();
    let imported = divided_somehow(part, &options)?;
    if let Some(reread) = &reread {
        reread.compare_senses(&named)?;
        let patches: Vec<&Bezier> = imported.patches.iter().map(|patch| &patch.surface).collect();
        let vertices = options.solid.is_none().then_some(near);
        reread.compare_patches(&named, &patches, vertices, imported.volume_and_area)?;
    }
    Ok(imported)
}

/// Patches of a part, by the ways that there are.
fn divided_somehow(mut part: Part, options: &Options) -> Result<Imported, ImportError> {
    let whole = part.clone();
    if spheres::without_poles(&mut part, Hollow::Halved) == Hollow::Halved
        && let Ok(done) = lightening(part, Way { hollow: Hollow::Halved, triangles: false }, options)
    {
        return Ok(done);
    }
    whole.effort.renew();
    let way = Way { hollow: Hollow::Whole, triangles: false };
    lightening(whole.clone(), way, options).or_else(|error| {
        whole.effort.renew();
        let next = lightening(whole.clone(), Way { triangles: true, ..way }, options);
        next.or_else(|_| {
            if whole.effort.is_spent() {
                return Err(error);
            }
            whole.effort.renew();
            lightening(Part { is_loose: true, ..whole }, way, options).map_err(|_| error)
        })
    })
}

/// The minimum number of quads in a face: `V / 2 + h − 1` in a plane with `V` vertices and `h` holes, where a round loop
/// has four sides.
fn fewest_quads(face: &Face) -> usize {
    if face.kind != "plane" {
        return 1;
    }
    let vertices: usize = face.loops.iter().map(|sides| if sides.len() == 1 { 4 } else { sides.len() }).sum();
    (vertices / 2 + face.loops.len()).saturating_sub(2).max(1)
}

/// Refuses a part that cannot have few enough patches, before any work.
fn refuse_too_many(part: &Part) -> Result<(), ImportError> {
    let all: usize = part.faces.iter().map(fewest_quads).sum();
    let Some(most) = part.faces.iter().max_by_key(|face| fewest_quads(face)).filter(|_| all > patches::MOST) else {
        return Ok(());
    };
    let reason = format!(
        "it needs {} patches at least, and the whole part {all}; a body has {} at most: import one solid (--solid), or \
         leave out small features",
        fewest_quads(most),
        patches::MOST
    );
    Err(ImportError::face(most.label(), reason))
}

/// When the rims of plates with holes are cut finely.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rims {
    /// Before anything else is done to the plate; none was yet.
    First,
    /// One was.
    Used,
    /// With all its other edges.
    AsOthers,
}

/// How a part is tried.
#[derive(Clone, Copy, Debug)]
struct Way {
    hollow: Hollow,
    /// Whether quads may have a side of no length.
    triangles: bool,
}

/// Divides a part, and as often as it does not succeed makes the faces easier that were too much.
fn lightening(part: Part, way: Way, options: &Options) -> Result<Imported, ImportError> {
    let mut rims = Rims::First;
    let found = lightening_by(part.clone(), way, &mut rims, options);
    if rims != Rims::Used {
        return found;
    }
    // What is fewer with finer rims is so for some parts only.
    if found.is_ok() {
        part.effort.for_better()
    } else {
        part.effort.renew()
    };
    match (found, lightening_by(part, way, &mut Rims::AsOthers, options)) {
        (Ok(found), Ok(other)) if other.patches.len() < found.patches.len() => Ok(other),
        (Err(_), other) => other,
        (found, _) => found,
    }
}

/// The same, one way.
fn lightening_by(mut part: Part, way: Way, rims: &mut Rims, options: &Options) -> Result<Imported, ImportError> {
    spheres::without_poles(&mut part, way.hollow);
    split_the_large(&mut part, options.tolerance)?;
    let mut fine = Fine::new();
    let mut too_many = 0;
    for _ in 0..ROUNDS {
        let errors = match divided(&part, &fine, way.triangles, options) {
            Err(errors) => errors,
            Ok(done) => return Ok(fewer(part, &fine, done, way, *rims, options)),
        };
        too_many +=
            usize::from(errors.iter().any(|error| matches!(error, ImportError::Face { is_too_many: true, .. })));
        if too_many > TOO_MANY {
            return Err(first(errors));
        }
        // From the last, so that the places of those before hold.
        for error in errors.into_iter().rev() {
            let ImportError::Face { index: Some(face), .. } = error else { return Err(error) };
            if part.effort.is_spent() {
                return Err(error.given_up(part.effort.hardest()));
            }
            if !lightened(&mut part, face, &mut fine, rims, options.tolerance)? {
                return Err(error);
            }
        }
        spheres::without_poles(&mut part, way.hollow);
    }
    divided(&part, &fine, way.triangles, options).map(|done| done.imported).map_err(first)
}

/// Where far more patches were made than there were quads, because cuts go on through face after face, the face with
/// the most is made easier, as if it had been too much; the fewest patches win.
fn fewer(mut part: Part, fine: &Fine, done: Divided, way: Way, mut rims: Rims, options: &Options) -> Imported {
    let (mut fine, mut best, mut busiest) = (fine.clone(), done.imported, done.busiest);
    part.effort.for_better();
    for _ in 0..SECOND_THOUGHTS {
        let Some(face) = busiest else { break };
        if !lightened(&mut part, face, &mut fine, &mut rims, options.tolerance).is_ok_and(|is_lighter| is_lighter) {
            break;
        }
        spheres::without_poles(&mut part, way.hollow);
        let Ok(other) = divided(&part, &fine, way.triangles, options) else { break };
        busiest = other.busiest;
        if other.imported.patches.len() < best.patches.len() {
            best = other.imported;
        }
    }
    best
}

/// The first of the errors.
fn first(errors: Vec<ImportError>) -> ImportError {
    errors.into_iter().next().unwrap_or_else(|| ImportError::face("the part", "it is not divided"))
}

/// Makes a face easier: its edges are cut finely, or it is split. Says whether anything could be done.
fn lightened(
    part: &mut Part,
    face: usize,
    fine: &mut Fine,
    rims: &mut Rims,
    tolerance: f64,
) -> Result<bool, ImportError> {
    let of = &part.faces[face];
    let edges: Vec<usize> = of.loops.iter().flatten().map(|used| used.edge).collect();
    let level = edges.iter().map(|edge| fine.get(edge).copied().unwrap_or(0)).min().unwrap_or(FINEST);
    let refine = |fine: &mut Fine| fine.extend(edges.iter().map(|edge| (*edge, level + 1)));
    let is_simple = if of.kind == "plane" { of.loops.len() == 2 } else { of.loops.len() <= 2 };
    // Of a plate with holes, its bent rim alone: each hole then finds corners nearby, and keeps its few pieces.
    let has_rim = *rims != Rims::AsOthers && of.kind == "plane" && of.loops.len() > 1;
    let rim = if has_rim { bent_rim(part, face) } else { Vec::new() };
    if !rim.is_empty() && !rim.iter().any(|edge| fine.contains_key(edge)) {
        fine.extend(rim.into_iter().map(|edge| (edge, 1)));
        *rims = Rims::Used;
        return Ok(true);
    }
    if is_simple && level == 0 {
        refine(fine);
        return Ok(true);
    }
    if split::split(part, face, tolerance)? {
        // Its pieces are easier: finer cuts, which all its neighbours would have to follow, may not be needed.
        fine.retain(|edge, _| !edges.contains(edge));
        return Ok(true);
    }
    if level < FINEST {
        refine(fine);
    }
    Ok(level < FINEST)
}

/// The bent edges of a face's largest loop; none where they are less than a quarter of it, as round corners are.
fn bent_rim(part: &Part, face: usize) -> Vec<usize> {
    let size = |uses: &Vec<Use>| {
        let points = || uses.iter().flat_map(|used| (0..8).map(|k| part.edges[used.edge].at(f64::from(k) / 8.0)[0]));
        points().fold(DVec3::NEG_INFINITY, DVec3::max).distance(points().fold(DVec3::INFINITY, DVec3::min))
    };
    let loops = part.faces[face].loops.iter();
    let Some(outer) = loops.max_by(|a, b| size(a).total_cmp(&size(b))) else { return Vec::new() };
    let length = |edges: &[usize]| edges.iter().map(|edge| part.edges[*edge].length()).sum::<f64>();
    let all: Vec<usize> = outer.iter().map(|used| used.edge).collect();
    let bends = |edge: &usize| {
        let slope = |k: i32| part.edges[*edge].at(f64::from(k) / 8.0)[1];
        (1..=8).any(|k| slope(k).angle_between(slope(0)) > FRAC_PI_4)
    };
    let bent: Vec<usize> = all.iter().copied().filter(bends).collect();
    if length(&bent) < 0.25 * length(&all) { Vec::new() } else { bent }
}

/// Splits faces that are too much for a search, without trying.
fn split_the_large(part: &mut Part, tolerance: f64) -> Result<(), ImportError> {
    let mut face = 0;
    while face < part.faces.len() {
        let loops = &part.faces[face].loops;
        let is_large = loops.len() > MOST_LOOPS || loops.iter().map(Vec::len).sum::<usize>() > MOST_EDGES;
        if !is_large || !split::split(part, face, tolerance)? {
            face += 1;
        }
    }
    Ok(())
}

fn single(error: ImportError) -> Vec<ImportError> {
    vec![error]
}

/// A part that was divided.
struct Divided {
    imported: Imported,
    /// The face with the most patches, where there are far more than there were quads.
    busiest: Option<usize>,
}

/// All that comes after the part is as it should be.
fn divided(part: &Part, fine: &Fine, triangles: bool, options: &Options) -> Result<Divided, Vec<ImportError>> {
    divided_within(part, fine, triangles, options, options.tolerance)
}

/// With patches that are fitted within `fit`, which is the tolerance or less, millimetres.
fn divided_within(
    part: &Part,
    fine: &Fine,
    triangles: bool,
    options: &Options,
    fit: f64,
) -> Result<Divided, Vec<ImportError>> {
    let (quads, mesh, made) = fewest(part, fine, triangles, fit)?;
    let turned = check::check(part, &made).map_err(single)?;
    if !turned.is_empty() {
        let mut part = part.clone();
        if part.remarks.iter().any(|remark| remark.starts_with(HEALED)) {
            let label = part.faces[turned[0]].label();
            return Err(single(ImportError::face(label, "rays do not tell its outward side; export the part again")));
        }
        let mut labels: Vec<String> = turned.iter().map(|face| part.faces[*face].label()).collect();
        labels.dedup();
        part.remarks.push(HEALED.to_owned() + &labels.join(", "));
        turned.into_iter().for_each(|face| part.faces[face].flip = !part.faces[face].flip);
        return divided_within(&part, fine, triangles, options, fit);
    }
    let mut counts = vec![0; part.faces.len()];
    made.iter().for_each(|made| counts[made.face] += 1);
    let busiest = (0..counts.len()).max_by_key(|face| counts[*face]).filter(|_| made.len() >= 2 * quads);
    let measured = measure::measure(&mesh, &made, options.tolerance);
    if let Err(error) = refuse_far(part, &measured, options.tolerance) {
        // A fit looks at fewer points than the measurement. A face without an edge cannot be made easier otherwise.
        let is_bare = matches!(error, ImportError::Face { index: Some(face), .. } if part.faces[face].loops.is_empty());
        let least = if is_bare { FINEST_FIT } else { FINER };
        let is_last = fit <= least * options.tolerance || part.effort.is_spent();
        let finer = || divided_within(part, fine, triangles, options, FINER * fit);
        return if is_last { Err(single(error)) } else { finer() };
    }
    let report = report::lines(&mesh, &made, &measured, options.tolerance);
    let model = emit::toml(part, &made, &report);
    let patch = |(name, made): (String, Made)| Patch { name, surface: made.bezier, flip: part.faces[made.face].flip };
    let patches = emit::names(part, &made).into_iter().zip(made).map(patch).collect();
    let volume_and_area = [measured.volume[0], measured.area[0]];
    Ok(Divided { imported: Imported { model, patches, report, volume_and_area }, busiest })
}

/// The patches of a part. Where quads had to be halved for them, which goes on through all quads on the way, lines that
/// turn far round a face are avoided in another try; the fewer patches win.
fn fewest<'p>(
    part: &'p Part,
    fine: &Fine,
    triangles: bool,
    tolerance: f64,
) -> Result<(usize, Mesh<'p>, Vec<Made>), Vec<ImportError>> {
    let patched = |turning: Turning| patched(part, fine, tolerance, Manner { turning, triangles });
    let (quads, mesh, made) = patched(Turning::Free)?;
    if made.len() > quads
        && !part.effort.is_spent()
        && let Ok((quads, other, fewer)) = patched(Turning::Dear)
        && fewer.len() < made.len()
    {
        return Ok((quads, other, fewer));
    }
    Ok((quads, mesh, made))
}

/// Patches, and how many quads there were before any was halved.
pub(crate) fn patched<'p>(
    part: &'p Part,
    fine: &Fine,
    tolerance: f64,
    manner: Manner,
) -> Result<(usize, Mesh<'p>, Vec<Made>), Vec<ImportError>> {
    let mut mesh = outlined(part, fine, tolerance).map_err(single)?;
    divide::parity::balance(&mut mesh).map_err(single)?;
    // An odd number of sides is no harm where one quad may have a side of no length.
    divide::parity::even(&mut mesh).or_else(|error| if manner.triangles { Ok(()) } else { Err(single(error)) })?;
    divide::divide(&mut mesh, manner)?;
    let quads = mesh.regions.iter().map(|region| region.quads.len()).sum();
    let made = patches::make(&mut mesh, tolerance)?;
    Ok((quads, mesh, made))
}

fn refuse_far(part: &Part, measured: &Measured, tolerance: f64) -> Result<(), ImportError> {
    for ((off, face), which) in [(measured.out, "its patches are"), (measured.back, "it is")] {
        if off > tolerance {
            let reason = format!(
                "{which} up to {off:.6} mm off, the tolerance is {tolerance} mm: choose a greater one (--tolerance)"
            );
            return Err(ImportError::too_much(part, face, reason));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_too_many_patches_is_refused_before_any_work() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/parts/perforated_plate.step");
        let mut part = read::read(&file, None, 0.01, Sweep::Start).unwrap();
        // 2 × ((8 + 35 × 4) / 2 + 35 − 1) in the planes with the holes and round corners, and one in each other face.
        assert_eq!(part.faces.iter().map(fewest_quads).sum::<usize>(), 2 * 108 + 4 + 39);
        assert!(refuse_too_many(&part).is_ok());
        part.faces = vec![part.faces; 5].concat();
        let message = refuse_too_many(&part).unwrap_err().to_string();
        assert!(message.contains("needs 108 patches") && message.contains("whole part 1295"), "{message}");
    }
}
