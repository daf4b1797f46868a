"""Accesses to registers, and how tests ask for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable


@dataclass(frozen=True)
class Access:
    """One access to a register. A write's value is the whole word after it."""

    index: int
    is_write: bool
    address: int
    value: int
    # What the program wrote, which may be an order that the register does not keep.
    written: int
    # The core's cycles before, counted as one for each half-word of code: a core takes no fewer.
    time: int
    # The exception it was made in; 0 is main.
    during: int
    # Cycles that the program saw go by on the core's own counter since the access before.
    waited: int
    # Whether the peripheral took no notice, for it had no clock or was held in reset.
    is_lost: bool


class Log:
    """Every access since the reset, in order, and when the enable lines changed."""

    def __init__(self, chip) -> None:
        self.chip = chip
        self.entries: list[Access] = []
        # The index of the entry after which they were so.
        self.enables: list[tuple[int, tuple]] = []

    def writes(self, *addresses: int) -> list[Access]:
        """The writes to these registers that were not lost."""
        return [entry for entry in self.entries if entry.is_write and entry.address in addresses and not entry.is_lost]

    def first(self, address: int, condition: Callable[[int], bool] = lambda _: True, write: bool = True) -> int:
        """The index of the first write, or read, of a register with such a value."""
        for entry in self.entries:
            if (entry.address, entry.is_write) == (address, write) and not entry.is_lost and condition(entry.value):
                return entry.index
        raise AssertionError(f"no such {'write to' if write else 'read of'} {self.chip.name(address)}")

    def value(self, address: int, before: int) -> int:
        """What was last written to a register before an entry; what reset left there if nothing was."""
        for entry in reversed(self.entries[:before]):
            if entry.address == address and entry.is_write and not entry.is_lost:
                return entry.value
        return self.chip.RESET.get(address, 0)

    def show(self, entry: Access) -> str:
        """An entry, for people."""
        what = "write" if entry.is_write else "read"
        lost = ", lost" if entry.is_lost else ""
        return f"{entry.index}: {what} {self.chip.name(entry.address)} {entry.value:#010x}{lost}"
