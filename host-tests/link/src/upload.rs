//! A body on its way into a device.

use crate::orders::{ANSWER, BUSY};
use crate::{Device, Error, Line};
use palpate::body::{Body, BodyBuffer, Edge, Face, FileError, FileHead};
use palpate::scene::{Command, SceneError};
use palpate::wire::{CHUNK, HostMessage, Refused, Upload, UploadError};
use std::time::Duration;

/// How long the device may take to check a whole body, which it does below its ticks.
const CHECKS: Duration = Duration::from_secs(2);
/// How long a try waits for a person who is to confirm it: 20 of them are more than the device waits.
const CONFIRMS: Duration = Duration::from_secs(2);
/// Maximum number of requests for a part that was sent already.
const RESUMES: u32 = 100;
/// How often a part is sent in all: it is longer than an order, there are many, and it may come twice.
const PART_TRIES: u32 = 20;

impl<L: Line> Device<L> {
    /// Replaces a body of the scene by a body's file (`palpate bake --out part.palp`). This program checks the file
    /// first, with the device's own code, then sends it while the device renders the old body; the device checks it and
    /// takes it. Lost parts are repeated. `progress` gets the bytes sent and the total; no other request is possible
    /// meanwhile.
    ///
    /// # Errors
    /// An invalid file; a body too large for the device; the device's refusal; a line or device that is gone. The
    /// device then keeps the old body.
    pub fn upload(&mut self, body: u8, file: &[u8], progress: impl FnMut(usize, usize)) -> Result<(), Error> {
        self.usable()?;
        let head = check(file)?;
        self.fits(file, &head, self.hello().room)?;
        self.part(Upload::Begin { bytes: file.len() as u32 }, ANSWER)?;
        self.send_file(file, progress)?;
        self.replace(body)
    }

    /// Has the body that was sent take a body's place.
    fn replace(&mut self, body: u8) -> Result<(), Error> {
        self.order(Command::Take { body }).map_err(|error| match error {
            Error::Refused { reason: Refused::Command(SceneError::NotOffered), .. } => Error::Fixed { body },
            Error::Refused { reason, .. } => Error::Refused { asked: "upload", reason },
            error => error,
        })
    }

    /// Once a person at the device has held its enable button for half a second and released it, within half a minute:
    /// writes a body's file into the device's flash, and replaces a body of the scene by it: now and after every reset,
    /// with or without a host. The motors are off until it is written. The start of the write erases the earlier stored
    /// body.
    ///
    /// # Errors
    /// As [`Self::upload`]; motors that are driven, or an enable input that is held; a flash write that fails. After
    /// the start of the write no body is stored until it succeeds.
    pub fn keep(&mut self, body: u8, file: &[u8], progress: impl FnMut(usize, usize)) -> Result<(), Error> {
        self.usable()?;
        let head = check(file)?;
        self.fits(file, &head, self.hello().flash)?;
        self.begin_to_keep(body, file.len() as u32)?;
        self.send_file(file, progress)?;
        self.set_kept(file.last_chunk().map_or(0, |crc| u32::from_le_bytes(*crc)));
        self.replace(body)
    }

    /// Erases the body stored in flash; the built-in body takes this one's place again. The motors must be off.
    ///
    /// # Errors
    /// As [`Self::keep`].
    pub fn forget_kept(&mut self, body: u8) -> Result<(), Error> {
        self.usable()?;
        self.begin_to_keep(body, 0)?;
        self.put_back(body)
    }

    /// Flash is not written while its body is in use: the built-in body is put back first, so that a person confirms once.
    fn begin_to_keep(&mut self, body: u8, bytes: u32) -> Result<(), Error> {
        let is_kept = self.hello().kept != 0;
        if is_kept {
            self.put_back(body)?;
        }
        if let Err(refused) = self.part(Upload::Keep { bytes }, CONFIRMS) {
            if is_kept {
                // It is rendered again.
                self.order(Command::Take { body })?;
            }
            return Err(refused);
        }
        self.set_kept(0);
        Ok(())
    }

    /// Sends a file after its start message.
    fn send_file(&mut self, file: &[u8], mut progress: impl FnMut(usize, usize)) -> Result<(), Error> {
        let (mut at, mut resumes) = (0, RESUMES);
        loop {
            let part = part(file, at);
            let patience = if part == Upload::End { CHECKS } else { ANSWER };
            match self.part(part, patience) {
                Ok(()) if part == Upload::End => return Ok(()),
                Ok(()) => at = (at + CHUNK).min(file.len()),
                // Where the device says that it is.
                Err(Error::Refused { reason: Refused::Upload(UploadError::Order { at: wanted }), .. })
                    if resumes > 0 =>
                {
                    (at, resumes) = ((wanted as usize).min(file.len()), resumes - 1);
                }
                Err(error) => return Err(error),
            }
            progress(at, file.len());
        }
    }

    /// Sends a part, and waits for as long as the device has no bank free.
    fn part(&mut self, part: Upload, patience: Duration) -> Result<(), Error> {
        let (times, pause) = BUSY;
        for _ in 0..times {
            match self.ask("upload", (PART_TRIES, patience), |number| HostMessage::Upload { number, part })? {
                None => return Ok(()),
                Some(Refused::Upload(UploadError::Busy)) => self.pause(pause)?,
                Some(reason) => return Err(Error::Refused { asked: "upload", reason }),
            }
        }
        Err(Error::Refused { asked: "upload", reason: Refused::Upload(UploadError::Busy) })
    }

    /// Whether there is memory for it, RAM or flash. A device without any says so itself.
    fn fits(&self, file: &[u8], head: &FileHead, room: u32) -> Result<(), Error> {
        let hello = self.hello();
        let fits = file.len() <= room as usize
            && head.faces <= usize::from(hello.faces)
            && head.edges <= usize::from(hello.edges);
        if fits || room == 0 {
            return Ok(());
        }
        Err(Error::TooLarge {
            bytes: file.len(),
            faces: head.faces,
            edges: head.edges,
            room,
            most_faces: hello.faces,
            most_edges: hello.edges,
        })
    }
}

/// The part of a file that starts here, or its end.
fn part(file: &[u8], at: usize) -> Upload {
    let Some(rest) = file.get(at..).filter(|rest| !rest.is_empty()) else { return Upload::End };
    let mut bytes = [[0; 16]; CHUNK / 16];
    for (place, byte) in bytes.as_flattened_mut().iter_mut().zip(rest) {
        *place = *byte;
    }
    Upload::Bytes { at: at as u32, bytes }
}

/// Checks a body's file as a device does.
fn check(file: &[u8]) -> Result<FileHead, FileError> {
    // At a multiple of four, wherever the caller's bytes are.
    let mut words = vec![0_u32; file.len().div_ceil(4)];
    let bytes = bytemuck::cast_slice_mut::<u32, u8>(&mut words);
    for (place, byte) in bytes.iter_mut().zip(file) {
        *place = *byte;
    }
    let bytes = bytes.get(..file.len()).unwrap_or_default();
    let head = FileHead::of(bytes)?;
    let (mut faces, mut edges) = (vec![Face::VACANT; head.faces], vec![Edge::VACANT; head.edges]);
    Body::from_bytes(bytes, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
    Ok(head)
}
