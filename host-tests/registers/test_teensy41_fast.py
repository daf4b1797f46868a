"""The Teensy 4.1 with a servo of 40 kHz."""

from __future__ import annotations

import unittest

from at_speed import AtSpeed
from teensy41 import Teensy41


class FastTeensy41(Teensy41):
    """The board with that image."""

    RATE = 40_000
    PERIOD = 600_000_000 // RATE


class Teensy41Fast(AtSpeed, unittest.TestCase):
    BOARD, NAME = FastTeensy41, "teensy41_fast"
