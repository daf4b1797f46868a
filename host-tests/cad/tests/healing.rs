//! What a file says twice, askew or the wrong way round: made whole up to its own precision, or refused by name.

use palpate_cad::{Imported, Options, import};
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A box of 40 × 30 × 20 mm with a hole of 12 mm through it.
fn whole() -> String {
    fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/parts/s02.step")).unwrap()
}

fn imported(name: &str, text: &str) -> Result<Imported, String> {
    static FILES: AtomicUsize = AtomicUsize::new(0);
    let number = FILES.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("palpate-cad-{}-{number}-{name}.step", std::process::id()));
    fs::write(&path, text).unwrap();
    let result = import(&path, &Options::default());
    fs::remove_file(&path).unwrap();
    result.map_err(|error| error.to_string())
}

fn edited(from: &str, to: &str) -> String {
    let whole = whole();
    assert!(whole.contains(from), "{from}");
    whole.replacen(from, to, 1)
}

/// As many patches as the sound part, and its volume.
fn same_as_the_sound_part(name: &str, text: &str) -> Imported {
    let (sound, healed) = (imported("sound", &whole()).unwrap(), imported(name, text).unwrap());
    assert_eq!(healed.patches.len(), sound.patches.len(), "{name}");
    let volume = |of: &Imported| {
        let line = of.report.iter().find(|line| line.starts_with("volume")).unwrap_or_else(|| panic!("{name} is open"));
        line.split_whitespace().nth(2).unwrap().parse::<f64>().unwrap()
    };
    assert!((volume(&sound) - volume(&healed)).abs() < 0.1, "{name}: {}", volume(&healed));
    healed
}

/// The file's own precision, wider than what is moved.
fn precise_to(text: &str, millimetres: &str) -> String {
    let place = text.find("LENGTH_MEASURE(").unwrap() + "LENGTH_MEASURE(".len();
    let end = place + text[place..].find(')').unwrap();
    format!("{}{millimetres}{}", &text[..place], &text[end..])
}

/// One face's own edge where another has one too, moved along x, and the other way round if `is_turned`.
fn with_an_edge_of_its_own(off: f64, is_turned: bool) -> String {
    let whole = whole();
    let point = |id: usize| -> Vec<f64> {
        let start = whole.find(&format!("#{id} = CARTESIAN_POINT('',(")).unwrap();
        let text = &whole[start + format!("#{id} = CARTESIAN_POINT('',(").len()..];
        text[..text.find(')').unwrap()].split(',').map(|number| number.trim().parse().unwrap()).collect()
    };
    let written = |id: usize, of: usize| {
        let [x, y, z] = point(of)[..] else { panic!("three coordinates") };
        format!("#{id} = CARTESIAN_POINT('',({:?},{y:?},{z:?}));\n", x + off)
    };
    let (ends, sense) = if is_turned { ("#9003,#9001", ".F.") } else { ("#9001,#9003", ".T.") };
    let own = format!(
        "#163 = ORIENTED_EDGE('',*,*,#9000,{sense});\n#9000 = EDGE_CURVE('',{ends},#26,{sense});\n\
         #9001 = VERTEX_POINT('',#9002);\n{}#9003 = VERTEX_POINT('',#9004);\n{}",
        written(9002, 23),
        written(9004, 25)
    );
    whole.replacen("#163 = ORIENTED_EDGE('',*,*,#21,.T.);\n", &own, 1)
}

#[test]
fn an_edge_that_each_face_has_for_itself_is_one() {
    for is_turned in [false, true] {
        let healed = same_as_the_sound_part("own-edge", &with_an_edge_of_its_own(0.0, is_turned));
        assert!(healed.report.iter().any(|line| line.starts_with("healed: 1 pair")), "{:?}", healed.report);
    }
}

#[test]
fn a_gap_is_closed_up_to_the_files_precision_and_named_beyond() {
    let open = with_an_edge_of_its_own(5e-5, false);
    same_as_the_sound_part("gap", &precise_to(&open, "2.E-04"));
    let message = imported("wide-gap", &open).unwrap_err();
    assert!(message.contains("(#137)") && message.contains("0.000050 mm"), "{message}");
}

#[test]
fn a_circle_may_begin_elsewhere_in_each_face() {
    let whole = whole();
    let start = whole.find("#265 = EDGE_CURVE('',#266,#266,").unwrap() + "#265 = EDGE_CURVE('',#266,#266,".len();
    let curve = &whole[start..start + whole[start..].find(',').unwrap()];
    let own = format!(
        "#264 = ORIENTED_EDGE('',*,*,#9000,.T.);\n#9000 = EDGE_CURVE('',#9001,#9001,{curve},.T.);\n\
         #9001 = VERTEX_POINT('',#9002);\n#9002 = CARTESIAN_POINT('',(0.,6.,10.));\n"
    );
    let text = edited("#264 = ORIENTED_EDGE('',*,*,#265,.T.);\n", &own);
    assert_eq!(
        imported("circle", &text).unwrap().report.iter().filter(|line| line.starts_with("healed: 2")).count(),
        1
    );
}

