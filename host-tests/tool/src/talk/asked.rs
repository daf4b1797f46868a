//! A line of the console, understood: millimetres and degrees to metres and radians.

use palpate::render::{Detents, DialFriction, Ends, FeelPart, Notch, Spring, Wave};
use std::f32::consts::TAU;
use std::path::PathBuf;
use std::str::{FromStr, SplitWhitespace};
use thiserror::Error;

/// A command of the user.
#[derive(Clone, Debug, PartialEq)]
pub enum Asked {
    /// An empty line.
    Nothing,
    /// The list of commands.
    Help,
    /// The end.
    Quit,
    /// The device's identity.
    Who,
    /// The loop as it is now.
    Where,
    /// The same repeatedly, for a number of seconds.
    Watch(f32),
    /// Waits this number of seconds before the next line, where lines come from a file.
    Wait(f32),
    /// A force, N, for a number of seconds.
    Push([f32; 3], f32),
    /// A body's origin, metres, and its orientation, if that is to be another.
    Place(u8, [f32; 3], Option<[f32; 4]>),
    /// A body's orientation.
    Turn(u8, [f32; 4]),
    /// Velocity (m/s) and angular velocity (rad/s) of a body, for a number of seconds.
    Move(u8, [[f32; 3]; 2], f32),
    /// Groups, as bits.
    Switch(u32),
    /// One group, or feel.
    Choose(u8),
    /// Stiffness, N/m, and damping, N·s/m, of a body.
    Harden(u8, f32, f32),
    /// Friction of a body, by its four numbers.
    Rub(u8, Option<[f32; 4]>),
    /// Radius of the tip, metres.
    Tip(f32),
    /// Maximum force, N.
    Limit(f32),
    /// A body's file, or a model, in the place of a body.
    Upload(u8, PathBuf),
    /// The same, into flash.
    Keep(u8, PathBuf),
    /// The body that was built in, in the place of a body.
    PutBack(u8),
    /// The same, and the body stored in flash is erased.
    Forget(u8),
    /// A part of a knob's feel.
    Feel(FeelPart),
    /// That feel into flash, or out of it.
    KeepFeel(bool),
    /// The dial, repeatedly, for a number of seconds.
    Dial(f32),
    /// The enable button of a simulated device, pressed or released.
    Press(bool),
    /// Resets a simulated knob.
    Reset,
    /// Stop.
    Stop,
    /// Go on after a reset.
    Acknowledge,
}

/// Why a line is not understood.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Misunderstood {
    /// There is no such word.
    #[error("unknown command {0:?}; `help` lists all")]
    Word(String),
    /// Something is missing.
    #[error("{form}: {what} is missing")]
    Missing {
        /// Its syntax.
        form: &'static str,
        /// The missing part.
        what: &'static str,
    },
    /// Something is not what it should be.
    #[error("{form}: expected {what}, found {word:?}")]
    Wrong {
        /// Its syntax.
        form: &'static str,
        /// The word.
        word: String,
        /// The expected kind of word.
        what: &'static str,
    },
    /// Something is left over.
    #[error("{form}: {word:?} is one argument too many")]
    TooMuch {
        /// Its syntax.
        form: &'static str,
        /// The word.
        word: String,
    },
}

