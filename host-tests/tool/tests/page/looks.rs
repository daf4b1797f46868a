//! Reports, figures and the page as a reader has them, on a phone and on wide screens, light and dark: no words over
//! each other, cut, too small or too pale.

use crate::browser::Page;
use crate::tool::{address, palpate_in, repository};
use anyhow::{Context as _, ensure};
use serde_json::json;
use std::fs;

/// Finds the faults of a page as it stands.
const FAULTS: &str = include_str!("looks.js");
/// A phone, a laptop, a desk.
const WIDTHS: [u32; 3] = [390, 1280, 1920];
const HEIGHT: u32 = 800;
/// Of the page: also where its panel leaves the least to its scene, phones upright and across, and letters of twice the
/// size; width, height, and the browser's letters, px.
const SIZES: [(u32, u32, u32); 11] = [
    (390, HEIGHT, 16),
    (1280, HEIGHT, 16),
    (1920, HEIGHT, 16),
    (1100, HEIGHT, 16),
    (1366, HEIGHT, 16),
    (844, 390, 16),
    (740, 360, 16),
    (320, 640, 16),
    (195, 422, 16),
    (390, 844, 32),
    (844, 390, 32),
];
const SCHEMES: [&str; 2] = ["light", "dark"];

fn faults(page: &Page, of: &str) -> anyhow::Result<Vec<String>> {
    let found = page.ask(FAULTS)?;
    let found = found.as_array().with_context(|| format!("{of}: {found}"))?;
    Ok(found.iter().map(|fault| format!("{of}: {}", fault.as_str().unwrap_or_default())).collect())
}

/// Figures that a phone does not show legibly: the paper's sheets, which open by themselves.
const WIDE: [&str; 2] = ["-figure", "-rate"];

/// A page that has every fault.
const BAD: &str = "data:text/html,<body style='margin:0'><p style='position:absolute'>over<p style='position:absolute'>\
    under</p><div style='position:absolute;top:90px;left:370px'>beside</div><div style='position:absolute;top:140px;width:\
    40px;overflow:hidden;white-space:nowrap'>cut off here</div><p style='position:absolute;top:190px;font-size:6px'>small\
    <p style='position:absolute;top:240px;color:%23eee'>pale</p><svg style='position:absolute;top:300px' width=50 height=50>\
    <text x=40 y=20>out of it</text></svg>";

#[test]
fn no_words_of_reports_and_figures_are_covered_cut_small_or_pale() -> anyhow::Result<()> {
    let page = Page::empty()?;
    page.set_size([390, HEIGHT], 1.0)?;
    page.go(BAD)?;
    let seen = faults(&page, "the bad page")?.join("; ");
    for fault in ["over each other", "the page's side", "cut by DIV", "px high", "a contrast of", "cut by its plot"] {
        ensure!(seen.contains(fault), "{fault:?} is not found: {seen}");
    }
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    palpate_in(folder.path(), &["demo", "--host", "--report", "demo.html"])?;
    palpate_in(folder.path(), &["demo", "--device", "knob", "--host", "--report", "knob.html"])?;
    palpate_in(folder.path(), &["feel", "--device", "phantom-premium", "--out", "feel"])?;
    let mut all = Vec::new();
    for report in ["demo.html", "knob.html", "feel/report.html"] {
        page.go(&format!("file://{}", path(report)))?;
        for width in WIDTHS {
            page.set_size([width, HEIGHT], 1.0)?;
            for scheme in SCHEMES {
                page.prefer(scheme)?;
                all.extend(faults(&page, &format!("{report}, {width} px, {scheme}"))?);
                photograph(&page, report, width, scheme)?;
            }
        }
    }
    page.set_size([1000, HEIGHT], 1.0)?;
    let mut figures = 0;
    for entry in fs::read_dir(repository("docs/figures"))? {
        let file = entry?.path();
        if file.extension().is_none_or(|extension| extension != "svg") {
            continue;
        }
        figures += 1;
        page.go(&format!("file://{}", file.display()))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        // As wide as a phone shows it in a page.
        if !WIDE.iter().any(|part| name.contains(part)) {
            page.ask("document.documentElement.setAttribute('width', '350')")?;
        }
        for scheme in SCHEMES {
            page.prefer(scheme)?;
            all.extend(faults(&page, &format!("{name}, {scheme}"))?);
        }
    }
    ensure!(figures > 20, "{figures} figures");
    ensure!(all.is_empty(), "{} faults:\n{}", all.len(), all.join("\n"));
    Ok(())
}

#[test]
fn no_words_of_the_page_are_covered_cut_small_or_pale() -> anyhow::Result<()> {
    // Before the browser starts, which does not wait while this builds.
    let address = address();
    let page = Page::empty()?;
    page.run(&address)?;
    let mut all = Vec::new();
    for (width, height, letters) in SIZES {
        let sizes = serde_json::json!({ "fontSizes": { "standard": letters, "fixed": letters } });
        page.call("Page.setFontSizes", &sizes)?;
        // Small: a processor draws each frame.
        page.set_size([width, height], 0.25)?;
        for scheme in SCHEMES {
            page.prefer(scheme)?;
            all.extend(faults_of_page(&page, &format!("{width} × {height}, letters of {letters} px, {scheme}"))?);
        }
        page.ask("palpate.take('capped_box')")?;
    }
    let sizes = serde_json::json!({ "fontSizes": { "standard": 16, "fixed": 16 } });
    page.call("Page.setFontSizes", &sizes)?;
    photograph_page(&page)?;
    ensure!(all.is_empty(), "{} faults:\n{}", all.len(), all.join("\n"));
    Ok(())
}

