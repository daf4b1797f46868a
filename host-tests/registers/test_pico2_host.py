"""The Pico 2's image that a host may order about: it sets the chip up and stops like the other."""

from __future__ import annotations

import unittest

from at_stops import AtStops
from in_set_up import InSetUp
from on_stack import OnStack
from pico2 import Pico2
from supervised import Supervised
from with_host import WithHost
from with_wiring import WithWiring


class PicoWithHost(WithHost, Supervised, InSetUp, OnStack, AtStops, WithWiring, unittest.TestCase):
    BOARD, NAME, WINDOW = Pico2, "pico2_host", 0.0
    # Two bodies' worth of memory.
    TESTED = 3_000_000