/// Every command: its syntax, and its effect.
pub const FORMS: [(&str, &str); 37] = [
    ("who", "what the device says of itself"),
    ("where", "tip, velocity, body, gap, force, phase and fault as they are now; of a knob its dial"),
    ("watch [SECONDS]", "the same ten times a second, for 5 s"),
    ("push X Y Z [SECONDS]", "a force in N beside that of the bodies, for 1 s; `push 0 0 0` ends it"),
    ("place BODY X Y Z [AX AY AZ DEGREES]", "puts a body's origin there, in mm, turned about this axis"),
    ("turn BODY AX AY AZ DEGREES", "turns a body that was placed here, where it is"),
    ("move BODY X Y Z SECONDS", "lets a body move on from where it is, in mm/s"),
    ("spin BODY X Y Z SECONDS", "lets a body turn about its origin, in degrees/s"),
    ("switch GROUP…", "these groups are on, all others off; `switch all`, `switch none`"),
    ("choose INDEX", "this group alone is on; of a knob, this feel"),
    ("harden BODY STIFFNESS DAMPING", "another stiffness in N/m and damping in N·s/m"),
    ("rub BODY STIFFNESS DAMPING STATIC DYNAMIC", "other friction: N/m, N·s/m, two coefficients; `rub BODY off`"),
    ("tip MM", "a ball of this radius at the tip"),
    ("limit N", "maximum force of the scene"),
    ("upload BODY FILE", "a body's file (.palp), or a model, in the place of a body"),
    ("keep BODY FILE", "the same, and it stays without power; the motors must be off, and stay off meanwhile"),
    ("back BODY", "the body that the device was built with takes the place of an uploaded or kept one"),
    ("forget BODY", "the same, and delete the stored body; the motors must be off"),
    ("detents DEGREES MNM [CENTRE]", "of a knob: smooth detents of this pitch and torque, in mN·m; `detents off`"),
    ("clicks DEGREES MNM FIRST LAST", "detents that snap, numbered from the first to the last; `clicks off`"),
    ("texture DEGREES MNM", "of a knob: a fine one of this pitch; a body's is its scene's; `texture off`"),
    ("spring MNM_PER_RAD MAX REST", "a spring to this angle with a maximum torque; `spring off`"),
    (
        "ends FROM TO MNM_PER_RAD [DAMPING]",
        "end stops between angles, damped in mN·m·s/rad, by default by 1 or what they need; `ends off`",
    ),
    ("damping VALUE", "damping everywhere in mN·m·s/rad: 0.7 for each 1,000 mN·m/rad of the parts' stiffness, or more"),
    (
        "friction MNM [RATE]",
        "dry friction, whole from this rate on, 2 rad/s; counts as damping of MNM/RATE; `friction off`",
    ),
    ("notch AT WIDTH MNM", "a click at one angle, in degrees; `notch off`"),
    ("free", "no part is left"),
    ("dial [SECONDS]", "the dial ten times a second, for 5 s: angle, rate, torque, detent, feel"),
    ("keep-feel", "stores the knob's feel without power; enable released, then held for half a second to confirm"),
    ("forget-feel", "clears the stored one, confirmed in the same way"),
    ("press", "presses the enable button of a simulated or emulated device"),
    ("release", "releases it"),
    (
        "reset",
        "resets the simulated knob (--host); it aligns within 4 s by `wait 0.2`, `press`, `wait 2`, `release`, `wait 0.2`, \
         `press`",
    ),
    ("wait SECONDS", "the next line of a file waits"),
    ("stop", "stops the device until it is reset"),
    ("ack", "goes on after a reset by the watchdog or a brown-out"),
    ("quit", "ends; the device hears nothing more from here"),
];

/// The words after a command's name.
struct Words<'a> {
    form: &'static str,
    rest: SplitWhitespace<'a>,
}

impl<'a> Words<'a> {
    fn of(name: &str, rest: SplitWhitespace<'a>) -> Self {
        let form = FORMS.iter().find(|(form, _)| form.split(' ').next() == Some(name));
        Self { form: form.map_or("", |(form, _)| form), rest }
    }

