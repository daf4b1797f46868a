"""The Nucleo-G474RE's image that a host may order about: it sets the chip up and stops like the other."""

from __future__ import annotations

import unittest

from at_stops import AtStops
from in_set_up import InSetUp
from nucleo import Nucleo


class Stm32g4WithHost(InSetUp, AtStops, unittest.TestCase):
    BOARD, NAME = Nucleo, "stm32g4_host"

    # Erasing a page of flash takes up to 25 ms.
    WATCHDOG = 0.040
