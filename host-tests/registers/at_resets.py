"""Resets: which of them are faults, and what is driven after one (nothing, until somebody has acknowledged it)."""

from __future__ import annotations

import telemetry
from bench import HELD, OF_RUNNING, Bench
from machine import HARD_FAULT, Machine


class AtResets(Bench):
    """Resets."""

    def assert_stays_safe(self, machine: Machine, reason: int) -> None:
        """A reset that is a fault: nothing is driven until stop was pressed and let go of."""
        self.assertFalse(self.drive_again(machine))
        self.assert_never_high(machine)
        record = self.last(machine)
        self.assertEqual((record.reset, record.phase), (reason, telemetry.FAULT))
        # Stop has to be seen released first, for as long.
        machine.chip.press(enable=False)
        machine.ticks(HELD)
        machine.chip.press(stop=True)
        machine.ticks(HELD)
        machine.chip.press(stop=False)
        machine.ticks(HELD)
        self.assertTrue(self.drive_again(machine), "once it is acknowledged there is force again")

    def assert_is_told(self, reason: int, **reset: bool) -> None:
        machine = self.started(**reset)
        machine.ticks(2 * self.A_WHILE)
        self.assertEqual(self.last(machine).reset, reason)

    def test_power_on_is_told(self) -> None:
        self.assert_is_told(telemetry.POWER_ON, power=True)

    def test_reset_by_the_pin_is_told(self) -> None:
        self.assert_is_told(telemetry.PIN, **self.BOARD.BY_PIN)

    def test_memo_of_a_running_loop_is_left_before_the_first_tick(self) -> None:
        self.assert_memo(self.after_set_up(), OF_RUNNING)

    def test_watchdog_reset_stays_safe_until_acknowledged(self) -> None:
        self.assert_stays_safe(self.started(memory=self.while_driving(), watchdog=True), telemetry.WATCHDOG)

    def test_watchdog_reset_with_enable_held_stays_safe_until_acknowledged(self) -> None:
        machine = self.started(pressed=True, memory=self.while_driving(), watchdog=True)
        self.assert_stays_safe(machine, telemetry.WATCHDOG)

    def test_brown_out_stays_safe_until_acknowledged(self) -> None:
        machine = self.started(memory=self.while_driving(), **self.BOARD.BROWN_OUT)
        self.assert_stays_safe(machine, telemetry.BROWN_OUT)

    def test_exception_is_told_after_the_watchdog_has_bitten_and_stays_safe_until_acknowledged(self) -> None:
        machine = self.while_driving()
        machine.exception(HARD_FAULT, returns=False)
        self.assert_stays_safe(self.started(memory=machine, watchdog=True), telemetry.EXCEPTION)

    def test_panic_is_told_after_the_watchdog_has_bitten_and_stays_safe_until_acknowledged(self) -> None:
        machine = self.while_driving()
        machine.panic()
        self.assert_stays_safe(self.started(memory=machine, watchdog=True), telemetry.PANIC)

    def test_reset_of_the_core_alone_takes_the_enable_lines_down_at_once(self) -> None:
        machine = self.while_driving()
        self.assertTrue(self.drives(machine))
        machine.reset_core()
        machine.run_until(lambda _: set(machine.chip.enable_lines()) == {0})
        writes = [entry for entry in machine.log.entries if machine.chip.is_of_motors(entry)]
        self.assertEqual(len(writes), 1, "before anything else of the motors is touched")
