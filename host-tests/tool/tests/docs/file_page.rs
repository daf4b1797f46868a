//! `docs/reference/body-file.md` documents a body's file byte by byte: golden bytes of the file that the baker writes.
//!
//! `PALPATE_WRITE=1 cargo test -p palpate-tool --test docs file_page` writes bytes and values of the tables.

use crate::byte_tables::{numbers, table, written};
use crate::pages::{blocks, compare, text};
use palpate::body::{FILE_VERSION, Section};
use palpate_bake::{BakedBody, Model, file};

const PAGE: &str = "docs/reference/body-file.md";
/// Letters of a section and its length.
const SECTION_HEAD: usize = 8;

/// The CRC-32 in the last table is golden for the records that the page does not show.
#[test]
fn every_byte_of_a_body_file_is_documented() {
    let mut page = text(PAGE);
    let model = Model::parse(blocks(&page, "toml")[0], "tile.toml").expect("the example is a model");
    let body = BakedBody::new(&model, "tile.toml").expect("and a body");
    let source: [u8; 32] = std::array::from_fn(|index| index as u8);
    let file = file::write(source, &model, &body).expect("it can be written");
    assert_eq!(file[4..8], FILE_VERSION.to_le_bytes());

    let mut at = 0;
    for title in ["Head"].into_iter().chain(Section::ALL.map(Section::letters)).chain(["End"]) {
        let (before, mut rows, rest, after) = table(&page, title);
        let start = at;
        for row in &mut rows {
            row.bytes = file[at..at + row.bytes.len()].to_vec();
            if let Some(shown) = numbers(&row.kind, &row.bytes).filter(|_| row.kind != "32 u8" && title != "End") {
                row.value = shown;
            } else if row.kind == "text" {
                row.value = String::from_utf8_lossy(&row.bytes).trim_end_matches('\0').to_owned();
            }
            at += row.bytes.len();
        }
        let mut more = String::new();
        if Section::ALL.iter().any(|section| section.letters() == title) {
            let length = u32::from_le_bytes(*rows[1].bytes.as_array().expect("a length")) as usize;
            let record = at - start - SECTION_HEAD;
            assert_eq!(length % record, 0, "{title}: {length} bytes are no number of records of {record}");
            if length > record {
                more = format!("\n{} more like it.\n", length / record - 1);
            }
            at = start + SECTION_HEAD + length;
        }
        assert!(rest.is_empty() || rest.contains(" more like it."), "{title}: {rest}");
        page = [before, &written(&rows, start), &more, after].concat();
    }
    assert_eq!(at, file.len(), "bytes after the end");
    compare(PAGE, &page);
}
