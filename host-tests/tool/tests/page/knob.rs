//! The knob's panel: the feel of the simulated dial beside closed forms, and the same feel on the line of a device.

use crate::browser::Page;
use anyhow::{Context as _, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use palpate::render::{FeelPart, Wave};
use palpate::scene::Command;
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{Answer, DeviceMessage, Dial, Hello, HostMessage, KeepError, Refused};
use std::f64::consts::TAU;
use std::thread;
use std::time::{Duration, Instant};

/// Moves sliders, as a hand does.
fn slide(page: &Page, sliders: &[(&str, f64)]) -> anyhow::Result<()> {
    for (slider, to) in sliders {
        page.ask(&format!(
            "(() => {{ const slider = document.getElementById('knob-{slider}'); slider.value = {to}; \
             slider.dispatchEvent(new Event('input')); }})()"
        ))?;
    }
    Ok(())
}

fn open() -> anyhow::Result<Page> {
    let page = Page::held_still()?;
    page.ask("palpate.panel('knob')")?;
    Ok(page)
}

#[test]
fn sliders_set_the_dial_without_a_step_and_within_its_limits() -> anyhow::Result<()> {
    let page = open()?;
    // The click's slider ends where the parts that the panel starts with bear it.
    slide(&page, &[("click", 1e3)])?;
    let is_taken = page.ask("document.getElementById('knob-refusal').hidden")? == true;
    ensure!(is_taken, "{}", page.ask("document.getElementById('knob-refusal').textContent")?);
    slide(&page, &[("click", 0.0), ("stops", 180.0), ("damping", 1.0), ("strength", 20.0), ("pitch", 12.0)])?;
    let pitch = 12_f64.to_radians();
    for degrees in [0.0, 2.0, 3.0, 4.5, -3.0, 14.0] {
        let at = f64::to_radians(degrees);
        let view = page.ask(&format!("palpate.turnKnob({at}, 4000)"))?;
        let number = |name: &str| view[name].as_f64().with_context(|| format!("{name}: {view}"));
        let (angle, torque) = (number("angle")?, number("torque")?);
        let expected = -0.02 * (TAU * angle / pitch).sin();
        // A count is 3.8e-4 rad of a slope of 0.02 · 2π / 0.21.
        ensure!((torque - expected).abs() < 2.4e-4, "at {degrees}°: {torque} N·m, expected {expected}");
        ensure!(number("phase")? == 3.0 && number("fault")? == 0.0, "{view}");
    }
    // Parts change in the middle of a turn, which changes a torque by 0.2 mN·m in a tick by itself; friction, which goes
    // with the noise of a rate, by more, so that it is gone before the next.
    let changes = [
        ("strength", 45.0),
        ("pitch", 20.0),
        ("strength", 20.0),
        ("spring", 100.0),
        ("rub", 5.0),
        ("rub", 0.0),
        ("click", 15.0),
        ("strength", 5.0),
    ];
    for (turn, change) in changes.into_iter().enumerate() {
        slide(&page, &[change])?;
        let is_taken = page.ask("document.getElementById('knob-refusal').hidden")? == true;
        ensure!(is_taken, "{change:?}: {}", page.ask("document.getElementById('knob-refusal').textContent")?);
        let at = 0.3 + 0.02 * turn as f64;
        let step = page.ask(&format!("palpate.turnKnob({at}, 80)"))?["step"].as_f64().context("no step")?;
        println!("{change:?}: at most {:.3} mN·m a tick", step * 1e3);
        ensure!((1e-5..1e-3).contains(&step), "{change:?}: {step} N·m in a tick");
    }
    // Refused: beside the slider, which goes back to what is in force.
    slide(&page, &[("damping", 2.0), ("spring", 0.0), ("click", 0.0), ("strength", 50.0)])?;
    for (slider, to, back, words) in [
        ("texture", 15.0, "0", "texture: with it the feel is as stiff as "),
        ("damping", 0.0, "2", "damping: with it a dial that is let go of would ring: "),
        ("hardness", 1200.0, "400", "hardness: with it the feel is as stiff as "),
    ] {
        slide(&page, &[("stops", 60.0), (slider, to)])?;
        let state = page.ask(&format!(
            "(({{ textContent, hidden, previousElementSibling }}, slider) => [textContent, hidden, slider.value, \
             previousElementSibling === slider.closest('label'), slider.nextElementSibling.textContent.split(' ')[0]])\
             (document.getElementById('knob-refusal'), document.getElementById('knob-{slider}'))"
        ))?;
        ensure!(state[0].as_str().is_some_and(|text| text.starts_with(words)), "{state}");
        ensure!(state[1] == false && state[2] == back && state[3] == true && state[4] == back, "{state}");
    }
    // From clicks to smooth detents and back, each with the torque of the other in its way.
    for shape in ["'clicks'", "'smooth'", "'clicks'"] {
        slide(&page, &[("strength", 45.0)])?;
        page.ask(&format!(
            "(() => {{ const shape = document.getElementById('knob-shape'); shape.value = {shape}; \
             shape.dispatchEvent(new Event('input')); }})()"
        ))?;
        ensure!(page.ask("document.getElementById('knob-refusal').hidden")? == true, "{shape}");
    }
    slide(&page, &[("texture", 0.0)])?;
    ensure!(page.ask("document.getElementById('knob-refusal').hidden")? == true, "still refused");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// A port that a test speaks through.
const PORT: &str = "(() => {
    let feed;
    const readable = new ReadableStream({ start(line) { feed = (bytes) => line.enqueue(bytes); } });
    const sent = [];
    const writable = new WritableStream({ write(bytes) { sent.push(...bytes); } });
    window.line = {
        hear: (text) => feed(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))),
        take: () => btoa(String.fromCharCode(...sent.splice(0))),
    };
    const port = { readable, writable, open: async () => {}, close: async () => {} };
    Object.defineProperty(navigator, 'serial', { value: { requestPort: async () => port }, configurable: true });
    return true;
})()";

