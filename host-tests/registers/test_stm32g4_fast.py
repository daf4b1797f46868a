"""The Nucleo-G474RE with a servo of 20 kHz."""

from __future__ import annotations

import unittest

from at_speed import AtSpeed
from nucleo import Nucleo


class FastNucleo(Nucleo):
    """The board with that image."""

    RATE = 20_000
    PERIOD = 170_000_000 // RATE


class Stm32g4Fast(AtSpeed, unittest.TestCase):
    BOARD, NAME = FastNucleo, "stm32g4_fast"
