//! The report as one HTML file that needs nothing beside it.

use super::Page;
use super::plots;
use anyhow::Context;
use std::fmt::Write as _;
use std::path::Path;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;color:#1b1f24;max-width:60rem;margin:2rem auto;padding:0 1rem}\
h1{margin-bottom:0}h2{margin:2rem 0 .5rem;font-size:1.1rem}p{margin:.3rem 0}table{border-collapse:collapse;margin:1rem 0}\
td{padding:.15rem 1.5rem .15rem 0;border-bottom:1px solid #e2e6ea}td:first-child{color:#57606a}\
svg{max-width:100%;height:auto}.note{color:#57606a}";

/// Writes the page, whole or not at all.
///
/// # Errors
/// A plot that cannot be drawn, or a file that cannot be written, by name.
pub fn write_page(page: &Page<'_>, path: &Path) -> anyhow::Result<()> {
    let mut sections = vec![
        ("Probe path", "The surface, and the probe in front of it (blue) and pressing in (red).", plots::path(page)?),
        ("Gap", "Signed distance along the outward normal; below zero the probe presses in.", plots::gap(page.trace)?),
        ("Force", "Magnitude of the force at the probe.", plots::force(page.trace)?),
        (
            "Feature",
            "Which face, edge or corner has the witness point, in the order of their first touch.",
            plots::feature(page.trace)?,
        ),
        (
            "Boundary mode",
            "1 and 2: held at u = 0 and u = 1; 3 and 4: at v = 0 and v = 1; 5: interior; 6: corner.",
            plots::mode(page.trace)?,
        ),
    ];
    if let Some(drawing) = plots::instructions(page.trace)? {
        sections.push(("Instructions a tick", "Counted under the emulator.", drawing));
    }
    let link = page.replay.as_ref().map(|file| (file.as_ref(), "The same run in 3-D, replayed by the firmware's code"));
    write_linked([page.title, page.subtitle], link, page.figures, &sections, path)
}

/// A heading, a sentence and a drawing.
pub type Section<'a> = (&'a str, &'a str, String);

/// Writes a page with a headline and a sentence below it, whole or not at all.
///
/// # Errors
/// A file that cannot be written, by name.
pub fn write_sections(
    headline: [&str; 2],
    figures: &[(&str, String)],
    sections: &[Section<'_>],
    path: &Path,
) -> anyhow::Result<()> {
    write_linked(headline, None, figures, sections, path)
}

/// The same with a link below the headline: a file and its description.
fn write_linked(
    [title, subtitle]: [&str; 2],
    link: Option<(&str, &str)>,
    figures: &[(&str, String)],
    sections: &[Section<'_>],
    path: &Path,
) -> anyhow::Result<()> {
    let mut text = String::new();
    write!(
        text,
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>{0}</title><style>{STYLE}</style>\
         <h1>{0}</h1><p class=\"note\">{1}</p>",
        escape(title),
        escape(subtitle)
    )?;
    if let Some((file, words)) = link {
        write!(text, "<p><a href=\"{}\">{}</a></p>", escape(file), escape(words))?;
    }
    text.push_str("<table>");
    for (name, value) in figures {
        write!(text, "<tr><td>{}</td><td>{}</td></tr>", escape(name), escape(value))?;
    }
    text.push_str("</table>");
    for (heading, note, drawing) in sections {
        write!(text, "<h2>{heading}</h2><p class=\"note\">{note}</p>{drawing}")?;
    }
    text.push_str("</html>\n");
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let partial = path.with_extension("html.partial");
    std::fs::write(&partial, text).with_context(|| format!("cannot write {}", partial.display()))?;
    std::fs::rename(&partial, path).with_context(|| format!("cannot write {}", path.display()))
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