/// Words that the body lies under.
const COVERS: &str = "(() => {
    const { room } = palpate.page, { left, top, width, height } = room.canvas.getBoundingClientRect();
    room.resize();
    room.draw(false);
    const words = [...document.querySelectorAll('h1, header p, #caption, #legend li, .help')].filter((word) => word.checkVisibility());
    const place = room.camera.position.clone(), found = new Set();
    for (const face of room.faces) {
        const position = face.geometry.getAttribute('position');
        for (let at = 0; at < position.count; at += 1) {
            place.fromBufferAttribute(position, at).applyMatrix4(face.matrixWorld).project(room.camera);
            const x = left + ((1 + place.x) / 2) * width, y = top + ((1 - place.y) / 2) * height;
            for (const word of words) {
                const box = word.getBoundingClientRect();
                if (x > box.left && x < box.right && y > box.top && y < box.bottom) found.add(word.textContent);
            }
        }
    }
    return [...found];
})()";

/// The same of each panel of the page, of a refusal, of a device and of explanations.
fn faults_of_page(page: &Page, at: &str) -> anyhow::Result<Vec<String>> {
    let mut all = Vec::new();
    for panel in ["feel", "basin", "proof", "knob"] {
        page.ask(&format!("palpate.panel('{panel}')"))?;
        page.ask("palpate.drawn(2)")?;
        all.extend(faults(page, &format!("page, {panel}, {at}"))?);
        // Each row says what it is.
        let rows = format!(
            "[...document.querySelectorAll('section[data-tab={panel}] :is(dt, .sliders label)')].filter((row) => \
             (row.dataset.why ?? row.querySelector('[data-why]')?.dataset.why ?? '').length < 15 && row.checkVisibility())\
             .map((row) => row.textContent.trim().slice(0, 20))"
        );
        let rows = page.ask(&rows)?;
        let is_bare = panel != "basin" && rows.as_array().is_none_or(|rows| !rows.is_empty());
        ensure!(!is_bare, "{panel}: not explained: {rows}");
    }
    // The dial is no word, and yet it may not lie over any.
    let apart = "(() => { const { x, y, radius } = palpate.page.knob.places().dial, canvas = document.getElementById('dial'); \
        const scale = canvas.clientWidth / canvas.width, box = canvas.getBoundingClientRect(); \
        const at = [box.left + x * scale, box.top + y * scale]; \
        const { right, bottom } = document.querySelector('header').getBoundingClientRect(); \
        const away = Math.hypot(Math.max(at[0] - right, 0), Math.max(at[1] - bottom, 0)); \
        return away - 1.25 * radius * scale; })()";
    ensure!(page.number(apart)? > 0.0, "the dial lies over the head at {at}");
    let small = page.number(
        "(({ radius }, { width, clientWidth }) => (radius * clientWidth) / width)\
        (palpate.page.knob.places().dial, document.getElementById('dial'))",
    )?;
    ensure!(small > 30.0, "a dial of {small} px at {at}");
    page.ask("palpate.panel('feel')")?;
    page.ask("palpate.drawn(2)")?;
    let covers = page.ask(COVERS)?;
    ensure!(covers == serde_json::json!([]), "the body lies over {covers} at {at}");
    // Close up it does: the caption has a ground of its own, which `faults` compares its words with.
    let ground = page.ask("getComputedStyle(document.getElementById('caption').firstElementChild).backgroundColor")?;
    ensure!(ground.as_str().is_some_and(|colour| colour.starts_with("rgb(")), "below the caption: {ground}");
    page.ask("palpate.holdDevice('woodenhaptics-2016')")?;
    all.extend(faults(page, &format!("page with a device, {at}"))?);
    page.ask("palpate.holdDevice('')")?;
    page.ask("palpate.open('no.palp', 'AAAA')")?;
    all.extend(faults(page, &format!("page with a refusal, {at}"))?);
    for word in ["boundary mode", "gain", "evaluations a tick", "law"] {
        let why = format!("[...document.querySelectorAll('[data-why]')].find((word) => word.textContent === '{word}')");
        page.ask(&format!("{why}.scrollIntoView({{ block: 'center' }})"))?;
        // A finger that scrolls over the word explains nothing.
        page.ask("palpate.drawn(2)")?;
        page.ask("document.getElementById('why').hidden = true")?;
        page.ask(&format!("{why}.dispatchEvent(new PointerEvent('pointerenter', {{ pointerType: 'touch' }}))"))?;
        ensure!(page.ask("document.getElementById('why').hidden")? == true, "a finger that scrolls explains {word}");
        page.ask(&format!("{why}.dispatchEvent(new PointerEvent('pointerenter', {{ pointerType: 'mouse' }}))"))?;
        let bubble = "(({ hidden, textContent }) => !hidden && textContent.length)(document.getElementById('why'))";
        ensure!(page.number(bubble)? > 40.0, "{word} is not explained");
        let inside = "(({ left, right, bottom }) => left >= 0 && right <= innerWidth && bottom <= innerHeight)\
                      (document.getElementById('why').getBoundingClientRect())";
        ensure!(page.ask(inside)? == true, "the explanation of {word} is cut at {at}");
    }
    page.ask("document.getElementById('why').hidden = true")?;
    page.ask("document.querySelector('aside').scrollTo(0, 0)")?;
    Ok(all)
}

