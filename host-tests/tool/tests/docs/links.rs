//! No link, picture, file or module that a page names leads nowhere.

use crate::pages::{all, repository, sources, text};
use std::path::Path;

/// The targets of a page's links and pictures.
fn targets(page: &str) -> Vec<String> {
    let mut fenced = false;
    let mut found = Vec::new();
    for line in page.lines() {
        fenced ^= line.starts_with("```");
        if !fenced {
            found.extend(line.split("](").skip(1).filter_map(|rest| rest.split(')').next()).map(str::to_owned));
        }
    }
    found
}

/// The anchor of a heading, as it is made of it on the web.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_'));
    kept.map(|letter| if letter == ' ' { '-' } else { letter.to_ascii_lowercase() }).collect()
}

#[test]
fn every_link_and_picture_is_there() {
    let mut count = 0;
    for page in all() {
        let folder = Path::new(&page).parent().expect("a file lies in a folder").to_path_buf();
        for target in targets(&text(&page)) {
            count += 1;
            if target.starts_with("https://") {
                continue;
            }
            let (file, fragment) =
                target.split_once('#').map_or((target.as_str(), None), |(file, at)| (file, Some(at)));
            let path = if file.is_empty() { page.clone() } else { folder.join(file).to_string_lossy().into_owned() };
            assert!(repository().join(&path).exists(), "{page}: {target} leads nowhere");
            if let Some(fragment) = fragment {
                let headings =
                    text(&path).lines().filter(|line| line.starts_with('#')).map(anchor_of).collect::<Vec<_>>();
                assert!(headings.iter().any(|heading| heading == fragment), "{page}: {target}: no such heading");
            }
        }
    }
    assert!(count > 50, "only {count} links: are they still found?");
}

fn anchor_of(line: &str) -> String {
    anchor(line.trim_start_matches('#'))
}

#[test]
fn the_published_crate_links_to_nothing_that_it_does_not_hold() {
    for page in ["docs/crate.md", "docs/reference/wire.md", "src/theory.md"] {
        for target in targets(&text(page)) {
            let leads_out = target.starts_with("https://") || target.starts_with("crate::") || target.starts_with('#');
            assert!(leads_out, "{page} is published, and {target} is not where it would be looked for");
        }
        assert!(!text(page).contains("!["), "{page} is published, and its pictures are not");
    }
}

#[test]
fn every_source_file_that_a_page_names_is_there() {
    let known: Vec<String> =
        ["src", "host-tests", "boards", "examples"].iter().flat_map(|folder| sources(folder)).collect();
    let mut count = 0;
    for page in all().into_iter().filter(|page| !page.starts_with("boards/")) {
        for name in text(&page).split('`').skip(1).step_by(2).filter(|name| name.ends_with(".rs") && name.contains('/'))
        {
            count += 1;
            let is_there = known.iter().any(|path| path == name || path.ends_with(&format!("/{name}")));
            assert!(is_there, "{page} names {name}, which is not there");
        }
        for folder in text(&page)
            .split('`')
            .skip(1)
            .step_by(2)
            .filter(|name| name.ends_with('/') || name.starts_with("host-tests/"))
        {
            let plain = !folder.contains([' ', '*', '<']);
            let is_there = repository().join(folder).exists() || folder.starts_with("target/");
            assert!(!plain || is_there, "{page} names {folder}, which is not there");
        }
    }
    for drawn in text("docs/figures/tick.svg").split("monospace\">").skip(1) {
        let name = drawn.split('<').next().unwrap_or_default().trim_end_matches('…').trim();
        count += 1;
        let is_there = name.contains("::")
            || name.contains("()")
            || name.contains("Kinematics")
            || known.iter().any(|path| path == &format!("src/{name}"))
            || repository().join("src").join(name).is_dir();
        assert!(is_there, "docs/figures/tick.svg names {name}, which is not there");
    }
    assert!(count > 20, "only {count} files named: are they still found?");
}
