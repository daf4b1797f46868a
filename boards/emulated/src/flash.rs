//! Flash that a reset leaves alone. No emulator here has any that a program can write: it is RAM with the rules of
//! flash, and a file of the host, beside its FIFOs, from one start of the emulator to the next.

use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
use palpate_bench::store::{Broken, Pretended, PretendedFlash};
use semihosting::fs::{File, OpenOptions};
use semihosting::io::{Read, Write};

/// A page.
const BYTES: usize = 2_048;
const WORDS: usize = BYTES / 4;

static PAGE: PretendedFlash<WORDS> = PretendedFlash::new();

/// A page of flash, in the file `flash` in the folder where the emulator was started.
pub struct FileFlash(Pretended<WORDS>);

impl FileFlash {
    /// The content of the file; erased if there is no file. `None` the second time.
    pub fn open() -> Option<Self> {
        let mut page = PAGE.writer()?;
        let mut bytes = [0xff; BYTES];
        if let Ok(mut file) = File::open(c"flash") {
            let mut read = 0;
            while let Some(rest) = bytes.get_mut(read..).filter(|rest| !rest.is_empty()) {
                match file.read(rest) {
                    Ok(more) if more > 0 => read += more,
                    _ => break,
                }
            }
            let _ = page.write(0, &bytes);
        }
        Some(Self(page))
    }

    /// The file as the page is.
    fn save(&mut self) {
        let mut bytes = [0; BYTES];
        let file = OpenOptions::new().write(true).create(true).truncate(true).open(c"flash");
        if let (Ok(mut file), Ok(())) = (file, self.0.read(0, &mut bytes)) {
            // A host that is gone resets nothing.
            let _ = file.write_all(&bytes);
        }
    }
}

impl ErrorType for FileFlash {
    type Error = Broken;
}

impl ReadNorFlash for FileFlash {
    const READ_SIZE: usize = Pretended::<WORDS>::READ_SIZE;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Broken> {
        self.0.read(offset, bytes)
    }

    fn capacity(&self) -> usize {
        BYTES
    }
}

impl NorFlash for FileFlash {
    const WRITE_SIZE: usize = Pretended::<WORDS>::WRITE_SIZE;
    const ERASE_SIZE: usize = Pretended::<WORDS>::ERASE_SIZE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Broken> {
        let erased = self.0.erase(from, to);
        self.save();
        erased
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Broken> {
        let written = self.0.write(offset, bytes);
        self.save();
        written
    }
}
