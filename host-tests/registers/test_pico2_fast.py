"""The Pico 2 with a servo of 20 kHz."""

from __future__ import annotations

import unittest

from at_speed import AtSpeed
from pico2 import Pico2


class FastPico2(Pico2):
    """The board with that image."""

    RATE = 20_000
    PERIOD = 150_000_000 // RATE


class Pico2Fast(AtSpeed, unittest.TestCase):
    BOARD, NAME = FastPico2, "pico2_fast"
    # The chip has none.
    WINDOW = 0.0
