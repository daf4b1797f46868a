"""The Pico 2's image that a host may order about: it sets the chip up and stops like the other."""

from __future__ import annotations

import unittest

from at_stops import AtStops
from in_set_up import InSetUp
from on_stack import OnStack
from pico2 import Pico2
from with_host import WithHost


class PicoWithHost(WithHost, InSetUp, OnStack, AtStops, unittest.TestCase):
    BOARD, NAME, WINDOW = Pico2, "pico2_host", 0.0
    # Two bodies' worth of memory.
    TESTED = 3_000_000
