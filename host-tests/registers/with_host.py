"""An image that a host may order about: a host that ordered something and then falls silent takes the force away."""

from __future__ import annotations

import re
from pathlib import Path

import telemetry
from bench import A_WHILE, Bench

# Ticks after which a silent host is lost: 0.1 s (docs/howto/link.md).
LOST = 400
WIRE = Path(__file__).resolve().parents[2] / "docs/reference/wire.md"
# The page's own frame, whose version is the wire's.
HELLO = bytes.fromhex(re.search(r"## HostMessage: hello\n.*?Frame: `(.*?)`", WIRE.read_text(), re.DOTALL)[1])
# The first group alone switched on.
ORDER = telemetry.framed(bytes([6, 1, 4, 0]))


class WithHost(Bench):
    """A host on the line."""

    def test_host_that_falls_silent_stops_within_the_link_timeout(self) -> None:
        machine = self.while_driving()
        machine.ticks(2 * LOST)
        self.assertTrue(self.drives(machine), "no host was heard yet")
        for frame in (HELLO, ORDER):
            machine.chip.received += frame
            machine.ticks(A_WHILE)
            self.assertTrue(self.drives(machine))
        machine.ticks(LOST)
        self.assertFalse(self.drives(machine))
        self.assertEqual(self.last(machine).fault, telemetry.LINK_LOST)
