//! A host's commands.

use crate::{Device, Error, Line};
use palpate::render::{FeelPart, Friction};
use palpate::scene::{BodyPose, Command};
use palpate::wire::{HostMessage, Refused};
use std::time::Duration;

/// Time without an answer after which a request is repeated, under the same number. An adapter may hold bytes back for
/// 16 ms each way, and at 115,200 baud the frame on its way takes 8 ms more.
pub const ANSWER: Duration = Duration::from_millis(100);
/// How often something is asked for in all.
pub const TRIES: u32 = 5;
/// How often, and how long each time, a device is waited for that is busy with something else.
pub(crate) const BUSY: (u32, Duration) = (50, Duration::from_millis(10));

impl<L: Line> Device<L> {
    /// Sends a command, and waits for the answer.
    ///
    /// # Errors
    /// The device's refusal, or no answer; a line that broke, a device that was reset or is in commissioning mode.
    pub fn order(&mut self, order: Command) -> Result<(), Error> {
        self.usable()?;
        let asked = name(&order);
        let refused = self.ask(asked, (TRIES, ANSWER), |number| HostMessage::Command { number, command: order })?;
        refused.map_or(Ok(()), |reason| Err(Error::Refused { asked, reason }))
    }

    /// Sends a request that is answered by its number, and repeats it without an answer; returns the refusal, if there
    /// is one.
    pub(crate) fn ask(
        &mut self,
        asked: &'static str,
        times: (u32, Duration),
        command: impl Fn(u16) -> HostMessage,
    ) -> Result<Option<Refused>, Error> {
        self.ask_while(asked, times, command, |_| ())
    }

    /// The same, with something to do whenever the device was heard meanwhile.
    pub(crate) fn ask_while(
        &mut self,
        asked: &'static str,
        (tries, patience): (u32, Duration),
        command: impl Fn(u16) -> HostMessage,
        mut meanwhile: impl FnMut(&Self),
    ) -> Result<Option<Refused>, Error> {
        // The same however often it is sent: a device that has done it already answers again, and does not do it again.
        self.number = self.number.wrapping_add(1);
        let (number, mut busy) = (self.number, BUSY.0);
        let mut left = tries;
        while left > 0 {
            self.answer = None;
            self.send(&command(number))?;
            let sent = self.line.now();
            while self.answer.is_none() && self.since(sent) < patience {
                self.hear(patience.saturating_sub(self.since(sent)))?;
                self.usable()?;
                meanwhile(self);
            }
            match self.answer.take().map(|answer| answer.refused) {
                None => left -= 1,
                Some(Some(Refused::Busy)) if busy > 0 => {
                    busy -= 1;
                    self.pause(BUSY.1)?;
                }
                Some(Some(Refused::Hello)) => return Err(self.has_begun_anew()),
                Some(refused) => return Ok(refused),
            }
        }
        Err(Error::Lost { asked, number, tries })
    }

    /// A force of this program's own, N, in the scene's frame, added to that of the bodies. It lasts a tenth of a
    /// second ([`palpate::scene::HOLD`]) and fades unless it is repeated: call this at 20 Hz or more.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn push(&mut self, force: [f32; 3]) -> Result<(), Error> {
        self.order(Command::Push { force })
    }

    /// Moves a resting body to another place. Its force fades out, and it gives none until the tool has been in front
    /// of it.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn place(&mut self, body: u8, pose: BodyPose) -> Result<(), Error> {
        self.order(Command::Place { body, pose })
    }

    /// Guides a resting body: it has this pose now, and moves on at these velocities of its origin (m/s) and about it
    /// (rad/s) for `seconds`, unless the next call comes. For a motion that this program gives pose by pose.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn lead(&mut self, body: u8, pose: BodyPose, motion: [[f32; 3]; 2], seconds: f32) -> Result<(), Error> {
        let [velocity, angular_velocity] = motion;
        self.order(Command::Lead { body, pose, velocity, angular_velocity, seconds })
    }

    /// Lets a resting body move on from where it is, at these velocities of its origin (m/s) and about it (rad/s), for
    /// so
    /// many seconds.
    ///
    /// # Errors
    /// As [`Self::order`]; after [`Error::Lost`] only [`Self::place`] says where it is.
    pub fn move_along(&mut self, body: u8, motion: [[f32; 3]; 2], seconds: f32) -> Result<(), Error> {
        let [velocity, angular_velocity] = motion;
        self.order(Command::Move { body, velocity, angular_velocity, seconds })
    }

    /// Bodies of these groups are on, all others off; group 0 is the lowest bit.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn switch(&mut self, groups: u32) -> Result<(), Error> {
        self.order(Command::Switch { groups })
    }

    /// This group alone is on; of a knob, this feel.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn choose(&mut self, index: u8) -> Result<(), Error> {
        self.order(Command::Choose { index })
    }

    /// Another stiffness (N/m) and damping (N·s/m) for a body.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn harden(&mut self, body: u8, stiffness: f32, damping: f32) -> Result<(), Error> {
        self.order(Command::Harden { body, stiffness, damping })
    }

    /// Other friction for a body, or none.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn rub(&mut self, body: u8, friction: Option<Friction>) -> Result<(), Error> {
        let friction = friction.map(
            |Friction {
                 stiffness_n_per_m: stiffness,
                 damping_n_s_per_m: damping,
                 static_coefficient,
                 dynamic_coefficient,
             }| { [stiffness, damping, static_coefficient, dynamic_coefficient] },
        );
        self.order(Command::Rub { body, friction })
    }

    /// The tool has a ball of this radius, metres, at its tip.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn tip(&mut self, radius: f32) -> Result<(), Error> {
        self.order(Command::Tip { radius })
    }

    /// The body that the device was built with takes the place of one that was uploaded or kept.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn put_back(&mut self, body: u8) -> Result<(), Error> {
        self.order(Command::PutBack { body })
    }

    /// Maximum force of the whole scene, N; at most that of the device's settings ([`Self::hello`]).
    ///
    /// # Errors
    /// As [`Self::order`].
    pub fn limit(&mut self, newtons: f32) -> Result<(), Error> {
        self.order(Command::Limit { force: newtons })
    }
}

/// The command's name in messages.
const fn name(order: &Command) -> &'static str {
    match order {
        Command::Place { .. } => "place",
        Command::Lead { .. } => "lead",
        Command::Move { .. } => "move",
        Command::Switch { .. } => "switch",
        Command::Choose { .. } => "choose",
        Command::Harden { .. } => "harden",
        Command::Rub { .. } => "rub",
        Command::Tip { .. } => "tip",
        Command::Limit { .. } => "limit",
        Command::Push { .. } => "push",
        Command::Take { .. } => "take",
        Command::PutBack { .. } => "put back",
        Command::Feel(part) => match part {
            FeelPart::Detents(_) => "detents",
            FeelPart::Clicks(_) => "clicks",
            FeelPart::Texture(_) => "texture",
            FeelPart::Spring(_) => "spring",
            FeelPart::Ends(_) => "ends",
            FeelPart::Damping(_) => "damping",
            FeelPart::Friction(_) => "friction",
            FeelPart::Notch(_) => "notch",
            FeelPart::Free => "free",
        },
    }
}
