//! A browser with the page in it, which keeps whatever goes wrong on the console.

use crate::tool;
use anyhow::{Context as _, bail, ensure};
use headless_chrome::protocol::cdp::Page::CaptureScreenshotFormatOption;
use headless_chrome::protocol::cdp::types::Event;
use headless_chrome::protocol::cdp::{Emulation, Log, Runtime};
use headless_chrome::{Browser, LaunchOptions, Tab};
use serde_json::Value;
use std::ffi::OsStr;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// The page in its browser, which ends when dropped.
pub struct Page {
    _browser: Browser,
    /// The tab, for its mouse and keys.
    pub tab: Arc<Tab>,
    errors: Arc<Mutex<Vec<String>>>,
}

/// Width and height of a picture, pixels.
const PICTURE: [u32; 2] = [1400, 860];

/// Nothing of these tests takes so long, on any machine.
const PATIENCE: Duration = Duration::from_secs(300);

impl Page {
    /// Opens the page from its file and waits until it runs.
    pub fn open() -> anyhow::Result<Self> {
        // Before the browser starts, which does not wait for ever: the first time this builds the code.
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

    /// Goes to a page and waits until it runs.
    pub fn run(&self, address: &str) -> anyhow::Result<()> {
        self.tab.navigate_to(address)?;
        // Until the page is there an expression finds nothing, or another page's world.
        let began = Instant::now();
        while self.ask("window.palpate?.ready").ok() != Some(Value::Bool(true)) {
            ensure!(began.elapsed() < PATIENCE, "the page does not run: {:?}", self.errors());
            thread::sleep(Duration::from_millis(200));
        }
        // Only pictures show what is drawn, and drawing takes nearly all the time where a processor does it.
        self.ask("palpate.draw(false)")?;
        Ok(())
    }

    /// A browser with nothing in it.
    pub fn empty() -> anyhow::Result<Self> {
        let options = LaunchOptions {
            path: Some(tool::given("PALPATE_CHROMIUM")?),
            // As root, which a container's user is, Chromium has no sandbox.
            sandbox: false,
            window_size: Some((1400, 860)),
            idle_browser_timeout: PATIENCE,
            args: [
                // WebGL without a graphics card, and no word with a network that is not needed.
                "--use-gl=angle",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
                "--hide-scrollbars",
                "--disable-quic",
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
            ]
            .map(OsStr::new)
            .to_vec(),
            ..LaunchOptions::default()
        };
        let browser = Browser::new(options).context("Chromium does not start")?;
        let tab = browser.new_tab()?;
        tab.set_default_timeout(PATIENCE);
        let errors = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&errors);
        tab.enable_log()?;
        tab.enable_runtime()?;
        tab.add_event_listener(Arc::new(move |event: &Event| {
            if let Some(error) = error_of(event)
                && let Ok(mut errors) = kept.lock()
            {
                errors.push(error);
            }
        }))?;
        Ok(Self { _browser: browser, tab, errors })
    }

    /// The same held still: nothing moves but what a test moves.
    pub fn held_still() -> anyhow::Result<Self> {
        let page = Self::open()?;
        page.ask("palpate.pause()")?;
        Ok(page)
    }

    /// Lets the page have one in so many moments of the processor, as on a machine that has much else to do.
    pub fn slow_down(&self, times: f64) -> anyhow::Result<()> {
        self.tab.call_method(Emulation::SetCPUThrottlingRate { rate: times })?;
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
        let answer = self.tab.evaluate(&wrapped, true)?;
        match answer.value {
            Some(Value::String(text)) => Ok(serde_json::from_str(&text)?),
            other => bail!("{expression}: {other:?} {:?}", answer.description),
        }
    }

    /// A number that an expression comes to.
    pub fn number(&self, expression: &str) -> anyhow::Result<f64> {
        self.ask(expression)?.as_f64().with_context(|| format!("{expression} is no number"))
    }

    /// A picture of the page, a small file (WebP) of a size that no browser's own bars take part of. Frames are drawn
    /// from then on.
    pub fn picture(&self) -> anyhow::Result<Vec<u8>> {
        self.sharpen(PICTURE)?;
        let picture = self.photograph()?;
        self.set_size(PICTURE, 0.25)?;
        Ok(picture)
    }

    /// Draws at every pixel of a window of this size.
    pub fn sharpen(&self, size: [u32; 2]) -> anyhow::Result<()> {
        self.set_size(size, 1.0)?;
        self.ask("palpate.draw(true)")?;
        // Only the window itself tells a page that its pixels are others, and that later.
        self.ask("void dispatchEvent(new Event('resize'))")?;
        self.ask("palpate.drawn(3)")?;
        Ok(())
    }

    /// What the window shows, as a small file (WebP).
    pub fn photograph(&self) -> anyhow::Result<Vec<u8>> {
        self.tab.capture_screenshot(CaptureScreenshotFormatOption::Webp, Some(85), None, true)
    }

    /// Sets width and height of the window, and the pixels along one of its lengths.
    pub fn set_size(&self, [width, height]: [u32; 2], device_scale_factor: f64) -> anyhow::Result<()> {
        self.tab.call_method(Emulation::SetDeviceMetricsOverride {
            width,
            height,
            device_scale_factor,
            mobile: false,
            scale: None,
            screen_width: None,
            screen_height: None,
            position_x: None,
            position_y: None,
            dont_set_visible_size: None,
            screen_orientation: None,
            viewport: None,
            display_feature: None,
            device_posture: None,
        })?;
        Ok(())
    }

    /// Has the reader prefer light or dark pages.
    pub fn prefer(&self, scheme: &str) -> anyhow::Result<()> {
        let features = vec![Emulation::MediaFeature { name: "prefers-color-scheme".into(), value: scheme.into() }];
        self.tab.call_method(Emulation::SetEmulatedMedia { media: None, features: Some(features) })?;
        Ok(())
    }

    /// Whatever went wrong on the console so far.
    pub fn errors(&self) -> Vec<String> {
        self.errors.lock().map(|errors| errors.clone()).unwrap_or_default()
    }
}

fn error_of(event: &Event) -> Option<String> {
    match event {
        Event::LogEntryAdded(event) => {
            let entry = &event.params.entry;
            (entry.level == Log::LogEntryLevel::Error).then(|| entry.text.clone())
        }
        Event::RuntimeExceptionThrown(event) => Some(format!("{:?}", event.params.exception_details)),
        Event::RuntimeConsoleAPICalled(event) => {
            let is_error = event.params.Type == Runtime::ConsoleAPICalledEventTypeOption::Error;
            is_error.then(|| format!("{:?}", event.params.args))
        }
        _ => None,
    }
}
