"""Accesses to registers, and how tests ask for them."""

from __future__ import annotations

from dataclasses import dataclass
from operator import attrgetter
from typing import Callable, Iterable


@dataclass(slots=True)
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
        self.start()

    def start(self, entries: Iterable[Access] = (), enables: Iterable[tuple[int, tuple]] = ()) -> None:
        """Starts again, with these."""
        self.entries: list[Access] = []
        # By register, for a test may ask in each tick.
        self._writes: dict[int, list[Access]] = {}
        # The index of the entry after which they were so.
        self.enables: list[tuple[int, tuple]] = list(enables)
        for entry in entries:
            self.add(entry)

    def add(self, entry: Access) -> None:
        """Another access."""
        self.entries.append(entry)
        if entry.is_write and not entry.is_lost:
            self._writes.setdefault(entry.address, []).append(entry)

    def writes(self, *addresses: int) -> list[Access]:
        """The writes to these registers that were not lost."""
        return sorted((entry for address in addresses for entry in self._writes.get(address, ())), key=attrgetter("index"))

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
