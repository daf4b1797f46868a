"""A linked image, as a loader puts it into flash: segments at their load addresses, and the symbols."""

from __future__ import annotations

import struct
from pathlib import Path

LOADED, SYMBOLS = 1, 2


class Image:
    """An ELF file of 32 bits, little-endian."""

    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        if data[:6] != b"\x7fELF\x01\x01":
            raise ValueError(f"{path} is no ELF file of 32 bits")
        (self.entry,) = struct.unpack_from("<I", data, 24)
        programs, sections = struct.unpack_from("<II", data, 28)
        program_size, program_count, section_size, section_count = struct.unpack_from("<4H", data, 42)
        self.segments: list[tuple[int, bytes]] = []
        # Where everything lies while the program runs: each segment's first address and size.
        self.placed: list[tuple[int, int]] = []
        for at in range(programs, programs + program_count * program_size, program_size):
            kind, offset, runs, load, size, memory = struct.unpack_from("<6I", data, at)
            if kind == LOADED and memory:
                self.placed.append((runs, memory))
            if kind == LOADED and size:
                self.segments.append((load, data[offset : offset + size]))
        self.symbols: dict[str, int] = {}
        headers = [struct.unpack_from("<10I", data, sections + i * section_size) for i in range(section_count)]
        for header in headers:
            if header[1] == SYMBOLS:
                names = headers[header[6]][4]
                for at in range(header[4], header[4] + header[5], 16):
                    name, value = struct.unpack_from("<II", data, at)
                    end = data.index(b"\0", names + name)
                    self.symbols[data[names + name : end].decode()] = value

    def symbol(self, part: str) -> int:
        """The address of the only symbol whose name has this part."""
        found = {value for name, value in self.symbols.items() if part in name}
        if len(found) != 1:
            raise LookupError(f"{len(found)} symbols have {part!r} in their names")
        return found.pop()
