"""What the models of all chips have in common."""

from __future__ import annotations

import struct

# Names of registers, as the manuals have them, by address.
NAMES: dict[int, str] = {}


class Block:
    """The registers of a peripheral: `Block("RCC", 0x4002_1000, CR=0).CR` is an address."""

    def __init__(self, name: str, base: int, **offsets: int) -> None:
        self.base = base
        for register, offset in offsets.items():
            setattr(self, register, base + offset)
            NAMES[base + offset] = f"{name}_{register}"


class Chip:
    """Registers that remember what was written, if their peripheral has a clock. A chip says what answers otherwise."""

    # What registers hold after power-on, if it is not 0.
    RESET: dict[int, int]
    # Where the vector table is after a reset.
    VECTORS: int
    # The counter that times ticks and waits, the core's cycles of one of its counts, and whether it stands still: since
    # that cycle.
    COUNTER: int
    COUNTER_CYCLES = 1
    # Ticks a second.
    RATE = 4_000
    # Where the image of the code in RAM begins.
    CODE_IMAGE = "__hot_image"
    stands_since: int | None = None
    machine = None

    def name(self, address: int) -> str:
        return NAMES.get(address, f"{address:#010x}")

    def word(self, address: int) -> int:
        """What a register holds."""
        return self.machine.words.get(address, self.RESET.get(address, 0))

    def keep(self, address: int, value: int) -> int:
        """Lets a register hold this."""
        self.machine.words[address] = value & 0xFFFF_FFFF
        return value & 0xFFFF_FFFF

    def count_of_cycles(self) -> int:
        """What the counter shows, if it was started."""
        now = self.machine.cycles if self.stands_since is None else self.stands_since
        return now // self.COUNTER_CYCLES if self.is_counting() else 0

    def counter_clock(self) -> float:
        """Of the counter, Hz."""
        return self.core_clock() / self.COUNTER_CYCLES

    def entry(self) -> tuple[int, int]:
        """Stack and program counter after a reset: the first words of the vector table."""
        return struct.unpack("<II", self.machine.memory(self.VECTORS, 8))

    def alias(self, address: int, value: int, mask: int) -> tuple[int, int, int]:
        """The register that an address stands for, with the bits that are written."""
        return address, value, mask