/// Every placement along x, of planes and of the circle's end: the default direction lies along it.
#[test]
fn a_direction_of_reference_may_be_left_out() {
    let mut text = whole();
    let along_x: Vec<String> = text
        .lines()
        .filter(|line| line.contains("= DIRECTION('',(1.,0.,") || line.contains("= DIRECTION('',(-1.,0.,"))
        .map(|line| line.split(' ').next().unwrap().to_owned())
        .collect();
    let mut count = 0;
    let lines = text.lines().map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let is_placed = line.contains("= AXIS2_PLACEMENT_3D(") && fields.len() == 4;
        if !is_placed || !along_x.iter().any(|axis| axis == fields[2]) {
            return line.to_owned();
        }
        count += 1;
        format!("{},$);", fields[..3].join(","))
    });
    text = lines.collect::<Vec<_>>().join("\n");
    assert!(count >= 2, "{count}");
    same_as_the_sound_part("no-reference", &text);
}

#[test]
fn editions_of_a_schema_are_read_and_others_named() {
    let known = "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }";
    let edition = "CONFIGURATION_CONTROL_3D_DESIGN_ED2_MIM_LF { 1 0 10303 403 1 1 4}";
    same_as_the_sound_part("edition", &edited(known, edition));
    let message = imported("schema", &edited(known, "IFC4")).unwrap_err();
    assert!(message.contains("IFC4") && message.contains("CONFIGURATION_CONTROL_3D_DESIGN"), "{message}");
}

fn volume(of: &Imported) -> f64 {
    let line = of.report.iter().find(|line| line.starts_with("volume")).unwrap();
    line.split_whitespace().nth(2).unwrap().parse().unwrap()
}

/// A box of 20 mm about a ball of 6 mm whose shell's sense is turned: one face of the file becomes six.
#[test]
fn a_void_that_is_turned_is_turned_back() {
    let found = volume(&part("turned_void").unwrap());
    assert!((found - (8_000.0 - 288.0 * std::f64::consts::PI)).abs() < 1e-3 * 452.0, "{found}");
}

/// An arc of 9 mm about a point beside the axis, turned about it, as a void of a box of 60 mm: an arc of less than half a
/// circle makes a lemon, one of more an apple. In the file both are one vertex on the same kind of surface, and only the
/// sense of the shell tells them apart. Volumes by closed form: π ∫ (c + r cos φ)² r cos φ dφ.
#[test]
fn the_sense_of_a_void_tells_a_lemon_from_an_apple() {
    for (name, beside) in [("lemon_void", -6.0_f64), ("apple_void", 4.0)] {
        let (radius, end) = (9.0_f64, (-beside / 9.0).acos());
        let (sine, twice) = (end.sin(), (2.0 * end).sin());
        let terms = beside * beside * 2.0 * sine
            + 2.0 * beside * radius * (end + 0.5 * twice)
            + radius * radius * 2.0 * (sine - sine.powi(3) / 3.0);
        let known = 216_000.0 - std::f64::consts::PI * radius * terms;
        let imported = part(name).unwrap();
        let found = volume(&imported);
        // Within the deviation on all of the void's face.
        assert!((found - known).abs() < 1e-3 * 2_000.0, "{name}: {found}, {known} known");
        assert!(!imported.report.iter().any(|line| line.contains("healed")), "{name}: {:?}", imported.report);
    }
}

/// A tube of 10 mm about a circle of 1 mm crosses its axis: the outer part, by its closed form.
#[test]
fn a_torus_may_cross_its_axis() {
    let sphere = fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/parts/s06.step")).unwrap();
    let (large, small, angle) = (1.0_f64, 10.0_f64, (-0.1_f64).acos());
    // π ∫ (R + r cos φ)² r cos φ dφ from −angle to angle.
    let (sine, twice) = (angle.sin(), (2.0 * angle).sin());
    let of_square = angle + 0.5 * twice;
    let of_cube = 2.0 * (sine - sine.powi(3) / 3.0);
    let terms = large * large * 2.0 * sine + 2.0 * large * small * of_square + small * small * of_cube;
    let known = std::f64::consts::PI * small * terms;
    let text = sphere.replace("SPHERICAL_SURFACE('',#23,20.)", "TOROIDAL_SURFACE('',#23,1.,10.)");
    let text = text.replace("(1.224646799147E-15,-2.999519565324E-31,-20.)", "(0.,0.,-9.949874371066)");
    let found = volume(&imported("spindle", &text).unwrap());
    assert!((found - known).abs() < 1e-3 * 1_460.0, "{found}, {known} known");
}

