//! The page for the browser: the firmware's code as wasm, three.js and the page's own modules in one HTML file.

mod bundle;
mod recording;

use crate::firmware::{Progress, SetUpError, Toolchain, apt_install, on_path, output};
use crate::repository;
use anyhow::Context as _;
pub use bundle::{Given, Holdable, Shown, bundle};
pub use recording::{Cut, Loop, RecordedBody, RecordedScene, Recording};
use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::time::Duration;

// The page on the loopback: one address, one answer, nothing of the disk behind it.

/// A browser that says nothing for so long has gone.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longer than any request line of a browser.
const LONGEST_REQUEST: u64 = 16 * 1024;

/// Answers every request with the page until the process is stopped; passes the address to `ready` first. Port 0 means
/// any free port.
///
/// # Errors
/// If the port is taken or not allowed.
pub fn serve(page: &str, port: u16, ready: impl FnOnce(&str)) -> anyhow::Result<()> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| format!("port {port}"))?;
    ready(&format!("http://{}/", listener.local_addr()?));
    for stream in listener.incoming() {
        // A browser that hangs up has had enough.
        let _ = stream.and_then(|stream| answer(stream, page));
    }
    Ok(())
}

fn answer(mut stream: TcpStream, page: &str) -> std::io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    let reader = BufReader::new(std::io::Read::take(stream.try_clone()?, LONGEST_REQUEST));
    // The head ends with an empty line; what it asks for makes no difference but for this.
    let head: Vec<String> = reader.lines().map_while(Result::ok).take_while(|line| !line.is_empty()).collect();
    let is_page = head.first().is_some_and(|line| line.starts_with("GET / "));
    let (status, body) = if is_page { ("200 OK", page) } else { ("404 Not Found", "") };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Connection: close\r\n\r\n{body}",
        body.len()
    )
}

// The firmware's code for the browser.

/// The compiler's name for a browser.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// Installs missing parts of the compiler, builds the module and returns its bytes.
///
/// # Errors
/// Missing tools or an error of the compiler.
pub fn compile(progress: &Progress) -> Result<Vec<u8>, SetUpError> {
    let (toolchain, target_folder, module) = places(progress)?;
    let mut cargo = toolchain.cargo();
    cargo.current_dir(repository::root()?.join("host-tests/page"));
    cargo.args(["build", "--profile", "abort", "--config", "profile.abort.strip=true", "--locked"]);
    cargo.args(["--target", TARGET, "--target-dir"]).arg(&target_folder);
    progress.during("building the firmware's code for the browser", || output(&mut cargo))?;
    fs::read(&module).map_err(SetUpError::io(module.display()))
}

/// Builds the module as [`compile`] does, or returns `None` if it was never built here.
///
/// # Errors
/// An error of the compiler.
pub fn compiled(progress: &Progress) -> Result<Option<Vec<u8>>, SetUpError> {
    if !Toolchain::is_at_hand(TARGET) || !places(progress)?.2.exists() {
        return Ok(None);
    }
    compile(progress).map(Some)
}

/// The compiler, where it builds, and what comes of it.
fn places(progress: &Progress) -> Result<(Toolchain, PathBuf, PathBuf), SetUpError> {
    let toolchain = Toolchain::set_up(TARGET, progress)?;
    let target_folder = toolchain.target_folder()?;
    let module = target_folder.join(TARGET).join("abort/palpate_page.wasm");
    Ok((toolchain, target_folder, module))
}

// The browser that the page is tested in.

/// Names of the Chromium executable.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// A Chromium.
#[derive(Clone, Debug)]
pub struct Browser {
    path: PathBuf,
}

impl Browser {
    /// The one that is there, with a compiler for the page; `None` where something would have to be installed.
    pub fn at_hand() -> Option<Self> {
        Self::found().filter(|_| Toolchain::is_at_hand(TARGET))
    }

    /// The one that is there, or Debian's, installed where that needs no password.
    ///
    /// # Errors
    /// That there is none.
    pub fn set_up(progress: &Progress) -> Result<Self, SetUpError> {
        if let Some(found) = Self::found() {
            return Ok(found);
        }
        apt_install(&["chromium"], progress).map_err(SetUpError::NoBrowser)?;
        Self::found().ok_or_else(|| SetUpError::NoBrowser("it is still missing after installing it".to_owned()))
    }

    fn found() -> Option<Self> {
        NAMES.iter().find_map(|name| on_path(name)).map(|path| Self { path })
    }

    /// The program.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
