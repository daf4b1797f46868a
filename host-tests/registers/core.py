"""A Cortex-M core among registers that a chip's model answers for, run by Unicorn; every access to them is logged."""

from __future__ import annotations

from typing import Callable

import unicorn
from unicorn import arm_const as arm

from image import Image
from log import Access, Log

# The core's own registers (ARM DDI 0403, "System Control Space").
CORE, CORE_SIZE = 0xE000_0000, 0x10_0000
# Its cycle counter, and what switches it on: a debugger that detaches clears it (ARM DDI 0403, "DEMCR", TRCENA).
CYCCNT, DEMCR, TRCENA = 0xE000_1004, 0xE000_EDFC, 1 << 24
ISER, ICER, IPR = 0xE000_E100, 0xE000_E180, 0xE000_E400
ICSR, VTOR = 0xE000_ED04, 0xE000_ED08
# Unicorn's number for a branch to EXC_RETURN.
LEFT = 8
# What memory holds before anything was written: anything but zeros.
NOISE = 0xA5
# After so many looks at the clock on end, a wait of milliseconds is hurried, so many cycles a look.
PATIENT_LOOKS, HURRY = 500, 1_000
# The bits of XPSR that say which instructions of an IT block are left.
IN_IT_BLOCK = 0x0600_FC00


class Stuck(Exception):
    """The program did something that no board can go on from."""


