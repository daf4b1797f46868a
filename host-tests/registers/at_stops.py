"""A program that is wrong: every panic, exception, NMI and stray interrupt stops the motors, says so, and waits for the
watchdog."""

from __future__ import annotations

import struct

import telemetry
from bench import A_WHILE, HELD, OF_EXCEPTION, OF_PANIC, Bench
from machine import HARD_FAULT, INTERRUPTS, NMI, STOPS, SYSTEM_TICK, USAGE_FAULT, Machine

# An interrupt of the chip that no board uses.
STRAY = 3


class AtStops(Bench):
    """Stops."""

    def assert_stops(self, machine: Machine, cause: int) -> None:
        """The motors are off, the light is on, the memo is there, and so it stays until the watchdog bites."""
        self.assertEqual(set(machine.chip.enable_lines()), {0})
        self.assertEqual(machine.chip.light(), self.HAS_LIGHT)
        self.assert_memo(machine, cause)
        length, fed = len(machine.log.entries), machine.chip.feeds()
        machine.ticks(A_WHILE)
        self.assertEqual(machine.log.entries[length:], [], "it waits, and takes no ticks")
        self.assertEqual(machine.chip.feeds(), fed)

    def assert_exception_stops(self, number: int) -> None:
        machine = self.while_driving()
        self.assertTrue(self.drives(machine))
        since = len(machine.log.entries)
        machine.exception(number, returns=False)
        self.assert_never_high(machine, since + 1)
        self.assert_stops(machine, OF_EXCEPTION)

    def test_panic_stops(self) -> None:
        machine = self.while_driving()
        self.assertTrue(self.drives(machine))
        machine.panic()
        self.assert_stops(machine, OF_PANIC)

    def test_hard_fault_stops(self) -> None:
        self.assert_exception_stops(HARD_FAULT)

    def test_nmi_stops(self) -> None:
        self.assert_exception_stops(NMI)

    def test_usage_fault_stops(self) -> None:
        self.assert_exception_stops(USAGE_FAULT)

    def test_exception_that_nobody_asked_for_stops(self) -> None:
        self.assert_exception_stops(SYSTEM_TICK)

    def test_stray_interrupt_stops(self) -> None:
        self.assert_exception_stops(INTERRUPTS + STRAY)

    def test_exception_in_the_tick_stops(self) -> None:
        machine = self.while_driving()
        machine.stop_when = machine.chip.is_acknowledged
        machine.exception(INTERRUPTS + machine.chip.TICK, returns=None)
        machine.exception(HARD_FAULT, returns=False)
        self.assert_stops(machine, OF_EXCEPTION)

    def test_word_of_the_program_that_differs_from_its_image_stops(self) -> None:
        machine = self.after_set_up()
        # The image's: the copy's own might be run before it is compared.
        changed = machine.image.symbol(machine.chip.CODE_IMAGE) + 4 * 500
        (word,) = struct.unpack("<I", machine.memory(changed, 4))
        machine.unicorn.mem_write(changed, struct.pack("<I", word ^ 1 << 7))
        for _ in range(HELD):
            if not machine.is_masked():
                machine.ticks(1)
        machine.run(STOPS)
        self.assertTrue(machine.is_masked())
        self.assert_memo(machine, OF_PANIC)

    def test_enable_line_that_reads_high_though_released_is_a_fault_before_any_force(self) -> None:
        machine = self.once_homed()
        machine.ticks(A_WHILE)
        self.assertNotEqual(self.last(machine).phase, telemetry.FAULT)
        machine.chip.short_enable()
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        self.assertEqual(self.last(machine).phase, telemetry.FAULT)
        self.assert_set_points_rest(machine)

    def test_light_says_of_a_stop(self) -> None:
        machine = self.after_set_up()
        machine.ticks(A_WHILE)
        self.assertFalse(machine.chip.light())
        machine.exception(HARD_FAULT, returns=False)
        self.assert_stops(machine, OF_EXCEPTION)
