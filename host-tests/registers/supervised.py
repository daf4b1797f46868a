"""Timing that goes on being supervised: a debugger that detaches, a counter that stands still."""

from __future__ import annotations

import telemetry
from bench import A_WHILE, Bench
from machine import Machine

# Ticks within which timing that cannot be supervised any more takes the force away: 2 ms.
WITHIN = 8


class Supervised(Bench):
    """Supervision."""

    def milliseconds_until_off(self, machine: Machine) -> float:
        """From now until the enable lines are low."""
        for tick in range(1, WITHIN + 1):
            machine.ticks(1)
            if not self.drives(machine):
                return tick / machine.chip.RATE * 1e3
        self.fail("it goes on driving")

    def show(self, what: str, milliseconds: float) -> None:
        print(f"{self.NAME}: {what}: off after {milliseconds:.2f} ms")
        self.assertLessEqual(milliseconds, 2.0)

    def test_debugger_that_detaches_leaves_ticks_supervised(self) -> None:
        machine = self.while_driving()
        machine.detach_debugger()
        machine.ticks(WITHIN)
        self.assertTrue(self.drives(machine), "nothing is wrong")
        machine.late = 2 * machine.chip.PERIOD
        self.show("a late tick after a debugger detached", self.milliseconds_until_off(machine))
        self.assertEqual(machine.late, 0, "the tick looked at the clock again")

    def test_counter_that_stands_still_stops_within_two_milliseconds(self) -> None:
        machine = self.while_driving()
        machine.chip.stands_since = machine.cycles
        self.show("a counter that stands still", self.milliseconds_until_off(machine))
        machine.ticks(A_WHILE)
        self.assertEqual(self.last(machine).phase, telemetry.FAULT)