/// A circle passes 0.25 µm from its vertex.
#[test]
fn a_vertex_beside_its_edge_is_taken_up_to_the_tolerance() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/parts/vertex_off.step");
    import(&path, &Options::default()).unwrap();
    let message = import(&path, &Options { tolerance: 0.0002, ..Options::default() }).unwrap_err().to_string();
    assert!(message.contains("0.000250 mm from its vertex; repair the shape"), "{message}");
    assert!(message.contains("(--tolerance)"), "{message}");
}

#[test]
fn a_sliver_of_an_edge_is_left_out() {
    let sliver = "#9000 = ORIENTED_EDGE('',*,*,#9002,.T.);\n#9001 = ORIENTED_EDGE('',*,*,#9002,.F.);\n\
        #9002 = EDGE_CURVE('',#22,#9003,#26,.T.);\n#9003 = VERTEX_POINT('',#9004);\n\
        #9004 = CARTESIAN_POINT('',(-20.,-15.,-9.9999999));\n#19 = EDGE_LOOP('',(#20,#9000,#9001,#55,";
    same_as_the_sound_part("sliver", &edited("#19 = EDGE_LOOP('',(#20,#55,", sliver));
}

/// A face 0.03 µm wide, which the tables of a body this large cannot hold.
#[test]
fn a_sliver_of_a_face_is_left_out() {
    let mut text = whole();
    for (from, to) in [
        ("#348 = EDGE_LOOP('',(#349,#350,", "#348 = EDGE_LOOP('',(#349,#9005,#350,"),
        ("#215 = EDGE_LOOP('',(#216,#217,", "#215 = EDGE_LOOP('',(#216,#9006,#217,"),
        ("#139 = EDGE_LOOP('',(#140,#163,", "#139 = EDGE_LOOP('',(#140,#9007,"),
        ("#141 = EDGE_CURVE('',#22,", "#141 = EDGE_CURVE('',#9000,"),
        ("#165 = EDGE_CURVE('',#24,", "#165 = EDGE_CURVE('',#9001,"),
        ("#16 = CLOSED_SHELL('',(", "#16 = CLOSED_SHELL('',(#9020,"),
        ("#16 = ", SLIVER),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let healed = same_as_the_sound_part("sliver-face", &text);
    assert!(healed.report.iter().any(|line| line.contains("(#9020) is narrower than")), "{:?}", healed.report);
}

/// Between the edge #21 and another 3e-5 mm beside it, in the plane #44.
const SLIVER: &str = "#9000 = VERTEX_POINT('',#9002);\n#9001 = VERTEX_POINT('',#9003);\n\
    #9002 = CARTESIAN_POINT('',(-19.99997,-15.,-10.));\n#9003 = CARTESIAN_POINT('',(-19.99997,-15.,10.));\n\
    #9005 = ORIENTED_EDGE('',*,*,#9010,.T.);\n#9006 = ORIENTED_EDGE('',*,*,#9011,.T.);\n\
    #9007 = ORIENTED_EDGE('',*,*,#9012,.T.);\n\
    #9010 = EDGE_CURVE('',#22,#9000,#9013,.T.);\n#9011 = EDGE_CURVE('',#24,#9001,#9014,.T.);\n\
    #9012 = EDGE_CURVE('',#9000,#9001,#9015,.T.);\n\
    #9013 = LINE('',#9002,#9016);\n#9014 = LINE('',#9003,#9016);\n#9015 = LINE('',#9002,#9017);\n\
    #9016 = VECTOR('',#9018,1.);\n#9017 = VECTOR('',#9019,1.);\n\
    #9018 = DIRECTION('',(1.,0.,0.));\n#9019 = DIRECTION('',(0.,0.,1.));\n\
    #9020 = ADVANCED_FACE('',(#9021),#44,.F.);\n#9021 = FACE_BOUND('',#9022,.F.);\n\
    #9022 = EDGE_LOOP('',(#9023,#9024,#9006,#9025));\n#9023 = ORIENTED_EDGE('',*,*,#9010,.F.);\n\
    #9024 = ORIENTED_EDGE('',*,*,#21,.T.);\n#9025 = ORIENTED_EDGE('',*,*,#9012,.F.);\n#16 = ";

#[test]
fn a_face_that_lies_the_wrong_way_round_is_turned() {
    // The face's own sense, then that of its loop alone: there nothing but the loop is to be turned.
    for (name, from, to) in [
        ("sense", "#137 = ADVANCED_FACE('',(#138),#44,.F.)", "#137 = ADVANCED_FACE('',(#138),#44,.T.)"),
        ("loop", "#138 = FACE_BOUND('',#139,.F.)", "#138 = FACE_BOUND('',#139,.T.)"),
    ] {
        let healed = same_as_the_sound_part(name, &edited(from, to));
        let is_said = healed.report.iter().any(|line| line.contains("(#137) lies the wrong way round"));
        assert!(is_said == (name == "sense"), "{name}: {:?}", healed.report);
    }
}

fn part(name: &str) -> Result<Imported, String> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/parts/{name}.step"));
    import(&path, &Options::default()).map_err(|error| error.to_string())
}

