//! The tool as one has it that was installed: without its sources, in an empty folder.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};

/// A copy of the tool, and a folder with nothing in it.
struct Installed {
    _folder: tempfile::TempDir,
    program: PathBuf,
    empty: PathBuf,
}

impl Installed {
    fn new() -> Result<Self, Box<dyn Error>> {
        let folder = tempfile::tempdir()?;
        let (program, empty) = (folder.path().join("bin/palpate"), folder.path().join("empty"));
        fs::create_dir_all(folder.path().join("bin"))?;
        fs::create_dir_all(&empty)?;
        fs::copy(env!("CARGO_BIN_EXE_palpate"), &program)?;
        Ok(Self { _folder: folder, program, empty })
    }

    /// Runs a command there, with nothing in its environment of the cargo that runs this test.
    fn run(&self, arguments: &[&str]) -> Result<(ExitStatus, String, String), Box<dyn Error>> {
        let mut command = Command::new(&self.program);
        palpate_tool::firmware::without_outer_cargo(&mut command);
        let output = command.current_dir(&self.empty).args(arguments).output()?;
        Ok((output.status, String::from_utf8(output.stdout)?, String::from_utf8(output.stderr)?))
    }

    fn works(&self, arguments: &[&str]) -> Result<String, Box<dyn Error>> {
        let (status, said, complaint) = self.run(arguments)?;
        assert!(status.success(), "{arguments:?}: {complaint}");
        Ok(said)
    }
}

#[test]
fn an_installed_tool_works_in_an_empty_folder() -> Result<(), Box<dyn Error>> {
    let tool = Installed::new()?;
    let report = tool.works(&["check", "capped_box"])?;
    assert!(report.contains("capped_box: certified (6 of 6 patches certified)"), "{report}");

    tool.works(&["bake", "capped_box", "--out", "capped_box.rs"])?;
    let committed = include_str!("../../../../boards/bodies/capped_box.rs");
    assert!(fs::read_to_string(tool.empty.join("capped_box.rs"))? == committed, "the committed tables");

    fs::write(tool.empty.join("probes.csv"), "qx,qy,qz\n30,20,100\n")?;
    let answer = tool.works(&["closest", "--model", "capped_box", "--queries", "probes.csv"])?;
    assert_eq!(answer.lines().count(), 2, "{answer}");

    let figures = tool.works(&["sim", "--seconds", "0.5"])?;
    assert!(figures.contains("touches"), "{figures}");
    tool.works(&["zwidth", "--device", "hapkit", "--rate", "1000"])?;
    assert!(tool.empty.join("palpate-report/zwidth.svg").is_file());
    tool.works(&["figures", "--model", "capped_box", "--out", "figures"])?;
    tool.works(&["figures", "--shapes", "--model", "table1", "--out", "figures"])?;
    for file in ["capped_box-figure3.svg", "capped_box-figure9.svg", "table1-shape.svg"] {
        assert!(tool.empty.join("figures").join(file).is_file(), "{file}");
    }
    Ok(())
}

#[test]
fn what_needs_the_repository_says_so_in_one_sentence() -> Result<(), Box<dyn Error>> {
    let tool = Installed::new()?;
    for command in [
        &["demo", "--seconds", "1"][..],
        &["test"],
        &["budgets"],
        &["image"],
        &["cycles"],
        &["firmware", "build"],
        &["race"],
    ] {
        let (status, said, complaint) = tool.run(command)?;
        assert_eq!(status.code(), Some(2), "{command:?}: {complaint}");
        assert!(complaint.contains("need palpate's repository") && complaint.lines().count() == 1, "{complaint}");
        assert!(said.is_empty(), "{command:?}: {said}");
    }
    assert!(fs::read_dir(&tool.empty)?.next().is_none(), "nothing is left behind");
    Ok(())
}

/// What would find the sources on the machine that built the tool, and only there.
#[test]
fn the_tool_does_not_know_where_it_was_built() -> Result<(), Box<dyn Error>> {
    fn files(folder: &Path, all: &mut Vec<PathBuf>) -> std::io::Result<()> {
        for entry in fs::read_dir(folder)?.flatten().map(|entry| entry.path()) {
            if entry.is_dir() { files(&entry, all)? } else { all.push(entry) }
        }
        Ok(())
    }
    let host = palpate_tool::repository::root()?.join("host-tests");
    let mut all = Vec::new();
    for package in ["bake", "sim", "tool", "truth"] {
        files(&host.join(package).join("src"), &mut all)?;
    }
    assert!(all.len() > 100, "{}", all.len());
    for file in all {
        let text = fs::read_to_string(&file)?;
        let program = text.split("#[cfg(test)]").next().unwrap_or_default();
        assert!(!program.contains("env!(\"CARGO_MANIFEST_DIR\")"), "{}", file.display());
    }
    Ok(())
}
