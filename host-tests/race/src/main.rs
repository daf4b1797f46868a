//! Runs the contestants of the race on one scene. `cargo palpate race` writes the scene, runs this program once by the
//! clock and once under an instruction counter, and judges the answers.
//!
//! ```text
//! palpate-race SCENE cold|track time|count [NAME]…
//! ```
//!
//! Standard output is CSV: `contestant,row,kind,a,b,c,nanoseconds`. `kind` is `parameters` (a, b are u, v), `point` (a,
//! b, c in metres) or `none`; with `count` the last column is empty, and each query that is counted is one call of
//! [`measure::counted`].

mod contestant;
mod entries;
mod horner;
mod measure;
mod newton;
mod ours;
#[cfg(feature = "peers")]
mod parry;
mod scene;
#[cfg(feature = "peers")]
mod truck;

use anyhow::{Context as _, bail};
use contestant::Answer;
use scene::Scene;
use std::env;
use std::io::{self, BufWriter, Write as _};

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [file, task, how, only @ ..] = arguments.as_slice() else {
        bail!("usage: palpate-race SCENE cold|track time|count [NAME]…");
    };
    let scene = Scene::read(file).with_context(|| file.clone())?;
    let entries = match task.as_str() {
        "cold" => entries::cold(),
        "track" => entries::track(),
        other => bail!("{other}: neither cold nor track"),
    };
    let mut output = BufWriter::new(io::stdout().lock());
    writeln!(output, "contestant,row,kind,a,b,c,nanoseconds")?;
    for (name, enter) in entries {
        if !only.is_empty() && !only.iter().any(|wanted| wanted == name) {
            continue;
        }
        let run = match how.as_str() {
            "time" => measure::time(&scene, enter),
            "count" => measure::count(&scene, enter),
            other => bail!("{other}: neither time nor count"),
        }
        .context(name)?;
        for (row, (answer, nanoseconds)) in run.into_iter().enumerate() {
            let answer = match answer {
                Answer::Nothing => "none,,,".to_owned(),
                Answer::Parameters([u, v]) => format!("parameters,{u:e},{v:e},"),
                Answer::Point([x, y, z]) => format!("point,{x:e},{y:e},{z:e}"),
            };
            let nanoseconds = nanoseconds.map(|value| value.to_string()).unwrap_or_default();
            writeln!(output, "{name},{row},{answer},{nanoseconds}")?;
        }
    }
    output.flush()?;
    Ok(())
}
