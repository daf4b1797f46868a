//! The page that documents a body's file byte by byte, against the file as it is.
//!
//! The file is put together here with other means than the baker's: field after field of every record, and a CRC of one
//! line. `PALPATE_WRITE=1 cargo test -p palpate-tool --test docs file_page` writes the tables anew.

use crate::pages::{blocks, compare, text};
use palpate::body::{FILE_VERSION, Section};
use palpate::math::Vec3;
use palpate_bake::body::{BakedCurve, BakedEdge, BakedFace, BakedSeparator, BakedSide};
use palpate_bake::{BakedBody, BakedCoefficients, Model, file};
use std::fmt::Write as _;

const PAGE: &str = "docs/reference/body-file.md";

/// A field as it is documented.
struct Field {
    name: String,
    kind: &'static str,
    value: String,
    bytes: Vec<u8>,
}

fn field(name: impl Into<String>, kind: &'static str, value: impl ToString, bytes: impl Into<Vec<u8>>) -> Field {
    Field { name: name.into(), kind, value: value.to_string(), bytes: bytes.into() }
}

fn byte(name: &str, number: u8) -> Field {
    field(name, "u8", number, [number])
}

fn half(name: &str, number: u16) -> Field {
    field(name, "u16", number, number.to_le_bytes())
}

fn word(name: &str, number: u32) -> Field {
    field(name, "u32", number, number.to_le_bytes())
}

fn real(name: &str, number: f32) -> Field {
    field(name, "f32", number, number.to_le_bytes())
}

fn reals(name: &str, numbers: &[f32]) -> Field {
    let kind = match numbers.len() {
        2 => "two f32",
        3 => "three f32",
        _ => "four f32",
    };
    let value: Vec<_> = numbers.iter().map(f32::to_string).collect();
    field(name, kind, value.join(", "), numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>())
}

fn vector(name: &str, vector: Vec3) -> Field {
    reals(name, &vector.to_array())
}

fn doubles(name: &str, numbers: [f64; 2]) -> Field {
    let value = format!("{}, {}", numbers[0], numbers[1]);
    field(name, "two f64", value, numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>())
}

/// A name's length, its letters and zeros.
fn named(what: &str, name: &str) -> [Field; 2] {
    let mut bytes = name.as_bytes().to_vec();
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    [
        word(&format!("length of the {what}'s name"), name.len() as u32),
        field(format!("{what}'s name"), "text", name, bytes),
    ]
}

/// CRC-32, bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 })
    })
}

fn is_rational(coefficients: &BakedCoefficients) -> u8 {
    u8::from(matches!(coefficients, BakedCoefficients::Rational(_)))
}

/// Where a list of borders begins. The example has one list.
const BORDERS_AT: u32 = 0;

fn curve(curve: &BakedCurve) -> Vec<Field> {
    vec![
        byte("degree", curve.degree),
        byte("rational", is_rational(&curve.coefficients)),
        half("borders", curve.breaks.len() as u16),
        word("begin at", BORDERS_AT),
        real("second derivative", curve.second_derivative),
    ]
}

fn side(number: usize, side: &BakedSide) -> Vec<Field> {
    let BakedSide::Edge { edge, reversed, separator } = side else { panic!("the example has no poles") };
    let head = |kind: u8| {
        vec![byte(&format!("side {number}: kind"), kind), byte("reversed", u8::from(*reversed)), half("edge", *edge)]
    };
    match separator {
        BakedSeparator::Plane { across, offset } => {
            let mut fields = head(1);
            fields.extend([reals("across", across), real("offset", *offset)]);
            fields
        }
        BakedSeparator::Ruled(of) => {
            let mut fields = head(2);
            fields.extend(curve(of));
            fields.push(word("zero", 0));
            fields
        }
    }
}

