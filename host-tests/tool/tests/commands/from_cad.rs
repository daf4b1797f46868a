//! Parts from CAD as `palpate import` makes them, beside what a quad mesher's route makes of the same parts.

use std::error::Error;
use std::process::Command;

/// The part; patches and bytes of tables of the mesher's route, each of its cubic quads a patch, baked by this same
/// code; those of the box as they were when the route was tried.
const MESHED: [(&str, usize, usize); 3] =
    [("cad_box", 24, 29_000), ("cad_knob", 158, 251_760), ("cad_filleted_box", 240, 271_956)];

#[test]
fn imported_parts_take_a_third_of_the_patches_and_bytes_of_meshed_ones() -> Result<(), Box<dyn Error>> {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/howto/cad.md"))?;
    for (part, patches, bytes) in MESHED {
        let model = format!("{}/../suites/data/{part}.toml", env!("CARGO_MANIFEST_DIR"));
        let run = Command::new(env!("CARGO_BIN_EXE_palpate")).args(["parts", &model]).output()?;
        let table = String::from_utf8(run.stdout)?;
        let row: Vec<&str> = table.lines().last().ok_or("no row")?.split('|').map(str::trim).collect();
        assert_eq!(row[1], part, "{table}");
        let (own, flash): (usize, usize) = (row[3].parse()?, row[5].parse()?);
        println!("{part}: {own} patches and {flash} bytes, meshed {patches} and {bytes}");
        let [fewer, smaller] = [(patches, own), (bytes, flash)].map(|(of, to)| of as f64 / to as f64);
        let row = format!(" | {patches} | {own} | {fewer:.1} | {bytes} | {flash} | {smaller:.1} |\n");
        assert!(page.contains(&row), "docs/howto/cad.md has another row than{row}");
        assert!(3 * own <= patches, "{part}: {own} patches");
        assert!(3 * flash <= bytes, "{part}: {flash} bytes");
    }
    Ok(())
}
