"""The image with which a board is accepted: nothing that anybody presses drives a motor."""

from __future__ import annotations

from bench import A_WHILE, HOMING, OF_PANIC, Bench
from machine import Machine


class ThatCannotDrive(Bench):
    """Acceptance."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.load()

    def assert_nothing_drives(self, machine: Machine) -> None:
        """Presses and lets go of everything: what homes, what asks for force, what acknowledges a reset, force again."""
        machine.ticks(A_WHILE)
        machine.chip.press(enable=True)
        machine.ticks(HOMING)
        for pressed in ({}, {"enable": True}, {}, {"stop": True}, {}, {"enable": True}):
            machine.chip.press(**{"enable": False, "stop": False} | pressed)
            machine.ticks(A_WHILE)
        self.assert_never_high(machine)
        self.assertEqual(set(machine.chip.enable_lines()), {0})
        self.assert_set_points_rest(machine)

    def test_nothing_drives_after_power_on(self) -> None:
        self.assert_nothing_drives(self.started(power=True))

    def test_nothing_drives_with_enable_held_at_power_on(self) -> None:
        self.assert_nothing_drives(self.started(pressed=True, power=True))

    def test_nothing_drives_after_a_watchdog_reset(self) -> None:
        machine = self.started(power=True)
        machine.ticks(A_WHILE)
        self.assert_nothing_drives(self.started(memory=machine, watchdog=True))

    def test_panic_stops(self) -> None:
        machine = self.started(power=True)
        machine.ticks(A_WHILE)
        machine.panic()
        self.assertEqual(set(machine.chip.enable_lines()), {0})
        self.assertTrue(machine.chip.light())
        self.assert_memo(machine, OF_PANIC)