fn face(BakedFace { patch, sides, .. }: &BakedFace) -> Vec<Field> {
    let (shape, third) = (&patch.shape, &patch.shape.third_derivatives);
    let second = &shape.second_derivatives;
    let mut fields = vec![
        byte("degree along u", patch.degree[0]),
        byte("degree along v", patch.degree[1]),
        byte("rational", is_rational(&patch.coefficients)),
        byte("inward", 0),
        half("borders along u", patch.breaks[0].len() as u16),
        half("borders along v", patch.breaks[1].len() as u16),
        word("those along u begin at", BORDERS_AT),
        word("those along v begin at", BORDERS_AT),
        reals("second derivatives: uu, uv, vv", &[second.uu, second.uv, second.vv]),
        reals("third derivatives: uuu, uuv, uvv, vvv", &[third.uuu, third.uuv, third.uvv, third.vvv]),
        reals("jumps: uu, vv", &[third.jump_uu, third.jump_vv]),
        reals("curvature: least, greatest", &[shape.curvature.min, shape.curvature.max]),
        reals("stretch: least, greatest", &[shape.min_stretch, shape.max_stretch]),
        real("bend", shape.max_bend),
        real("size", patch.size),
    ];
    fields.extend(sides.iter().enumerate().flat_map(|(number, of)| side(number, of)));
    fields
}

fn edge(edge: &BakedEdge) -> Vec<Field> {
    let mut fields = curve(&edge.curve);
    fields.extend([
        real("third derivative", edge.third_derivative[0]),
        real("jump", edge.third_derivative[1]),
        half("first face", edge.faces[0].face),
        byte("its side", edge.faces[0].side),
        byte("kind of the edge", edge.kind as u8),
        half("second face", edge.faces[1].face),
        byte("its side", edge.faces[1].side),
        byte("zero", 0),
        half("vertex at 0", edge.ends[0]),
        half("vertex at 1", edge.ends[1]),
    ]);
    fields
}

/// The records of every section.
fn sections(model: &Model, body: &BakedBody, source: [u8; 32]) -> Vec<(Section, Vec<Vec<Field>>)> {
    let table_crc = body.to_body().expect("it is one").table_crc();
    let whole = vec![
        word("CRC-32 of the tables", table_crc),
        word("convex", u32::from(body.is_convex)),
        real("size", body.size),
        vector("corner", body.locator.corner),
        real("side", body.locator.side),
        vector("centre", model.centre.as_vec3()),
    ];
    let borders = body.distinct_breaks().concat().into_iter().map(|border| vec![real("border", border)]);
    let mut entries = Vec::new();
    let mut add = |coefficients: &BakedCoefficients| match coefficients {
        BakedCoefficients::Polynomial(of) => entries.extend(of.iter().map(|entry| vec![reals("entry", entry)])),
        BakedCoefficients::Rational(of) => entries.extend(of.iter().map(|entry| vec![reals("entry", entry)])),
    };
    for face in &body.faces {
        add(&face.patch.coefficients);
        for side in &face.sides {
            if let BakedSide::Edge { separator: BakedSeparator::Ruled(curve), .. } = side {
                add(&curve.coefficients);
            }
        }
    }
    body.edges.iter().for_each(|edge| add(&edge.curve.coefficients));
    let vertices = body.vertices.iter().map(|vertex| {
        vec![
            vector("point", vertex.point),
            vector("outward", vertex.outward),
            half("first spoke", vertex.first_spoke),
            half("spokes", vertex.spokes),
            byte("open", u8::from(vertex.is_open)),
            field("zeros", "three u8", "0, 0, 0", [0; 3]),
        ]
    });
    let spokes = body.spokes.iter().map(|spoke| {
        vec![
            vector("direction", spoke.direction),
            half("edge", spoke.edge),
            byte("at 1", u8::from(spoke.at_upper_end)),
            byte("zero", 0),
        ]
    });
    let nodes = body.locator.nodes.iter().map(|node| {
        let value: Vec<_> = node.iter().map(u16::to_string).collect();
        let bytes: Vec<u8> = node.iter().flat_map(|child| child.to_le_bytes()).collect();
        vec![field("children", "eight u16", value.join(", "), bytes)]
    });
    let mut notes = vec![word("units a metre", 1000), word("patches", 1)];
    notes.extend(named("model", "tile"));
    notes.extend(named("patch", "top"));
    notes.extend([word("patch of the face", 0), doubles("from u, v", [0.0; 2]), doubles("to u, v", [1.0; 2])]);
    vec![
        (Section::Source, vec![vec![field("SHA-256", "32 u8", "of the text above", source)]]),
        (Section::Body, vec![whole]),
        (Section::Borders, borders.collect()),
        (Section::Coefficients, entries),
        (Section::Faces, body.faces.iter().map(face).collect()),
        (Section::Edges, body.edges.iter().map(edge).collect()),
        (Section::Vertices, vertices.collect()),
        (Section::Spokes, spokes.collect()),
        (Section::Nodes, nodes.collect()),
        (Section::Entries, body.locator.entries.iter().map(|entry| vec![word("candidate", *entry)]).collect()),
        (Section::Notes, vec![notes]),
    ]
}