    fn optional(&mut self) -> Option<&'a str> {
        self.rest.next()
    }

    fn word(&mut self, what: &'static str) -> Result<&'a str, Misunderstood> {
        self.rest.next().ok_or(Misunderstood::Missing { form: self.form, what })
    }

    fn parsed<T: FromStr>(&self, word: &str, what: &'static str) -> Result<T, Misunderstood> {
        word.parse().map_err(|_| Misunderstood::Wrong { form: self.form, word: word.to_owned(), what })
    }

    fn body(&mut self) -> Result<u8, Misunderstood> {
        let word = self.word("a body's index")?;
        self.parsed(word, "body's index")
    }

    fn is_number(&self, word: &str, what: &'static str) -> Result<f32, Misunderstood> {
        let number: f32 = self.parsed(word, what)?;
        let wrong = || Misunderstood::Wrong { form: self.form, word: word.to_owned(), what };
        number.is_finite().then_some(number).ok_or_else(wrong)
    }

    fn number(&mut self, what: &'static str) -> Result<f32, Misunderstood> {
        let word = self.word(what)?;
        self.is_number(word, "number")
    }

    /// Three numbers of what goes so often into the unit: divided, 20 mm are the very number 0.02.
    fn vector(&mut self, in_one: f32) -> Result<[f32; 3], Misunderstood> {
        Ok([self.number("X")? / in_one, self.number("Y")? / in_one, self.number("Z")? / in_one])
    }

    fn seconds(&self, word: Option<&str>, default: f32) -> Result<f32, Misunderstood> {
        let Some(word) = word else { return Ok(default) };
        let seconds = self.is_number(word, "number of seconds")?;
        let is_time = (0.0..=86_400.0).contains(&seconds);
        if is_time {
            return Ok(seconds);
        }
        Err(Misunderstood::Wrong { form: self.form, word: word.to_owned(), what: "time of at most a day" })
    }

    fn needed_seconds(&mut self) -> Result<f32, Misunderstood> {
        let word = self.word("SECONDS")?;
        self.seconds(Some(word), 0.0)
    }

    /// A quaternion from an axis and degrees about it.
    fn orientation(&mut self) -> Result<[f32; 4], Misunderstood> {
        let [x, y, z] = self.vector(1.0)?;
        let degrees = self.number("DEGREES")?;
        let length = (x * x + y * y + z * z).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return Err(Misunderstood::Wrong { form: self.form, word: format!("{x} {y} {z}"), what: "axis" });
        }
        let (sine, cosine) = (degrees / 360.0 * TAU / 2.0).sin_cos();
        let share = sine / length;
        Ok([x * share, y * share, z * share, cosine])
    }

    fn groups(&mut self) -> Result<u32, Misunderstood> {
        let mut groups = 0;
        let mut word = self.word("a group, all or none")?;
        match word {
            "all" => return Ok(u32::MAX),
            "none" => return Ok(0),
            _ => {}
        }
        loop {
            let group: u32 = self.parsed(word, "group from 0 to 31")?;
            groups |= 1_u32.checked_shl(group).ok_or_else(|| Misunderstood::Wrong {
                form: self.form,
                word: word.to_owned(),
                what: "group from 0 to 31",
            })?;
            match self.optional() {
                Some(next) => word = next,
                None => return Ok(groups),
            }
        }
    }

    fn friction(&mut self) -> Result<Option<[f32; 4]>, Misunderstood> {
        let word = self.word("STIFFNESS or off")?;
        if word == "off" {
            return Ok(None);
        }
        let stiffness = self.is_number(word, "number")?;
        Ok(Some([stiffness, self.number("DAMPING")?, self.number("STATIC")?, self.number("DYNAMIC")?]))
    }
}

