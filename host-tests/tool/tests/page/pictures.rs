//! What a reader sees, and the pictures of it in the documentation.

use crate::browser::Page;
use crate::tool::repository;
use anyhow::ensure;
use std::fs;

/// The pictures: what is done before each, the window, and what of it is shown: legible on a phone, too.
const PICTURES: [(&str, &str, [u32; 2], &str); 2] = [
    (
        "page",
        "palpate.take('capped_box').then(() => palpate.panel('feel')).then(() => palpate.show(18.4))",
        [900, 620],
        "body",
    ),
    (
        "page-basin",
        "palpate.take('table1').then(() => palpate.panel('basin')).then(() => palpate.settled())",
        [1280, 660],
        "aside",
    ),
];

/// How much of the picture is not empty.
const FILLED: &str = "(() => {
    const small = Object.assign(document.createElement('canvas'), { width: 100, height: 80 });
    const context = small.getContext('2d');
    context.drawImage(document.getElementById('scene'), 0, 0, 100, 80);
    const { data } = context.getImageData(0, 0, 100, 80);
    return data.filter((value, index) => index % 4 === 3 && value > 200).length / 8000;
})()";

#[test]
fn a_reader_sees_a_body_and_a_basin() -> anyhow::Result<()> {
    let page = Page::open()?;
    page.prefer("dark")?;
    for (name, before, size, of) in PICTURES {
        page.ask(before)?;
        // In each frame lights and stylus go an eighth of their way at least: after so many, all but a two-hundredth.
        page.ask("palpate.drawn(40)")?;
        let picture = page.picture(size, of)?;
        // The room is empty where nothing stands.
        let filled = page.number(FILLED)?;
        ensure!((0.05..0.9).contains(&filled), "{name}: {filled} of the picture is filled");
        if std::env::var_os("PALPATE_WRITE").is_some() {
            fs::write(repository(&format!("docs/figures/{name}.webp")), &picture)?;
        }
    }
    let state = page.ask("palpate.state()")?;
    let [ours, newtons] = [0, 1].map(|index| state["arrived"][index].as_u64().unwrap_or_default());
    println!("of {} starts on Table I arrive: palpate {ours}, the paper's Newton {newtons}", 48 * 48);
    ensure!(ours == 48 * 48 && newtons < ours, "{state}");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// What the plot of both methods' distances draws: its words, and how many places.
const PLOTTED: &str = "(({ basin }) => {
    const { falls } = basin, words = [];
    let places = 0;
    falls.fillText = (text) => words.push(text);
    falls.lineTo = () => (places += 1);
    basin.plot();
    delete falls.fillText;
    delete falls.lineTo;
    return { words, places };
})(palpate.page)";

#[test]
fn the_plot_of_the_steps_draws_all_that_the_sentence_counts() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    let mut longest = 0;
    for (body, law) in [("table1", 0), ("table1", 1), ("teapot", 0)] {
        page.ask(&format!("palpate.take('{body}').then(() => palpate.panel('basin')).then(() => palpate.settled())"))?;
        page.ask(&format!(
            "((list) => {{ list.value = {law}; list.dispatchEvent(new Event('change')); }})(document.getElementById('basin-law'))"
        ))?;
        page.ask("palpate.settled()")?;
        let note = page.ask("document.getElementById('basin-note').textContent")?;
        let note = note.as_str().unwrap_or_default();
        let steps = note.split("after ").skip(1).filter_map(|rest| rest.split(' ').next()?.parse::<u64>().ok());
        let steps: Vec<u64> = steps.collect();
        let plotted = page.ask(PLOTTED)?;
        println!("{body}, law {law}: {note} {plotted}");
        let most = steps.iter().copied().max().unwrap_or_default();
        let words = plotted["words"].as_array().into_iter().flatten();
        let is_named = words.into_iter().any(|text| text == &format!("{} steps", most.max(7)));
        ensure!(steps.len() == 2 && is_named, "{note} {plotted}");
        ensure!(plotted["places"].as_u64() == Some(steps.iter().sum::<u64>() + 2), "{note} {plotted}");
        longest = longest.max(most);
    }
    ensure!(longest > 60, "{longest} steps at most");
    // No words about a stylus, which does not move there.
    let hints = "[...document.querySelectorAll('.hand')].filter((words) => words.checkVisibility()).length";
    ensure!(page.number(hints)? == 0.0, "hints about the stylus");
    page.ask("palpate.panel('feel')")?;
    ensure!(page.number(hints)? == 1.0, "no hint about the stylus");
    Ok(())
}