struct Line<'a> {
    page: &'a Page,
    receiver: Receiver<HostMessage>,
}

impl Line<'_> {
    fn say(&self, message: &DeviceMessage) -> anyhow::Result<()> {
        let mut buffer = [0; MAX_FRAME];
        // A delimiter first: what came before it may be the rest of a frame.
        let bytes = [&[0], pack(message, &mut buffer)?].concat();
        self.page.ask(&format!("window.line.hear('{}')", STANDARD.encode(bytes)))?;
        Ok(())
    }

    /// The next message that is no sign of life.
    fn hear(&mut self) -> anyhow::Result<HostMessage> {
        let began = Instant::now();
        loop {
            let text = self.page.ask("window.line.take()")?;
            for byte in STANDARD.decode(text.as_str().context("no bytes")?)? {
                match self.receiver.feed(byte) {
                    Some(Received::Message(HostMessage::Alive)) | None => {}
                    Some(Received::Message(message)) => return Ok(message),
                    Some(damaged) => anyhow::bail!("{damaged:?}"),
                }
            }
            ensure!(began.elapsed() < Duration::from_secs(60), "nothing is sent");
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// The next command, with its number; repetitions of an older one are passed over.
    fn command(&mut self, after: u16) -> anyhow::Result<(u16, FeelPart)> {
        loop {
            match self.hear()? {
                HostMessage::Command { number, command: Command::Feel(part) } if number > after => {
                    return Ok((number, part));
                }
                HostMessage::Command { number, .. } if number <= after => {}
                HostMessage::Hello { .. } => {}
                other => anyhow::bail!("{other:?}"),
            }
        }
    }
}

#[test]
fn a_device_on_the_line_gets_the_feel_that_its_reader_sends() -> anyhow::Result<()> {
    let page = open()?;
    page.ask(PORT)?;
    page.ask("document.getElementById('knob-serial').click()")?;
    page.comes_to("document.getElementById('knob-serial').textContent === 'Disconnect'")?;
    let mut line = Line { page: &page, receiver: Receiver::new() };
    // Nothing is sent before the reader wants it.
    slide(&page, &[("strength", 20.0)])?;
    ensure!(page.ask("window.line.take()")? == "", "sent without being asked to");
    page.ask("document.getElementById('knob-live').click()")?;
    slide(&page, &[("texture", 4.0)])?;
    let hello = line.hear()?;
    ensure!(matches!(hello, HostMessage::Hello { .. }), "{hello:?}");
    line.say(&DeviceMessage::Hello(Hello::default()))?;
    let (number, part) = line.command(0)?;
    let expected = Wave { pitch_rad: 5_f32.to_radians(), torque_n_m: 0.004, centre_rad: 0.0 };
    let FeelPart::Texture(Some(Wave { pitch_rad, torque_n_m, centre_rad })) = part else { anyhow::bail!("{part:?}") };
    let off = (pitch_rad - expected.pitch_rad).abs() + (torque_n_m - expected.torque_n_m).abs() + centre_rad.abs();
    ensure!(off < 1e-7, "{part:?}");
    line.say(&DeviceMessage::Answer(Answer { number, refused: None }))?;
    page.comes_to("document.getElementById('knob-said').textContent === 'the device has it'")?;
    slide(&page, &[("damping", 2.0)])?;
    let (number, part) = line.command(number)?;
    ensure!(matches!(part, FeelPart::Damping(damping) if (damping - 2e-3).abs() < 1e-9), "{part:?}");
    line.say(&DeviceMessage::Answer(Answer { number, refused: Some(Refused::Feel(KeepError::NoFeel)) }))?;
    page.comes_to(
        "document.getElementById('knob-said').textContent.startsWith('the device refuses damping: no feel')",
    )?;
    line.say(&DeviceMessage::Dial(Dial { turns: 2, angle: 0.5, detent: 7, ..Dial::default() }))?;
    page.ask("palpate.pause(false)")?;
    page.comes_to("document.getElementById('knob-detent').textContent === '7'")?;
    page.comes_to("document.getElementById('knob-angle').textContent === '28.6°'")?;
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}