/// Parts of a knob's feel, in degrees and mN·m.
impl Words<'_> {
    /// Whether the part is to be taken away.
    fn is_off(&mut self) -> bool {
        let is_off = self.rest.clone().next() == Some("off");
        if is_off {
            self.rest.next();
        }
        is_off
    }

    fn angle(&mut self, what: &'static str) -> Result<f32, Misunderstood> {
        Ok(self.number(what)? / 360.0 * TAU)
    }

    fn milli(&mut self, what: &'static str) -> Result<f32, Misunderstood> {
        Ok(self.number(what)? / 1e3)
    }

    fn stiffness(&mut self) -> Result<f32, Misunderstood> {
        self.milli("MNM_PER_RAD")
    }

    fn optional_number(&mut self, default: f32) -> Result<f32, Misunderstood> {
        self.optional().map_or(Ok(default), |word| self.is_number(word, "number"))
    }

    fn integer(&mut self, what: &'static str) -> Result<i32, Misunderstood> {
        let word = self.word(what)?;
        self.parsed(word, "whole number")
    }

    fn wave(&mut self) -> Result<Wave, Misunderstood> {
        let (pitch_rad, torque_n_m) = (self.angle("DEGREES")?, self.milli("MNM")?);
        Ok(Wave { pitch_rad, torque_n_m, centre_rad: self.optional_number(0.0)? / 360.0 * TAU })
    }

    fn clicks(&mut self) -> Result<Detents, Misunderstood> {
        let (pitch, max_force) = (self.angle("DEGREES")?, self.milli("MNM")?);
        Ok(palpate_link::clicks(pitch, max_force, [self.integer("FIRST")?, self.integer("LAST")?], 0.55, None))
    }

    fn spring(&mut self) -> Result<Spring, Misunderstood> {
        let (stiffness_n_m_per_rad, max_torque_n_m) = (self.stiffness()?, self.milli("MAX")?);
        Ok(Spring { stiffness_n_m_per_rad, rest_rad: self.angle("REST")?, max_torque_n_m })
    }

    fn ends(&mut self) -> Result<Ends, Misunderstood> {
        let (between, stiffness) = ([self.angle("FROM")?, self.angle("TO")?], self.stiffness()?);
        let damping = self.optional().map(|word| self.is_number(word, "number")).transpose()?;
        Ok(palpate_link::ends(between, stiffness, damping.map(|damping| damping / 1e3)))
    }

    fn dial_friction(&mut self) -> Result<DialFriction, Misunderstood> {
        Ok(DialFriction { torque_n_m: self.milli("MNM")?, whole_at_rad_per_s: self.optional_number(2.0)? })
    }

    fn notch(&mut self) -> Result<Notch, Misunderstood> {
        Ok(Notch { at_rad: self.angle("AT")?, width_rad: self.angle("WIDTH")?, torque_n_m: self.milli("MNM")? })
    }

    /// The part of this name.
    fn part(&mut self, name: &str) -> Result<FeelPart, Misunderstood> {
        let is_off = self.is_off();
        fn unless<T>(
            is_off: bool,
            part: impl FnOnce() -> Result<T, Misunderstood>,
        ) -> Result<Option<T>, Misunderstood> {
            if is_off { Ok(None) } else { part().map(Some) }
        }
        Ok(match name {
            "detents" => FeelPart::Detents(unless(is_off, || self.wave())?),
            "clicks" => FeelPart::Clicks(unless(is_off, || self.clicks())?),
            "texture" => FeelPart::Texture(unless(is_off, || self.wave())?),
            "spring" => FeelPart::Spring(unless(is_off, || self.spring())?),
            "ends" => FeelPart::Ends(unless(is_off, || self.ends())?),
            "damping" => FeelPart::Damping(unless(is_off, || self.milli("VALUE"))?.unwrap_or(0.0)),
            "friction" => FeelPart::Friction(unless(is_off, || self.dial_friction())?),
            "notch" => FeelPart::Notch(unless(is_off, || self.notch())?),
            _ => FeelPart::Free,
        })
    }
}

impl FromStr for Asked {
    type Err = Misunderstood;

