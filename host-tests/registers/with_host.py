"""An image that a host may order about: a host that ordered something and then falls silent takes the force away."""

from __future__ import annotations

import telemetry
from bench import A_WHILE, Bench

# Ticks after which a silent host is lost: 0.1 s (docs/howto/link.md).
LOST = 400
# docs/reference/wire.md, "HostMessage": a hello, and the first group alone switched on.
HELLO, ORDER = bytes([5, 3]), bytes([6, 1, 4, 0])


class WithHost(Bench):
    """A host on the line."""

    def test_host_that_falls_silent_stops_within_the_link_timeout(self) -> None:
        machine = self.while_driving()
        machine.ticks(2 * LOST)
        self.assertTrue(self.drives(machine), "no host was heard yet")
        for message in (HELLO, ORDER):
            machine.chip.received += telemetry.framed(message)
            machine.ticks(A_WHILE)
            self.assertTrue(self.drives(machine))
        machine.ticks(LOST)
        self.assertFalse(self.drives(machine))
        self.assertEqual(self.last(machine).fault, telemetry.LINK_LOST)