/// The page's pictures in the documentation, on a phone and of the knob.
fn photograph_page(page: &Page) -> anyhow::Result<()> {
    if std::env::var_os("PALPATE_WRITE").is_none() {
        return Ok(());
    }
    for (name, scheme, pointer, shown, size) in [
        ("page-phone", "dark", "coarse", "palpate.panel('feel'), palpate.show(18.4)", [390, 844]),
        ("page-knob", "light", "fine", "palpate.panel('knob').then(() => palpate.turnKnob(0.5, 4000))", [900, 600]),
    ] {
        let features = [("prefers-color-scheme", scheme), ("pointer", pointer)];
        let features = features.map(|(name, value)| serde_json::json!({ "name": name, "value": value }));
        page.call("Emulation.setEmulatedMedia", &serde_json::json!({ "features": features }))?;
        let touch = serde_json::json!({ "enabled": pointer == "coarse", "maxTouchPoints": 5 });
        page.call("Emulation.setTouchEmulationEnabled", &touch)?;
        page.ask(shown)?;
        page.ask("palpate.draw(true)")?;
        page.ask("palpate.drawn(30)")?;
        fs::write(repository(&format!("docs/figures/{name}.webp")), page.picture(size, "body")?)?;
        page.ask("palpate.draw(false)")?;
    }
    Ok(())
}

/// The reports' pictures in the documentation: which, how wide, light or dark.
const PICTURES: [(&str, u32, &str, &str); 3] = [
    ("demo.html", 1280, "light", "report-demo"),
    ("knob.html", 390, "light", "report-knob"),
    ("feel/report.html", 390, "dark", "report-feel"),
];

fn photograph(page: &Page, report: &str, width: u32, scheme: &str) -> anyhow::Result<()> {
    let wanted = PICTURES.iter().find(|(of, at, prefers, _)| (*of, *at, *prefers) == (report, width, scheme));
    if let (Some((.., name)), Some(_)) = (wanted, std::env::var_os("PALPATE_WRITE")) {
        fs::write(repository(&format!("docs/figures/{name}.webp")), page.photograph()?)?;
    }
    Ok(())
}

/// A browser without WebGL, as one with neither a graphics card nor a replacement.
const NO_WEBGL: &str = "HTMLCanvasElement.prototype.getContext = (get => function (kind, ...how) { \
    return kind.startsWith('webgl') ? null : get.call(this, kind, ...how); })(HTMLCanvasElement.prototype.getContext)";
/// Words that a reader sees about it.
const NO_PICTURE: &str =
    "document.getElementById('no-webgl').offsetHeight && document.getElementById('no-webgl').textContent";

#[test]
fn without_webgl_the_page_names_it_and_works_but_for_the_picture() -> anyhow::Result<()> {
    let page = Page::empty()?;
    page.set_size([390, HEIGHT], 1.0)?;
    let added = page.call("Page.addScriptToEvaluateOnNewDocument", &json!({ "source": NO_WEBGL }))?;
    page.go(&address())?;
    let words = page.ask(NO_PICTURE)?;
    ensure!(words.as_str().is_some_and(|words| words.contains("no WebGL 2")), "{words}: {:?}", page.errors());
    page.comes_to("window.palpate.ready")?;
    let found = faults(&page, "without WebGL")?;
    ensure!(found.is_empty(), "{}", found.join("\n"));
    ensure!(page.number("document.getElementById('body').length")? > 5.0, "bodies are missing from the list");
    page.ask("palpate.take('sphere_body')")?;
    let pressed = "palpate.hold([0, 0, 0.499 * palpate.about().size], 2000).gap / palpate.about().size";
    let gap = page.number(pressed)?;
    ensure!((gap + 0.001).abs() < 1e-4, "pressed to a gap of {gap} sizes");
    page.ask("palpate.drawn(3)")?;
    page.ask("palpate.panel('knob')")?;
    let torque = page.number("palpate.turnKnob(0.05, 4000).torque")?;
    ensure!(torque < -1e-3, "a turned dial's torque is {torque} N·m");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    page.call("Page.removeScriptToEvaluateOnNewDocument", &added)?;
    // From one place of a page to another nothing is loaded.
    page.go("about:blank")?;
    page.run(&address())?;
    let words = page.ask(NO_PICTURE)?;
    ensure!(words == 0, "with WebGL: {words}");
    Ok(())
}