    fn from_str(line: &str) -> Result<Self, Misunderstood> {
        const MILLIMETRES: f32 = 1e3;
        const DEGREES: f32 = 360.0 / TAU;
        let mut rest = line.split_whitespace();
        let Some(name) = rest.next() else { return Ok(Self::Nothing) };
        // A file's remark.
        if name.starts_with('#') {
            return Ok(Self::Nothing);
        }
        let mut words = Words::of(name, rest);
        let asked = match name {
            "help" => Self::Help,
            "quit" => Self::Quit,
            "who" => Self::Who,
            "where" => Self::Where,
            "watch" => {
                let word = words.optional();
                Self::Watch(words.seconds(word, 5.0)?)
            }
            "wait" => Self::Wait(words.needed_seconds()?),
            "push" => {
                let force = words.vector(1.0)?;
                let word = words.optional();
                Self::Push(force, words.seconds(word, 1.0)?)
            }
            "place" => {
                let (body, position) = (words.body()?, words.vector(MILLIMETRES)?);
                let is_turned = words.rest.clone().next().is_some();
                Self::Place(body, position, if is_turned { Some(words.orientation()?) } else { None })
            }
            "turn" => Self::Turn(words.body()?, words.orientation()?),
            "move" => Self::Move(words.body()?, [words.vector(MILLIMETRES)?, [0.0; 3]], words.needed_seconds()?),
            "spin" => Self::Move(words.body()?, [[0.0; 3], words.vector(DEGREES)?], words.needed_seconds()?),
            "switch" => Self::Switch(words.groups()?),
            "choose" => {
                let word = words.word("INDEX")?;
                Self::Choose(words.parsed(word, "index from 0 to 255")?)
            }
            "harden" => Self::Harden(words.body()?, words.number("STIFFNESS")?, words.number("DAMPING")?),
            "rub" => Self::Rub(words.body()?, words.friction()?),
            "tip" => Self::Tip(words.number("MM")? / MILLIMETRES),
            "limit" => Self::Limit(words.number("N")?),
            "upload" => Self::Upload(words.body()?, PathBuf::from(words.word("FILE")?)),
            "keep" => Self::Keep(words.body()?, PathBuf::from(words.word("FILE")?)),
            "back" => Self::PutBack(words.body()?),
            "forget" => Self::Forget(words.body()?),
            "detents" | "clicks" | "texture" | "spring" | "ends" | "damping" | "friction" | "notch" | "free" => {
                Self::Feel(words.part(name)?)
            }
            "keep-feel" => Self::KeepFeel(true),
            "forget-feel" => Self::KeepFeel(false),
            "dial" => {
                let word = words.optional();
                Self::Dial(words.seconds(word, 5.0)?)
            }
            "press" => Self::Press(true),
            "release" => Self::Press(false),
            "reset" => Self::Reset,
            "stop" => Self::Stop,
            "ack" => Self::Acknowledge,
            _ => return Err(Misunderstood::Word(name.to_owned())),
        };
        match words.optional() {
            Some(word) => Err(Misunderstood::TooMuch { form: words.form, word: word.to_owned() }),
            None => Ok(asked),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate::device::presets::GIMBAL_KNOB;
    use palpate::render::Feel;
    use palpate::servo::Knob;

    #[test]
    fn millimetres_and_degrees_become_metres_and_radians() {
        assert_eq!("place 1 0 0 20".parse(), Ok(Asked::Place(1, [0.0, 0.0, 0.02], None)));
        assert_eq!("move 0 10 0 -5 2".parse(), Ok(Asked::Move(0, [[0.01, 0.0, -0.005], [0.0; 3]], 2.0)));
        assert_eq!("push 0 0 1".parse(), Ok(Asked::Push([0.0, 0.0, 1.0], 1.0)));
        assert_eq!("tip 1.5".parse(), Ok(Asked::Tip(0.0015)));
        let Ok(Asked::Move(3, [[0.0, 0.0, 0.0], [0.0, 0.0, rate]], 0.5)) = "spin 3 0 0 90 0.5".parse() else {
            panic!("a spin")
        };
        // A rounding of a quarter turn.
        assert!((rate - TAU / 4.0).abs() < 1e-6, "{rate}");
    }

    #[test]
    fn an_axis_of_any_length_makes_a_quaternion_of_length_1() {
        for line in ["turn 0 0 0 1 90", "turn 0 0 0 250 90", "place 0 1 2 3 0 0 0.001 90"] {
            let (Ok(Asked::Turn(0, found)) | Ok(Asked::Place(0, _, Some(found)))) = line.parse() else {
                panic!("{line}")
            };
            let wanted = [0.0, 0.0, 0.5_f32.sqrt(), 0.5_f32.sqrt()];
            // Roundings of numbers of 1.
            assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-6), "{line}: {found:?}");
        }
    }

