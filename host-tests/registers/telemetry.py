"""What the loop says of itself over its serial port: records, as docs/reference/wire.md has them."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass

HELLO, RECORD, ANSWER, DIAL = 0, 1, 3, 7
POWER_ON, PIN, SOFTWARE, WATCHDOG, BROWN_OUT, PANIC, EXCEPTION, TOOL = 0, 1, 2, 3, 4, 6, 7, 8
CALIBRATE, ARMED, RUNNING, FAULT = 1, 2, 3, 4
FRAME_LOST, LINK_LOST, DRIVE, MAGNET, FROZEN = 1, 8, 12, 21, 22
STOP, NOT_READY, SUPPLY, RELEASE_FIRST = 1, 2, 4, 8
VARIABLE = ("tick", "number", "clock", "began", "shortest", "longest", "took", "dropped")


@dataclass(frozen=True)
class Record:
    """A record as far as the tests ask for it."""

    tick: int
    number: int
    clock: int
    began: int
    shortest: int
    longest: int
    took: int
    dropped: int
    phase: int
    fault: int
    reset: int
    hold: int
    gap: float
    probe: tuple[float, ...]


def unstuffed(frame: bytes) -> bytes:
    """A frame without its COBS."""
    message, at = bytearray(), 0
    while at < len(frame):
        length = frame[at]
        message += frame[at + 1 : at + length]
        at += length
        if length < 0xFF and at < len(frame):
            message.append(0)
    return bytes(message)


def framed(message: bytes) -> bytes:
    """A message, shorter than a block of COBS, as a host sends it."""
    blocks = (message + zlib.crc32(message).to_bytes(4, "little")).split(b"\0")
    return b"".join(bytes([len(block) + 1]) + block for block in blocks) + b"\0"


def messages(line: bytes) -> list[bytes]:
    """The messages of a line, checked; what comes after the last whole frame is left."""
    found = []
    for frame in line.split(b"\0")[:-1]:
        message = unstuffed(frame)
        body, checksum = message[:-4], int.from_bytes(message[-4:], "little")
        assert zlib.crc32(body) == checksum, "a frame of the image is damaged"
        found.append(body)
    return found


def records(line: bytes) -> list[Record]:
    """The records among them."""
    return [record(body[1:]) for body in messages(line) if body[0] == RECORD]


def record(body: bytes) -> Record:
    """A record's message."""
    at = 0

    def variable() -> int:
        nonlocal at
        value = shift = 0
        while True:
            value |= (body[at] & 0x7F) << shift
            at, shift = at + 1, shift + 7
            if not body[at - 1] & 0x80:
                return value

    fields = {name: variable() for name in VARIABLE}
    fields["phase"], fields["fault"] = body[at], body[at + 1]
    at += 2
    variable()
    fields["reset"] = body[at]
    at += 1
    variable(), variable(), variable()
    # The gains of three sensors.
    at += 3
    fields["hold"] = body[at]
    at += 1
    # The feature; mode and contact are a byte each.
    variable()
    gap, *probe = struct.unpack_from("<4f", body, at + 2)
    return Record(**fields, gap=gap, probe=tuple(probe))
