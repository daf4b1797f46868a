"""A board on the bench, as its tests find it: after set-up, homed, driving, reset for some reason."""

from __future__ import annotations

import os
from pathlib import Path

import telemetry
from image import Image
from machine import Machine

# More ticks than homing by hand takes (a tenth of a second), and so many that a record has surely come.
# Longer too than the 25 ms for which a hold goes on, and a release must last.
HOMING, A_WHILE = 500, 120
# More than the 50 ms for which stop is held, and let go of, by somebody who acknowledges.
HELD = 250
# Memo::new in boards/src/reset.rs.
MARK, OF_RUNNING, OF_PANIC, OF_EXCEPTION = 0x70A1_9A00, 1, 2, 3


class Bench:
    """Tests of one board; the class that takes them says which."""

    BOARD: type
    NAME: str
    A_WHILE, LONG = A_WHILE, 12_000_000
    # The phase while it is driven, and whether a light says of a stop.
    DRIVING, HAS_LIGHT = telemetry.RUNNING, True

    @classmethod
    def load(cls) -> None:
        """Loads the image."""
        cls.image = Image(Path(os.environ["PALPATE_IMAGES"]) / cls.NAME)

    @classmethod
    def setUpClass(cls) -> None:
        cls.load()
        machine = Machine(cls.image, cls.BOARD())
        machine.reset(power=True)
        machine.set_up()
        cls.set_up = machine.snapshot()
        cls.wait(machine, A_WHILE)
        cls.home(machine)
        cls.at_rest = machine.snapshot()
        machine.chip.press(enable=True)
        cls.wait(machine, A_WHILE)
        cls.driving = machine.snapshot()
        cls.shared = machine

    @staticmethod
    def wait(machine: Machine, ticks: int) -> None:
        """As long as this number of ticks of 4 kHz."""
        machine.ticks(ticks * machine.chip.RATE // 4_000)

    @classmethod
    def home(cls, machine: Machine) -> None:
        """Homes by the button, and lets go of it."""
        machine.chip.press(enable=True)
        cls.wait(machine, HOMING)
        machine.chip.press(enable=False)
        cls.wait(machine, A_WHILE)

    def new_machine(self) -> Machine:
        """A board with new memory."""
        return Machine(self.image, self.BOARD())

    def after_set_up(self) -> Machine:
        """Just before the first tick after power-on, with nothing pressed."""
        self.shared.restore(self.set_up)
        return self.shared

    def once_homed(self) -> Machine:
        """Homed, with nothing pressed: the button is all that is missing for force."""
        self.shared.restore(self.at_rest)
        return self.shared

    def while_driving(self) -> Machine:
        """Homed, and driving because the button is pressed."""
        self.shared.restore(self.driving)
        return self.shared

    def started(self, pressed: bool = False, memory: Machine | None = None, **reset: bool) -> Machine:
        """A board that was reset for these reasons, at its first tick; in new memory, or in that of another run."""
        machine = memory or self.new_machine()
        machine.reset(**reset)
        machine.chip.press(enable=pressed)
        machine.set_up()
        return machine

    def last(self, machine: Machine) -> telemetry.Record:
        """The last record that came over the serial port."""
        return telemetry.records(bytes(machine.chip.sent))[-1]

    def drives(self, machine: Machine) -> bool:
        """Whether all enable lines are high; they are never so in part, except between two writes."""
        levels = set(machine.chip.enable_lines())
        self.assertEqual(len(levels), 1, levels)
        return levels == {1}

    def assert_never_high(self, machine: Machine, since: int = 0) -> None:
        for index, levels in machine.log.enables:
            if index >= since:
                by = machine.log.show(machine.log.entries[index - 1]) if index else "reset"
                self.assertNotIn(1, levels, f"an enable line rises by {by}")

    def drive_again(self, machine: Machine) -> bool:
        """Does all that a person does to get force after a reset, short of acknowledging it."""
        machine.ticks(A_WHILE)
        self.home(machine)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        return self.drives(machine)

    def assert_set_points_rest(self, machine: Machine) -> None:
        for width in machine.chip.widths():
            # To a count of a timer that has a thousand or more.
            self.assertAlmostEqual(width, self.BOARD.REST, delta=1e-3)

    def assert_memo(self, machine: Machine, cause: int) -> None:
        word, complement = machine.chip.memo()
        self.assertEqual((word, complement), (MARK | cause, ~(MARK | cause) & 0xFFFF_FFFF))