    #[test]
    fn degrees_and_millinewton_metres_become_a_part_of_a_feel() {
        let Ok(Asked::Feel(FeelPart::Spring(Some(spring)))) = "spring 60 40 -90".parse() else { panic!("a spring") };
        assert!(spring.stiffness_n_m_per_rad == 0.06 && spring.max_torque_n_m == 0.04);
        assert!((spring.rest_rad + TAU / 4.0).abs() < 1e-6);
        let Ok(Asked::Feel(FeelPart::Clicks(Some(clicks)))) = "clicks 15 30 -5 5".parse() else { panic!("clicks") };
        assert!((clicks.stiffness * clicks.snap * clicks.pitch - 0.03).abs() < 1e-6, "{clicks:?}");
        // The stiffest end stops that the device takes, by default as damped as it asks for.
        let Ok(Asked::Feel(FeelPart::Ends(ends @ Some(_)))) = "ends -60 60 1600".parse() else { panic!("end stops") };
        let feels = Box::leak(Box::new([Feel { ends, ..Feel::FREE }]));
        assert!(Knob::try_new(&GIMBAL_KNOB, feels, 0.5).is_ok(), "{ends:?}");
        assert_eq!("notch off".parse(), Ok(Asked::Feel(FeelPart::Notch(None))));
        assert_eq!("free".parse(), Ok(Asked::Feel(FeelPart::Free)));
    }

    #[test]
    fn groups_are_bits() {
        assert_eq!("switch 0 2 31".parse(), Ok(Asked::Switch(1 | 1 << 2 | 1 << 31)));
        assert_eq!("switch all".parse(), Ok(Asked::Switch(u32::MAX)));
        assert_eq!("switch none".parse(), Ok(Asked::Switch(0)));
        assert_eq!("".parse(), Ok(Asked::Nothing));
        assert_eq!("# a remark".parse(), Ok(Asked::Nothing));
    }

    #[test]
    fn what_is_not_understood_is_refused_with_a_sentence() {
        for (line, sentence) in [
            ("jump", "unknown command \"jump\"; `help` lists all"),
            ("place 1 0 0", "place BODY X Y Z [AX AY AZ DEGREES]: Z is missing"),
            ("place 1 0 0 high", "place BODY X Y Z [AX AY AZ DEGREES]: expected number, found \"high\""),
            ("place 256 0 0 0", "place BODY X Y Z [AX AY AZ DEGREES]: expected body's index, found \"256\""),
            ("place 1 0 0 0 0 0 0 90", "place BODY X Y Z [AX AY AZ DEGREES]: expected axis, found \"0 0 0\""),
            ("turn 1 0 0 1", "turn BODY AX AY AZ DEGREES: DEGREES is missing"),
            ("push 0 0 1 -1", "push X Y Z [SECONDS]: expected time of at most a day, found \"-1\""),
            ("switch 32", "switch GROUP…: expected group from 0 to 31, found \"32\""),
            ("switch", "switch GROUP…: a group, all or none is missing"),
            ("rub 0 1 2", "rub BODY STIFFNESS DAMPING STATIC DYNAMIC: STATIC is missing"),
            ("limit NaN", "limit N: expected number, found \"NaN\""),
            ("push inf 0 0", "push X Y Z [SECONDS]: expected number, found \"inf\""),
            ("stop now", "stop: \"now\" is one argument too many"),
            ("upload 1", "upload BODY FILE: FILE is missing"),
        ] {
            assert_eq!(line.parse::<Asked>().expect_err(line).to_string(), sentence);
        }
    }

    #[test]
    fn every_form_that_help_lists_is_a_command() {
        for (form, _) in FORMS {
            let name = form.split(' ').next().unwrap_or_default();
            assert!(!matches!(name.parse::<Asked>(), Err(Misunderstood::Word(_))), "{form}");
        }
    }
}
