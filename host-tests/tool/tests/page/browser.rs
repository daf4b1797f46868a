//! A browser with the page in it, which keeps whatever goes wrong on the console. Chromium reads commands of its DevTools
//! protocol from its file 3 and writes to its file 4, each message JSON that ends with a zero.

use crate::tool;
use anyhow::{Context as _, bail, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::cell::RefCell;
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The page in its browser, which ends when dropped.
pub struct Page {
    chromium: Child,
    line: RefCell<Line>,
    /// Chromium's name for the tab.
    session: String,
    _profile: TempDir,
}

/// The line to the browser, and what it has said.
struct Line {
    to: ChildStdin,
    from: Receiver<Vec<u8>>,
    asked: u64,
    loaded: u32,
    errors: Vec<String>,
}

impl Line {
    fn receive(&mut self) -> anyhow::Result<Value> {
        let text = self.from.recv_timeout(PATIENCE).context("Chromium says nothing")?;
        let message: Value = serde_json::from_slice(&text)?;
        let said = &message["params"];
        match message["method"].as_str() {
            Some("Page.loadEventFired") => self.loaded += 1,
            Some("Runtime.exceptionThrown") => self.errors.push(said["exceptionDetails"].to_string()),
            Some("Log.entryAdded") if said["entry"]["level"] == "error" => self.errors.push(said["entry"].to_string()),
            Some("Runtime.consoleAPICalled") if said["type"] == "error" => self.errors.push(said["args"].to_string()),
            _ => {}
        }
        Ok(message)
    }

    /// The browser's answer to a command, or with a session's name the tab's.
    fn call(&mut self, session: Option<&str>, method: &str, params: &Value) -> anyhow::Result<Value> {
        self.asked += 1;
        let mut message = json!({ "id": self.asked, "method": method, "params": params });
        if let Some(session) = session {
            message["sessionId"] = session.into();
        }
        write!(self.to, "{message}\0")?;
        loop {
            let mut message = self.receive()?;
            if message["id"] == self.asked {
                ensure!(message["error"].is_null(), "{method}: {}", message["error"]);
                return Ok(message["result"].take());
            }
        }
    }
}

/// Width and height of a picture, pixels.
const PICTURE: [u32; 2] = [1400, 860];

/// Nothing of these tests takes so long, on any machine.
const PATIENCE: Duration = Duration::from_secs(300);

impl Page {
    /// Opens the page from its file and waits until it runs.
    pub fn open() -> anyhow::Result<Self> {
        // Before the browser starts, whose patience ends: the first time this builds the code.
        Self::open_at(&tool::address())
    }

    /// The same of a page that lies elsewhere.
    pub fn open_at(address: &str) -> anyhow::Result<Self> {
        let page = Self::empty()?;
        // A quarter of the pixels along each side: a processor draws them, and only a picture is looked at.
        page.set_size(PICTURE, 0.25)?;
        page.run(address)?;
        Ok(page)
    }

    /// Goes to the page at an address and waits until it runs.
    pub fn run(&self, address: &str) -> anyhow::Result<()> {
        // Only pictures show what is drawn, and drawing takes nearly all the time where a processor does it.
        self.go(&format!("{address}#undrawn"))?;
        // Until the page is there an expression finds nothing.
        let began = Instant::now();
        while self.ask("window.palpate?.ready").ok() != Some(Value::Bool(true)) {
            ensure!(began.elapsed() < PATIENCE, "the page does not run: {:?}", self.errors());
            thread::sleep(Duration::from_millis(200));
        }
        Ok(())
    }

    /// Goes to an address and waits until its page is loaded.
    pub fn go(&self, address: &str) -> anyhow::Result<()> {
        let before = self.line.borrow().loaded;
        self.call("Page.navigate", &json!({ "url": address }))?;
        let mut line = self.line.borrow_mut();
        while line.loaded == before {
            line.receive()?;
        }
        Ok(())
    }

    /// A browser with nothing in it.
    pub fn empty() -> anyhow::Result<Self> {
        let profile = tempfile::tempdir()?;
        let mut command = Command::new("sh");
        command
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 </dev/null >/dev/null"])
            .arg(tool::given("PALPATE_CHROMIUM")?);
        command.arg(format!("--user-data-dir={}", profile.path().display())).args([
            "--headless",
            "--remote-debugging-pipe",
            // As root, which a container's user is, Chromium has no sandbox.
            "--no-sandbox",
            "--disable-dev-shm-usage",
            "--window-size=1400,860",
            // WebGL without a graphics card, for nothing but the scene, and no word with a network that is not needed.
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--disable-gpu-compositing",
            "--hide-scrollbars",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut chromium = command.spawn().context("Chromium does not start")?;
        let (to, said) = (chromium.stdin.take().context("no input")?, chromium.stdout.take().context("no output")?);
        let (sender, from) = channel();
        thread::spawn(move || {
            for message in BufReader::new(said).split(0).map_while(Result::ok) {
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        let mut line = Line { to, from, asked: 0, loaded: 0, errors: Vec::new() };
        let tab = line.call(None, "Target.createTarget", &json!({ "url": "about:blank" }))?;
        let to = json!({ "targetId": tab["targetId"], "flatten": true });
        let attached = line.call(None, "Target.attachToTarget", &to)?;
        let session = attached["sessionId"].as_str().context("no session")?.to_owned();
        let page = Self { chromium, line: RefCell::new(line), session, _profile: profile };
        for domain in ["Page", "Log", "Runtime"] {
            page.call(&format!("{domain}.enable"), &json!({}))?;
        }
        Ok(page)
    }

    /// The tab's answer to a command.
    pub fn call(&self, method: &str, params: &Value) -> anyhow::Result<Value> {
        self.line.borrow_mut().call(Some(&self.session), method, params)
    }

    /// The same held still: nothing moves but what a test moves.
    pub fn held_still() -> anyhow::Result<Self> {
        let page = Self::open()?;
        page.ask("palpate.pause()")?;
        Ok(page)
    }

    /// Gives the page this share of the processor, as 1 / `times`, as on a busy machine.
    pub fn slow_down(&self, times: f64) -> anyhow::Result<()> {
        self.call("Emulation.setCPUThrottlingRate", &json!({ "rate": times }))?;
        Ok(())
    }

    /// Waits until an expression is true: frames are slow where a processor draws them.
    pub fn comes_to(&self, expression: &str) -> anyhow::Result<()> {
        let began = Instant::now();
        while self.ask(expression)? != true {
            ensure!(began.elapsed() < PATIENCE, "{expression}: {}", self.ask("palpate.state()")?);
            thread::sleep(Duration::from_millis(50));
        }
        Ok(())
    }

    /// What an expression comes to in the page, promises kept.
    pub fn ask(&self, expression: &str) -> anyhow::Result<Value> {
        let wrapped = format!("(async () => JSON.stringify((await ({expression})) ?? null))()");
        let answer = self.call("Runtime.evaluate", &json!({ "expression": wrapped, "awaitPromise": true }))?;
        match &answer["result"]["value"] {
            Value::String(text) => Ok(serde_json::from_str(text)?),
            _ => bail!("{expression}: {answer}"),
        }
    }

    /// A number that an expression comes to.
    pub fn number(&self, expression: &str) -> anyhow::Result<f64> {
        self.ask(expression)?.as_f64().with_context(|| format!("{expression} is no number"))
    }

    /// A picture of an element of the page in a window of this size, a small file (WebP). Frames are drawn from then on.
    pub fn picture(&self, size: [u32; 2], of: &str) -> anyhow::Result<Vec<u8>> {
        self.ask("palpate.draw(true)")?;
        self.set_size(size, 1.5)?;
        // Only the window itself tells a page that its pixels are others, and that later.
        self.ask("void dispatchEvent(new Event('resize'))")?;
        self.ask("palpate.drawn(3)")?;
        let clip = self.ask(&format!(
            "(({{ x, y, width, height }}) => ({{ x, y, width, height, scale: 1 }}))\
             (document.querySelector('{of}').getBoundingClientRect())"
        ))?;
        let picture = self.photographed(&json!({ "format": "webp", "quality": 85, "clip": clip }))?;
        self.set_size(PICTURE, 0.25)?;
        Ok(picture)
    }

    /// What the window shows, as a small file (WebP).
    pub fn photograph(&self) -> anyhow::Result<Vec<u8>> {
        self.photographed(&json!({ "format": "webp", "quality": 85 }))
    }

    fn photographed(&self, how: &Value) -> anyhow::Result<Vec<u8>> {
        let taken = self.call("Page.captureScreenshot", how)?;
        Ok(STANDARD.decode(taken["data"].as_str().context("no picture")?)?)
    }

    /// Sets width and height of the window, and the pixels along one of its lengths.
    pub fn set_size(&self, [width, height]: [u32; 2], device_scale_factor: f64) -> anyhow::Result<()> {
        let scale = device_scale_factor;
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": scale, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", &size)?;
        Ok(())
    }

    /// Has the reader prefer light or dark pages.
    pub fn prefer(&self, scheme: &str) -> anyhow::Result<()> {
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", &json!({ "features": features }))?;
        Ok(())
    }

    /// Puts the mouse to a place in the window, pixels.
    pub fn move_mouse(&self, [x, y]: [f64; 2]) -> anyhow::Result<()> {
        self.call("Input.dispatchMouseEvent", &json!({ "type": "mouseMoved", "x": x, "y": y }))?;
        Ok(())
    }

    /// Presses a key of a name, and lets go of it.
    pub fn press_key(&self, key: &str) -> anyhow::Result<()> {
        for what in ["rawKeyDown", "keyUp"] {
            self.call("Input.dispatchKeyEvent", &json!({ "type": what, "key": key }))?;
        }
        Ok(())
    }

    /// Whatever went wrong on the console so far.
    pub fn errors(&self) -> Vec<String> {
        self.line.borrow().errors.clone()
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // One that has crashed takes no command.
        let _ = self.line.borrow_mut().call(None, "Browser.close", &json!({}));
        let _ = self.chromium.wait();
    }
}
