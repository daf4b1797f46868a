"""Frames to a device from Python: the message, its CRC-32 and COBS (docs/reference/wire.md)."""

import struct, zlib

def frame(message: bytes) -> bytes:
    """The message, its CRC-32 and COBS, and the end."""
    out, run = bytearray(), bytearray()
    for byte in message + struct.pack("<I", zlib.crc32(message)) + b"\0":
        if byte:
            run.append(byte)                      # no message is as long as 254 bytes
        else:
            out += bytes([len(run) + 1]) + run
            run.clear()
    return bytes(out) + b"\0"

def var(number: int) -> bytes:
    low = [number >> shift & 0x7F for shift in range(0, max(number.bit_length(), 1), 7)]
    return bytes(part | 0x80 for part in low[:-1]) + bytes(low[-1:])

HELLO, ALIVE, STOP = frame(b"\5" + var(5)), frame(b"\0"), frame(b"\1")

def push(number: int, x: float, y: float, z: float) -> bytes:
    return frame(b"\6" + var(number) + b"\x09" + struct.pack("<3f", x, y, z))