/// A hole that touches its cylinder's wall from inside leaves nothing there: no search for quads is begun.
#[test]
fn an_outline_that_touches_itself_is_refused_by_face_and_edges() {
    let message = part("tangent_hole").unwrap_err();
    assert!(message.contains("(#17)") && message.contains("touches itself at (0.000, 15.000, 15.000) mm"), "{message}");
    assert_eq!(message.matches("edge #").count(), 2, "{message}");
    assert!(message.ends_with("move them apart in the CAD program"), "{message}");
}

/// A hole of 10 mm that leaves a wall of half the tolerance in a box of 40 × 30 × 10 mm.
#[test]
fn a_wall_thinner_than_the_tolerance_lowers_it() {
    let thin = part("thin_wall").unwrap();
    let is_said = |line: &String| line.contains("0.005000 mm off") && line.contains("imported within 0.001667 mm");
    assert!(thin.report.iter().any(is_said), "{:?}", thin.report);
    let off = thin.volume_and_area[0] - (12_000.0 - 250.0 * std::f64::consts::PI);
    // A sixth of the wall, over the hole's 314 mm².
    assert!(off.abs() < 314.0 * 0.005 / 6.0, "{off} mm³");
}

/// The same part as its file has it in millimetres, control point by control point.
#[test]
fn lengths_are_in_the_files_unit() {
    let known = imported("millimetres", &whole()).unwrap();
    for unit in ["inch", "metre", "centimetre"] {
        let found = part(&format!("s02_{unit}")).unwrap();
        assert_eq!(found.patches.len(), known.patches.len(), "{unit}");
        for (a, b) in found.patches.iter().zip(&known.patches) {
            for (p, q) in a.surface.points.iter().zip(&b.surface.points) {
                // The file has 13 digits or more, and fits end within 1e-9 of each other.
                assert!(p.distance(*q) < 1e-6, "{unit}: {} {p} {q}", a.name);
            }
        }
    }
}

/// Two products, each in its own context: one of them in centimetres makes no part of one size.
#[test]
fn solids_in_different_units_are_refused() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/parts/s11.step");
    let text = fs::read_to_string(path).unwrap();
    let unit = ".MILLI.,.METRE.";
    assert!(text.matches(unit).count() > 1);
    let last = text.rfind(unit).unwrap();
    let text = format!("{}.CENTI.,.METRE.{}", &text[..last], &text[last + unit.len()..]);
    let message = imported("units", &text).unwrap_err();
    assert!(message.contains("face ") && message.contains("in one unit"), "{message}");
}

/// Validation properties, as CAD systems write them: 24,000 − 720 π mm³.
#[test]
fn a_volume_that_the_file_has_is_compared() {
    let product =
        whole().split(" = PRODUCT_DEFINITION_SHAPE('','',").nth(1).unwrap().split(')').next().unwrap().to_owned();
    let with = |volume: f64, area: f64| {
        let text = format!(
            "#9001 = PROPERTY_DEFINITION('geometric validation property','volume of part',{product});\n\
             #9002 = PROPERTY_DEFINITION_REPRESENTATION(#9001,#9003);\n\
             #9003 = REPRESENTATION('volume',(#9004,#9005),#9010);\n\
             #9004 = MEASURE_REPRESENTATION_ITEM('volume measure',VOLUME_MEASURE({volume:?}),#9006);\n\
             #9005 = MEASURE_REPRESENTATION_ITEM('surface area measure',AREA_MEASURE({area:?}),#9008);\n\
             #9006 = DERIVED_UNIT((#9007));\n#9007 = DERIVED_UNIT_ELEMENT(#9011,3.);\n\
             #9008 = DERIVED_UNIT((#9009));\n#9009 = DERIVED_UNIT_ELEMENT(#9011,2.);\n\
             #9010 = (GEOMETRIC_REPRESENTATION_CONTEXT(3)REPRESENTATION_CONTEXT('',''));\n\
             #9011 = (LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.));\n"
        );
        let whole = whole();
        let end = whole.rfind("ENDSEC;").unwrap();
        imported("properties", &format!("{}{text}{}", &whole[..end], &whole[end..]))
    };
    use std::f64::consts::PI;
    let (volume, area) = (24.0 - 0.72 * PI, 52.0 + 2.4 * PI - 0.72 * PI);
    with(volume, area).unwrap();
    assert!(with(1.01 * volume, area).unwrap_err().contains("volume"));
    assert!(with(volume, 1.01 * area).unwrap_err().contains("area"));
}
