"""An AS5047P at the other end of an SPI bus, as its data sheet has it ("SPI interface"): 16 bits a frame, the answer to
a command in the next one."""

from __future__ import annotations

DIAGNOSTICS, ANGLE = 0x3FFC, 0x3FFF
# The loop that takes offsets out has finished; the field is neither weak nor strong.
WELL = 1 << 8 | 128
# The field is too weak ("DIAAGC": MAGL); its gain is at its end.
WEAK = 1 << 8 | 1 << 11 | 255


def with_parity(frame: int) -> int:
    return frame | (bin(frame).count("1") & 1) << 15


class AngleSensor:
    """One sensor. It answers, or its wire is broken."""

    def __init__(self) -> None:
        self.angle, self.answers = 1_000, True
        # Its diagnostics, and whether its angle never changes.
        self.diagnostics, self.is_frozen = WELL, False
        self.next = self.frames = 0
        # The first half of a frame, where a bus sends bytes.
        self.half: int | None = None

    def exchange(self, frame: int) -> int | None:
        """A frame each way; `None` if nobody drives the line."""
        if not self.answers:
            return None
        assert bin(frame).count("1") % 2 == 0, "commands have even parity"
        answer = self.next
        # Its last bit is never quiet. Every fourth frame: more seldom than ticks, in which it would be seen at the same
        # level each time.
        self.frames += 1
        self.angle ^= self.frames % 4 == 0 and not self.is_frozen
        self.next = with_parity({ANGLE: self.angle, DIAGNOSTICS: self.diagnostics}.get(frame & 0x3FFF, 0))
        return answer

    def exchange_byte(self, byte: int) -> int | None:
        """Half a frame each way. What is answered does not depend on what is asked meanwhile."""
        if self.half is None:
            self.half = byte
            return self.next >> 8 if self.answers else None
        frame, self.half = self.half << 8 | byte, None
        answer = self.exchange(frame)
        return None if answer is None else answer & 0xFF
