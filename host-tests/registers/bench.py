"""What the image of every board on the bench must do to its chip's registers, whichever chip it is."""

from __future__ import annotations

import os
from pathlib import Path

import telemetry
from image import Image
from machine import HARD_FAULT, INTERRUPTS, NMI, SYSTEM_TICK, USAGE_FAULT, Machine

# What the boards' settings and READMEs say.
RATE, WATCHDOG, BAUD = 4_000, 0.020, 500_000
# More ticks than homing by hand takes (a tenth of a second), and so many that a record has surely come.
HOMING, A_WHILE = 500, 60
# Memo::new in boards/bench/src/reset.rs.
MARK, OF_RUNNING, OF_PANIC, OF_EXCEPTION = 0x70A1_9A00, 1, 2, 3
# An interrupt of the chip that no board uses.
STRAY = 3


class Bench:
    """Tests of one board; the class that takes them says which."""

    BOARD: type
    NAME: str
    OF_PANIC, A_WHILE, LONG = OF_PANIC, A_WHILE, 60_000_000

    @classmethod
    def setUpClass(cls) -> None:
        cls.image = Image(Path(os.environ[f"PALPATE_IMAGE_{cls.NAME.upper()}"]))
        machine = Machine(cls.image, cls.BOARD())
        machine.reset(power=True)
        machine.set_up()
        cls.set_up = machine.snapshot()
        machine.ticks(A_WHILE)
        cls.home(machine)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        cls.driving = machine.snapshot()
        cls.shared = machine

    @staticmethod
    def home(machine: Machine) -> None:
        """Homes by the button, and lets go of it."""
        machine.chip.press(enable=True)
        machine.ticks(HOMING)
        machine.chip.press(enable=False)
        machine.ticks(A_WHILE)

    def new_machine(self) -> Machine:
        """A board with new memory."""
        return Machine(self.image, self.BOARD())

    def after_set_up(self) -> Machine:
        """Just before the first tick after power-on, with nothing pressed."""
        self.shared.restore(self.set_up)
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

    # In set-up.

    def test_enable_lines_are_low_outputs_before_anything_else_of_the_motors(self) -> None:
        machine = self.after_set_up()
        log, chip = machine.log, machine.chip
        self.assertEqual(set(log.enables[0][1]), {None}, "reset leaves them to the board")
        low = next(index for index, levels in log.enables if set(levels) == {0})
        of_motors = [entry for entry in log.entries if chip.is_of_motors(entry)]
        self.assertTrue(of_motors)
        early = [entry for entry in of_motors if entry.index < low and not chip.is_of_enables(entry)]
        self.assertEqual([log.show(entry) for entry in early if not entry.is_lost], [])

    def test_no_enable_line_rises_in_set_up(self) -> None:
        for pressed in (False, True):
            machine = self.started(pressed, power=True)
            self.assert_never_high(machine)
            self.assertEqual(set(machine.chip.enable_lines()), {0})

    def test_watchdog_runs_before_the_first_tick_can_come(self) -> None:
        machine = self.after_set_up()
        self.assertAlmostEqual(machine.chip.watchdog_seconds(), WATCHDOG, delta=0.01 * WATCHDOG)
        self.assertLess(machine.chip.watchdog_started(), len(machine.log.entries) - 1)

    def test_watchdog_is_fed_only_while_ticks_go_on(self) -> None:
        machine = self.after_set_up()
        machine.ticks(A_WHILE)
        fed = machine.chip.feeds()
        machine.ticks(A_WHILE)
        self.assertGreater(machine.chip.feeds() - fed, A_WHILE // 8)
        machine.run(100_000)
        fed = machine.chip.feeds()
        machine.run(1_000_000)
        self.assertEqual(machine.chip.feeds(), fed)

    def test_nothing_can_delay_the_tick(self) -> None:
        machine = self.after_set_up()
        self.assertEqual(machine.priority(machine.chip.TICK), 0)
        self.assertEqual(machine.unmasked(), [machine.chip.TICK])
        self.assertFalse(machine.is_masked())

    def test_rate_comes_of_the_clock_as_it_was_set(self) -> None:
        machine = self.after_set_up()
        # A timer may count one more: the rate is then a cycle in some ten thousand off, and crystals are no better.
        self.assertAlmostEqual(machine.chip.tick_rate(), RATE, delta=1e-4 * RATE)
        machine.ticks(A_WHILE)
        self.assertEqual(self.last(machine).clock, machine.chip.core_clock(), "what the records call its cycles")

    def test_serial_port_has_its_rate(self) -> None:
        # A frame of ten bits is understood while its last bit is met: both ends together may be off by 5 %.
        self.assertAlmostEqual(self.after_set_up().chip.baud(), BAUD, delta=0.02 * BAUD)

    # Force.

    def test_enable_held_at_power_on_moves_nothing_until_released_and_pressed(self) -> None:
        machine = self.started(pressed=True, power=True)
        machine.ticks(HOMING)
        self.assert_never_high(machine)
        self.assertEqual(self.last(machine).reset, telemetry.POWER_ON)
        machine.chip.press(enable=False)
        machine.ticks(A_WHILE)
        self.assertTrue(self.drive_again(machine))
        self.assertEqual(self.last(machine).phase, telemetry.RUNNING)

    def test_what_breaks_takes_the_enable_lines_down_in_the_same_tick(self) -> None:
        for what in self.BOARD.BREAKS:
            with self.subTest(what):
                machine = self.while_driving()
                machine.chip.break_line(what)
                machine.ticks(self.BOARD.BREAKS[what])
                self.assertFalse(self.drives(machine))

    def test_force_comes_back_only_once_enable_was_let_go_of(self) -> None:
        machine = self.while_driving()
        machine.chip.press(stop=True)
        machine.ticks(1)
        self.assertFalse(self.drives(machine))
        since = len(machine.log.entries)
        machine.chip.press(stop=False)
        machine.ticks(A_WHILE)
        self.assert_never_high(machine, since)
        self.assertTrue(self.last(machine).hold & telemetry.RELEASE_FIRST)
        machine.chip.press(enable=False)
        machine.ticks(1)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        self.assertTrue(self.drives(machine))

    def test_late_tick_takes_the_enable_lines_down(self) -> None:
        machine = self.while_driving()
        machine.late = 2 * machine.chip.PERIOD
        machine.ticks(1)
        self.assertFalse(self.drives(machine))
        self.assertEqual(machine.late, 0, "the tick looked at the clock again")

    # Resets.

    def assert_stays_safe(self, machine: Machine, reason: int) -> None:
        """A reset that is a fault: nothing is driven until stop was pressed and let go of."""
        self.assertFalse(self.drive_again(machine))
        self.assert_never_high(machine)
        record = self.last(machine)
        self.assertEqual((record.reset, record.phase), (reason, telemetry.FAULT))
        machine.chip.press(enable=False, stop=True)
        machine.ticks(A_WHILE)
        machine.chip.press(stop=False)
        machine.ticks(A_WHILE)
        self.assertTrue(self.drive_again(machine), "once it is acknowledged there is force again")

    def test_watchdog_reset_stays_safe_until_acknowledged(self) -> None:
        for pressed in (False, True):
            machine = self.started(pressed, memory=self.while_driving(), watchdog=True)
            self.assert_stays_safe(machine, telemetry.WATCHDOG)

    def test_brown_out_stays_safe_until_acknowledged(self) -> None:
        machine = self.started(memory=self.while_driving(), **self.BOARD.BROWN_OUT)
        self.assert_stays_safe(machine, telemetry.BROWN_OUT)

    def test_reset_of_the_core_alone_takes_the_enable_lines_down_at_once(self) -> None:
        machine = self.while_driving()
        self.assertTrue(self.drives(machine))
        machine.reset_core()
        machine.run_until(lambda _: set(machine.chip.enable_lines()) == {0})
        writes = [entry for entry in machine.log.entries if machine.chip.is_of_motors(entry)]
        self.assertEqual(len(writes), 1, "before anything else of the motors is touched")

    # Stops.

    def assert_stops(self, machine: Machine, memo: int) -> None:
        """The motors are off, the light is on, the memo is there, and so it stays until the watchdog bites."""
        self.assertEqual(set(machine.chip.enable_lines()), {0})
        self.assertTrue(machine.chip.light())
        word, complement = machine.chip.memo()
        self.assertEqual((word, complement), (MARK | memo, ~(MARK | memo) & 0xFFFF_FFFF))
        length, fed = len(machine.log.entries), machine.chip.feeds()
        machine.ticks(A_WHILE)
        self.assertEqual(machine.log.entries[length:], [], "it waits, and takes no ticks")
        self.assertEqual(machine.chip.feeds(), fed)

    def test_every_exception_stops(self) -> None:
        for number in (NMI, HARD_FAULT, USAGE_FAULT, SYSTEM_TICK, INTERRUPTS + STRAY):
            with self.subTest(number):
                machine = self.while_driving()
                since = len(machine.log.entries)
                machine.exception(number, returns=False)
                self.assert_never_high(machine, since + 1)
                self.assert_stops(machine, OF_EXCEPTION)

    def test_light_says_of_a_stop(self) -> None:
        machine = self.after_set_up()
        machine.ticks(A_WHILE)
        self.assertFalse(machine.chip.light())
        machine.exception(HARD_FAULT, returns=False)
        self.assert_stops(machine, OF_EXCEPTION)

    def test_exception_in_the_tick_stops(self) -> None:
        machine = self.while_driving()
        machine.stop_when = lambda entry: machine.chip.is_acknowledged(entry)
        machine.exception(INTERRUPTS + machine.chip.TICK, returns=None)
        machine.exception(HARD_FAULT, returns=False)
        self.assert_stops(machine, OF_EXCEPTION)

    def test_stop_is_told_after_the_watchdog_has_bitten(self) -> None:
        machine = self.while_driving()
        machine.exception(HARD_FAULT, returns=False)
        self.assert_stays_safe(self.started(memory=machine, watchdog=True), telemetry.EXCEPTION)

    def test_panic_stops_and_is_told(self) -> None:
        machine = self.while_driving()
        machine.panic()
        self.assert_stops(machine, OF_PANIC)
        self.assert_stays_safe(self.started(memory=machine, watchdog=True), telemetry.PANIC)

    def test_memo_of_a_running_loop_is_left_before_the_first_tick(self) -> None:
        word, complement = self.after_set_up().chip.memo()
        self.assertEqual((word, complement), (MARK | OF_RUNNING, ~(MARK | OF_RUNNING) & 0xFFFF_FFFF))

    def test_no_peripheral_is_touched_before_it_has_its_clock(self) -> None:
        machine = self.while_driving()
        lost = {machine.chip.name(entry.address) for entry in machine.log.entries if entry.is_lost}
        self.assertEqual(lost, self.BOARD.LOST)
