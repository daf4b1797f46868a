//! A report as one HTML file that needs nothing beside it: light or dark, on a wide page or a phone.

use crate::plot::WIDTHS;
use anyhow::Context;
use std::fmt::Write as _;
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

const STYLE: &str = ":root{color-scheme:light dark;--ink:#1b1f24;--quiet:#57606a;--line:#d8dee4;--paper:#fff;--shade:#8c959f}\
@media(prefers-color-scheme:dark){:root{--ink:#e6edf3;--quiet:#9198a1;--line:#30363d;--paper:#0d1117;--shade:#484f58}a{color:#58a6ff}}\
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:62rem;margin:2rem auto;padding:0 1rem}\
h1{margin:0}h2{margin:2.5rem 0 .5rem;font-size:1.2rem}p{margin:.3rem 0}.note{color:var(--quiet)}\
code{overflow-wrap:anywhere;font-size:.9em}table{border-collapse:collapse;margin:1rem 0}\
td,th{padding:.2rem 1rem .2rem 0;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}\
.figures td{overflow-wrap:anywhere}.figures td:first-child{color:var(--quiet);overflow-wrap:normal}\
.scroll{overflow-x:auto;font-size:.85rem;\
background:linear-gradient(to left,var(--paper) 1rem,transparent) right/3rem 100% no-repeat local,\
linear-gradient(to left,var(--shade),transparent) right/1.5rem 100% no-repeat scroll}.scroll td,.scroll th{white-space:nowrap;text-align:right;\
font-variant-numeric:tabular-nums}.scroll th{white-space:pre-line;vertical-align:bottom;font-weight:600}\
.scroll :is(td,th):first-child{text-align:left;position:sticky;left:0;background:var(--paper)}\
svg{display:block;max-width:100%;height:auto}.narrow{display:none}";

/// A heading, a sentence, a table and a drawing below it.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Its subject.
    pub heading: String,
    /// In a sentence.
    pub note: String,
    /// Numbers.
    pub table: Option<Table>,
    /// On a wide page and on a phone.
    pub drawing: Option<[String; 2]>,
}

/// Names of the columns, and rows of as many cells.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Names; a second line is a unit.
    pub head: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

/// Content of a report.
#[derive(Clone, Debug)]
pub struct Report<'a> {
    /// The headline, and a sentence below it.
    pub headline: [&'a str; 2],
    /// A file beside it, and its description.
    pub link: Option<[&'a str; 2]>,
    /// Name and value of each figure.
    pub figures: &'a [(&'a str, String)],
    /// Below them, in this order.
    pub sections: &'a [Section],
}

impl Report<'_> {
    /// Writes the report, whole or not at all.
    ///
    /// # Errors
    /// A file that cannot be written, by name.
    pub fn write(&self, path: &Path) -> anyhow::Result<()> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let partial = path.with_extension("html.partial");
        std::fs::write(&partial, self.html()?).with_context(|| format!("cannot write {}", partial.display()))?;
        std::fs::rename(&partial, path).with_context(|| format!("cannot write {}", path.display()))
    }

    fn html(&self) -> anyhow::Result<String> {
        let [title, subtitle] = self.headline.map(escape);
        // Narrower than a wide plot at four fifths of its size, its words are too small.
        let narrow = (0.8 * WIDTHS[0]) as u32;
        let mut text = format!(
            "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" \
             content=\"width=device-width,initial-scale=1\"><title>{title}</title><style>{STYLE}\
             @media(max-width:{narrow}px){{.wide{{display:none}}.narrow{{display:block}}}}</style>\n\
             <h1>{title}</h1><p class=\"note\">{subtitle}</p><p class=\"note\"><code>{}</code><br>palpate {}, {}</p>\n",
            escape(&command()),
            env!("CARGO_PKG_VERSION"),
            date(now())
        );
        if let Some([file, words]) = self.link.map(|link| link.map(escape)) {
            writeln!(text, "<p><a href=\"{file}\">{words}</a></p>")?;
        }
        text.push_str("<table class=\"figures\">");
        for (name, value) in self.figures {
            write!(text, "<tr><td>{}</td><td>{}</td></tr>", escape(name), escape(value))?;
        }
        text.push_str("</table>\n");
        for Section { heading, note, table, drawing } in self.sections {
            writeln!(text, "<h2>{}</h2><p class=\"note\">{}</p>", escape(heading), escape(note))?;
            if let Some(table) = table {
                let cells = |row: &[String], tag: &str| {
                    row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect::<String>()
                };
                write!(text, "<div class=\"scroll\" tabindex=\"0\"><table><tr>{}</tr>", cells(&table.head, "th"))?;
                table.rows.iter().try_for_each(|row| writeln!(text, "<tr>{}</tr>", cells(row, "td")))?;
                text.push_str("</table></div>\n");
            }
            if let Some([wide, narrow]) = drawing {
                write!(text, "<div class=\"wide\">{wide}</div><div class=\"narrow\">{narrow}</div>")?;
            }
        }
        text.push_str("</html>\n");
        Ok(text)
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The command line as one may type it again.
fn command() -> String {
    let quoted = |word: String| {
        let is_plain = |letter: char| letter.is_alphanumeric() || "-_./:,=+%@".contains(letter);
        if !word.is_empty() && word.chars().all(is_plain) { word } else { format!("'{}'", word.replace('\'', "'\\''")) }
    };
    let words = std::env::args_os().skip(1).map(|word| quoted(word.to_string_lossy().into_owned()));
    ["palpate".to_owned()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
}

/// Now, or the time that a reproducible build sets.
fn now() -> Duration {
    let set = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|seconds| seconds.parse().ok());
    set.map_or_else(|| SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default(), Duration::from_secs)
}

/// A day of the Gregorian calendar, and its time, UTC.
fn date(since_1970: Duration) -> String {
    let seconds = since_1970.as_secs();
    // Years from March on, in eras of 400: leap days come last.
    let days = seconds / 86_400 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (year, month) = (year + 400 * era + u64::from(month > 9), if month > 9 { month - 9 } else { month + 3 });
    let [hour, minute] = [seconds / 3_600 % 24, seconds / 60 % 60];
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02} UTC")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        // By `date -u -d @SECONDS`.
        for (seconds, expected) in [
            (0, "1970-01-01 00:00 UTC"),
            (951_827_696, "2000-02-29 12:34 UTC"),
            (1_735_689_599, "2024-12-31 23:59 UTC"),
            (1_795_799_640, "2026-11-27 17:14 UTC"),
            (4_107_542_400, "2100-03-01 00:00 UTC"),
        ] {
            assert_eq!(date(Duration::from_secs(seconds)), expected);
        }
    }
}
