//! A person at the device, who reads prompts.

use super::{Hands, keyboard};
use anyhow::{Context, bail};
use std::io::{IsTerminal as _, Write as _, stdin, stdout};

/// Somebody at a terminal.
pub struct Person {
    /// The joints' names.
    names: Vec<String>,
    /// N/kg.
    gravity: f64,
}

impl Person {
    /// Who reads and answers here.
    ///
    /// # Errors
    /// Where standard input is no terminal: nobody reads.
    pub fn new(names: Vec<String>) -> anyhow::Result<Self> {
        if !stdin().is_terminal() {
            bail!("setting up a device takes a person at a terminal; standard input is none");
        }
        Ok(Self { names, gravity: 9.81 })
    }

    /// Says something, and waits for a line.
    fn ask(&self, what: &str) -> anyhow::Result<String> {
        print!("\n{what}\n> ");
        stdout().flush()?;
        keyboard::line().context("cannot read the terminal")?.context("nobody answers any more")
    }
}

impl Hands for Person {
    fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        let places = self.names.iter().zip(angles);
        let places: Vec<_> = places.map(|(name, angle)| format!("{name} at {:.2}°", angle.to_degrees())).collect();
        self.ask(&format!("Put joint {}, and hold them there. Enter when they are.", places.join(", "))).map(drop)
    }

    fn pose(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        let places = self.names.iter().zip(angles);
        let places: Vec<_> = places.map(|(name, angle)| format!("{name} at {:.2}°", angle.to_degrees())).collect();
        self.ask(&format!(
            "Hold the arm in the very pose in which you will hold it whenever its board is homed (as the file has it, \
             joint {}): what is measured is where that is. Enter when it is.",
            places.join(", ")
        ))
        .map(drop)
    }

    fn pass(&mut self, joint: usize, angles: [f64; 3]) -> anyhow::Result<()> {
        let (name, angle) = (&self.names[joint], angles[joint].to_degrees());
        self.ask(&format!(
            "Move joint {name} alone, slowly, to about {angle:.0}°, past its index mark. Enter when it is."
        ))
        .map(drop)
    }

    fn rest(&mut self, joint: usize, towards: f64) -> anyhow::Result<()> {
        let (name, way) = (&self.names[joint], if towards > 0.0 { "rising" } else { "falling" });
        let what = format!(
            "Let joint {name} rest against a support, so that it can move only towards {way} angles, and hold the \
             others. Fingers out. Enter, press the enable button, and hold the space bar: its motor pulls by and by."
        );
        self.ask(&what).map(drop)
    }

    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<f64> {
        let size = force.iter().map(|part| part * part).sum::<f64>().sqrt();
        if size == 0.0 {
            return self.ask("Take the weight off. Enter.").map(|_| 0.0);
        }
        let [x, y, z] = force.map(|part| part / size);
        let wanted = size / self.gravity;
        let answer = self.ask(&format!(
            "Let about {wanted:.3} kg pull at the probe along ({x:.2}, {y:.2}, {z:.2}) of the device's frame, by a \
             thread over a pulley where that is not down. How many kg are they?"
        ))?;
        let kilograms: f64 = answer.parse().with_context(|| format!("{answer:?} is no number of kg"))?;
        if !(kilograms > 0.0 && kilograms <= 1.5 * wanted) {
            bail!("{kilograms} kg: more than {:.3} kg are more than the motor may lift here", 1.5 * wanted);
        }
        Ok(kilograms * self.gravity)
    }

    fn enable(&mut self, pressed: bool) -> anyhow::Result<()> {
        let what = if pressed {
            "From here on a motor moves while BOTH the device's enable button and the space bar are held. Enter, then \
             press the enable button."
        } else {
            "Let the enable button go: no motor is needed now. Enter."
        };
        self.ask(what).map(drop)
    }
}