/// A table of fields from a place in the file on.
fn table(fields: &[Field], mut at: usize) -> String {
    let mut text = String::from("| at | bytes | field | kind | value |\n|---|---|---|---|---|\n");
    for Field { name, kind, value, bytes } in fields {
        let shown = bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ");
        let _ = writeln!(text, "| {at} | `{shown}` | {name} | {kind} | {value} |");
        at += bytes.len();
    }
    text
}

/// The page with the table of a section as it should be.
fn with_table(page: &str, title: &str, wanted: &str) -> String {
    let heading = format!("## {title}\n");
    let start = page.find(&heading).unwrap_or_else(|| panic!("the page has no section {title}")) + heading.len();
    let end = page[start..].find("\n## ").map_or(page.len(), |at| start + at);
    let table = start + page[start..end].find("| at |").unwrap_or_else(|| panic!("section {title} has no table"));
    format!("{}{wanted}{}", &page[..table], &page[end..])
}

fn add(all: &mut Vec<u8>, fields: &[Field]) {
    fields.iter().for_each(|field| all.extend(&field.bytes));
}

#[test]
fn every_byte_of_a_body_file_is_documented() {
    let mut page = text(PAGE);
    let example = blocks(&page, "toml")[0].to_owned();
    let model = Model::parse(&example, "tile.toml").expect("the example is a model");
    let body = BakedBody::new(&model, "tile.toml").expect("and a body");
    assert_eq!(body.distinct_breaks(), [[0.0, 1.0]], "{BORDERS_AT} is where they begin");
    let source: [u8; 32] = std::array::from_fn(|index| index as u8);
    let written = file::write(source, &model, &body).expect("it can be written");

    let head = |length: usize| {
        [
            field("begins", "text", "PALP", *b"PALP"),
            word("version", FILE_VERSION),
            word("length of the file", length as u32),
        ]
    };
    page = with_table(&page, "Head", &table(&head(written.len()), 0));
    let mut all = Vec::new();
    add(&mut all, &head(written.len()));
    for (section, records) in sections(&model, &body, source) {
        let length = records.iter().flatten().map(|field| field.bytes.len() as u32).sum();
        let letters = section.letters();
        let mut fields =
            vec![field("begins", "text", letters, letters.as_bytes()), word("length of the section", length)];
        let (at, records_of) = (all.len(), records.len());
        let mut records = records.into_iter();
        fields.extend(records.next().expect("the example has one of each"));
        let many = if records_of > 1 { format!("\n{} more like it.\n", records_of - 1) } else { String::new() };
        page = with_table(&page, letters, &(table(&fields, at) + &many));
        add(&mut all, &fields);
        records.for_each(|record| add(&mut all, &record));
    }
    let end = [field("CRC-32", "u32", "of all before", crc(&all).to_le_bytes())];
    page = with_table(&page, "End", &table(&end, all.len()));
    add(&mut all, &end);
    let differs = all.iter().zip(&written).position(|(wanted, byte)| wanted != byte);
    assert_eq!((differs, all.len()), (None, written.len()), "from this byte on the file is not as documented");
    compare(PAGE, &page);
}
