//! What a reader sees, and the pictures of it in the documentation.

use crate::browser::Page;
use crate::tool::repository;
use anyhow::ensure;
use std::fs;
use std::thread;
use std::time::Duration;

/// The pictures: what is done before each.
const PICTURES: [(&str, &str); 2] = [
    ("page", "palpate.take('capped_box').then(() => palpate.panel('feel')).then(() => palpate.show(7.4))"),
    ("page-basin", "palpate.take('table1').then(() => palpate.panel('basin')).then(() => palpate.settled())"),
];

#[test]
fn a_reader_sees_a_body_and_a_basin() -> anyhow::Result<()> {
    let page = Page::open()?;
    for (name, before) in PICTURES {
        page.ask(before)?;
        // A few frames, for lights and lines to settle.
        thread::sleep(Duration::from_secs(2));
        let picture = page.picture()?;
        // One colour all over would be a few KB.
        ensure!(picture.len() > 60_000, "{name}: a picture of {} bytes shows nothing", picture.len());
        if std::env::var_os("PALPATE_WRITE").is_some() {
            fs::write(repository(&format!("docs/figures/{name}.png")), &picture)?;
        }
    }
    let state = page.ask("palpate.state()")?;
    let [ours, newtons] = [0, 1].map(|index| state["arrived"][index].as_u64().unwrap_or_default());
    println!("of {} starts on Table I arrive: palpate {ours}, the paper's Newton {newtons}", 48 * 48);
    ensure!(ours == 48 * 48 && newtons < ours, "{state}");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}