class Core:
    """The core, its memory and its log. The chip says where things are and what its registers answer."""

    def __init__(self, image: Image, chip) -> None:
        self.image, self.chip = image, chip
        self.log = Log(chip)
        self.words: dict[int, int] = {}
        # Half-words of code run, and cycles that went by besides.
        self.time = self.ahead = 0
        # The exception that is being handled.
        self.during = 0
        # Bytes of the access that is being answered.
        self.width = 4
        # Looks at the clock since anything else was touched, what the first and the last of them saw; cycles that go by
        # after a handler's first.
        self.looks = self.late = self.first_look = self.last_look = 0
        self.until, self.left = 0, False
        self.error: Exception | None = None
        self.stop_when: Callable[[Access], bool] | None = None
        self.unicorn = unicorn.Uc(unicorn.UC_ARCH_ARM, unicorn.UC_MODE_THUMB | unicorn.UC_MODE_MCLASS)
        self.unicorn.ctl_set_cpu_model(chip.CORE)
        for start, size in chip.MEMORY:
            self.unicorn.mem_map(start, size)
            self.unicorn.mem_write(start, bytes([NOISE]) * size)
        for start, size in (*chip.REGISTERS, (CORE, CORE_SIZE)):
            self.unicorn.mmio_map(start, size, self._read, start, self._write, start)
        for load, data in image.segments:
            self.unicorn.mem_write(load, data)
        self.unicorn.hook_add(unicorn.UC_HOOK_BLOCK, self._block)
        self.unicorn.hook_add(unicorn.UC_HOOK_INTR, self._interrupt)
        self.unicorn.hook_add(unicorn.UC_HOOK_MEM_INVALID, self._invalid)

    @property
    def cycles(self) -> int:
        """The core's cycles: one for each half-word of code, and what went by between ticks."""
        return self.time + self.ahead

    def register(self, name: str) -> int:
        """A register of the core."""
        return self.unicorn.reg_read(getattr(arm, f"UC_ARM_REG_{name}"))

    def set_registers(self, **values: int) -> None:
        """Sets registers of the core."""
        for name, value in values.items():
            self.unicorn.reg_write(getattr(arm, f"UC_ARM_REG_{name}"), value)

    def memory(self, address: int, size: int) -> bytes:
        """What lies in memory."""
        return bytes(self.unicorn.mem_read(address, size))

    def run(self, half_words: int) -> None:
        """Runs about so much code, of whatever runs now."""
        self.until, self.left = self.time + half_words, False
        try:
            self.unicorn.emu_start(self.register("PC") | 1, 0xFFFF_FFFE)
        except unicorn.UcError as error:
            self.error = self.error or error
        if self.error is not None:
            error, self.error = self.error, None
            raise error

    def stick(self, why: str) -> None:
        """The program did what no board can go on from, in a hook of a test's."""
        self.error = self.error or Stuck(why)
        self.unicorn.emu_stop()

    # What Unicorn asks. It would swallow an error in here: `run` raises it.

    def _block(self, _uc, _address: int, size: int, _data) -> None:
        if self.time >= self.until and not self.register("XPSR") & IN_IT_BLOCK:
            self.unicorn.emu_stop()
        else:
            self.time += size // 2

    def _interrupt(self, _uc, number: int, _data) -> None:
        if number == LEFT and self.during:
            self.left = True
        else:
            self.error = Stuck(f"an exception of the core (Unicorn's {number}) at {self.register('PC'):#x}")
        self.unicorn.emu_stop()

    def _invalid(self, _uc, _kind, address: int, _size: int, _value: int, _data) -> bool:
        self.error = Stuck(f"nothing is at {address:#x}, touched at {self.register('PC'):#x}")
        return False

    def _read(self, _uc, offset: int, size: int, base: int) -> int:
        try:
            return self._read_word(base + offset, size)
        except Exception as error:
            self.error = error
            self.unicorn.emu_stop()
            return 0

    def _write(self, _uc, offset: int, size: int, value: int, base: int) -> None:
        try:
            self._write_word(base + offset, size, value)
        except Exception as error:
            self.error = error
            self.unicorn.emu_stop()

    def _read_word(self, address: int, size: int) -> int:
        word, shift = address & ~3, (address & 3) * 8
        self.width = size
        lost = word < CORE and self.chip.is_lost(word)
        is_clock = word in (CYCCNT, self.chip.COUNTER)
        if is_clock:
            value = 0 if lost else self._clock(word)
        elif word >= CORE:
            value = self.during if word == ICSR else self.words.get(word, 0)
        else:
            value = 0 if lost else self.chip.read(word) & 0xFFFF_FFFF
        if not is_clock:
            self._note(False, word, value, 0, lost)
        return value >> shift & (1 << 8 * size) - 1

    def _write_word(self, address: int, size: int, value: int) -> None:
        word, shift = address & ~3, (address & 3) * 8
        self.width = size
        value, mask = value << shift, (1 << 8 * size) - 1 << shift
        if word >= CORE:
            old = self.words.get(word, 0)
            value = old & ~mask | value & mask
            # Bits of the interrupts' enables are only ever set here.
            self.words[word] = old | value if ISER <= word < ICER else value
            return self._note(True, word, value, value, False)
        word, value, mask = self.chip.alias(word, value, mask)
        written = self.chip.word(word) & ~mask | value & mask
        lost = self.chip.is_lost(word)
        value = written if lost else self.chip.write(word, written)
        self._note(True, word, value, written, lost)
        self.note_enables()

    def _clock(self, word: int) -> int:
        """A look at the core's own counter or at the chip's."""
        if word == CYCCNT:
            now = self.cycles if self.words.get(DEMCR, 0) & TRCENA else 0
        else:
            now = self.chip.count_of_cycles()
        self.looks += 1
        self.last_look = self.cycles
        if self.looks == 1:
            self.first_look = self.last_look
        if self.looks > PATIENT_LOOKS:
            self.ahead += HURRY
        if self.during and self.late:
            self.ahead, self.late = self.ahead + self.late, 0
        return now & 0xFFFF_FFFF

    def _note(self, is_write: bool, word: int, value: int, written: int, lost: bool) -> None:
        waited = self.last_look - self.first_look if self.looks else 0
        self.looks = 0
        entry = Access(len(self.log.entries), is_write, word, value, written, self.cycles, self.during, waited, lost)
        self.log.add(entry)
        if self.stop_when is not None and self.stop_when(entry):
            self.stop_when = None
            self.unicorn.emu_stop()

    def note_enables(self) -> None:
        """Notes what the enable lines are now, if they changed."""
        now = tuple(self.chip.enable_lines())
        if not self.log.enables or self.log.enables[-1][1] != now:
            self.log.enables.append((len(self.log.entries), now))
