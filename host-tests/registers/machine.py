"""What tests do with a core that runs the image of a board: reset it, let periods of its timer go by, strike it.

Unicorn has no interrupt controller: exceptions are entered and left here, as the architecture manual (ARM DDI 0403,
"Exception entry behavior", "Exception return behavior") has it: eight words pushed, EXC_RETURN in LR, all registers as
they were when that value is branched to.
"""

from __future__ import annotations

import copy
import struct
from typing import Callable

from core import CORE, DEMCR, IPR, ISER, VTOR, Core, Stuck
from log import Access

NMI, HARD_FAULT, USAGE_FAULT, SYSTEM_TICK = 2, 3, 6, 15
# The first interrupt of the chip among all exceptions.
INTERRUPTS = 16
EXC_RETURN = 0xFFFF_FFF9
# A run of so many half-words of code is taken for one that hangs; so many are more than a stop takes.
TOO_LONG, STOPS = 60_000_000, 40_000
# Memory is compared by so many bytes.
PAGE = 4096
# Pieces of code, from branch to branch, that are more than a critical section has.
MOMENTS = 200


class Machine(Core):
    """A core that can be handled."""

    def reset(self, **flags: bool) -> None:
        """Resets core and peripherals, for the reasons that the chip's model knows; memory stays as it is."""
        self.words = {}
        self.chip.reset(self, **flags)
        self._begin()

    def reset_core(self) -> None:
        """Resets the core alone, as a debugger may: the chip's registers stay as they are."""
        self.words = {word: value for word, value in self.words.items() if word < CORE}
        self._begin()

    def _begin(self) -> None:
        self.log.start()
        self.time = self.ahead = self.during = 0
        self.note_enables()
        stack, entry = self.chip.entry()
        self.set_registers(PRIMASK=0, IPSR=0, MSP=stack, LR=0xFFFF_FFFF, PC=entry)

    def set_up(self) -> None:
        """Runs until the servo's interrupt is unmasked."""
        self.run_until(lambda _: self.is_unmasked(self.chip.TICK))

    def run_until(self, event: Callable[[Access], bool]) -> Access:
        """Runs until an access is such an event."""
        self.stop_when = event
        self.run(TOO_LONG)
        if self.stop_when is not None:
            raise Stuck(f"nothing of the kind came; the last was {self.log.show(self.log.entries[-1])}")
        return self.log.entries[-1]

    def ticks(self, count: int, between: int = 1_000) -> None:
        """Runs so many periods of the timer: main for a while, then the tick."""
        for _ in range(count):
            began = self.cycles
            self.run(between)
            if self.chip.tick_is_due() and self.is_unmasked(self.chip.TICK) and self.takes_interrupts():
                self.exception(INTERRUPTS + self.chip.TICK)
            # Whatever of the period is left goes by.
            self.ahead += max(0, self.chip.PERIOD - (self.cycles - began))

    def takes_interrupts(self) -> bool:
        """Whether the core takes interrupts, or does in a moment: one that comes in a critical section waits."""
        for _ in range(MOMENTS):
            if not self.is_masked():
                break
            self.run(1)
        return not self.is_masked()

    def exception(self, number: int, returns: bool | None = True, half_words: int = STOPS) -> None:
        """Takes an exception, and runs its handler until it returns; one that must not is run for so long. Where nobody
        says whether it does (`None`), it runs until the event of `stop_when`."""
        context, was = self.unicorn.context_save(), self.during
        frame = [self.register(name) for name in ("R0", "R1", "R2", "R3", "R12", "LR", "PC", "XPSR")]
        stack = (self.register("SP") - 32) & ~7
        self.unicorn.mem_write(stack, struct.pack("<8I", *frame))
        (handler,) = struct.unpack("<I", self.memory(self.vectors() + 4 * number, 4))
        self.set_registers(SP=stack, LR=EXC_RETURN, IPSR=number, PC=handler)
        self.during = number
        self.run(half_words if returns is False else TOO_LONG)
        if returns is not None and self.left != returns:
            raise Stuck(f"exception {number} {'did not return' if returns else 'returned'}")
        if returns:
            self.unicorn.context_restore(context)
            self.during = was

    def detach_debugger(self) -> None:
        """A debugger detaches: it clears what switches the core's cycle counter on."""
        self.words[DEMCR] = 0

    def panic(self) -> None:
        """Makes the program panic, wherever it is."""
        self.set_registers(PC=self.image.symbol("rust_begin_unwind") | 1)
        self.run(STOPS)

    def snapshot(self) -> tuple:
        """All that there is."""
        memory = [(start, self.memory(start, size)) for start, size in self.chip.MEMORY]
        chip = copy.deepcopy({name: value for name, value in vars(self.chip).items() if name != "machine"})
        log = list(self.log.entries), list(self.log.enables)
        return self.unicorn.context_save(), memory, chip, dict(self.words), log, (self.time, self.ahead, self.during)

    def restore(self, snapshot: tuple) -> None:
        """Goes back to it."""
        context, memory, chip, words, log, (self.time, self.ahead, self.during) = snapshot
        self.unicorn.context_restore(context)
        for start, data in memory:
            now = self.memory(start, len(data))
            # Unicorn translates code again that was written to.
            for at in range(0, 0 if now == data else len(data), PAGE):
                if now[at : at + PAGE] != data[at : at + PAGE]:
                    self.unicorn.mem_write(start + at, data[at : at + PAGE])
        vars(self.chip).update(copy.deepcopy(chip))
        self.words = dict(words)
        self.log.start(*log)
        self.late, self.stop_when = 0, None

    def vectors(self) -> int:
        """Where the vector table is."""
        return self.words.get(VTOR, self.chip.VECTORS)

    def is_masked(self) -> bool:
        """Whether the core takes no interrupts."""
        return bool(self.register("PRIMASK"))

    def is_unmasked(self, interrupt: int) -> bool:
        """Whether the interrupt controller lets this one through."""
        return bool(self.words.get(ISER + interrupt // 32 * 4, 0) >> interrupt % 32 & 1)

    def unmasked(self) -> list[int]:
        """All that it lets through."""
        return [number for number in range(240) if self.is_unmasked(number)]

    def priority(self, interrupt: int) -> int:
        """The priority of an interrupt; 0 is the highest."""
        return self.words.get(IPR + interrupt // 4 * 4, 0) >> interrupt % 4 * 8 & 0xFF
