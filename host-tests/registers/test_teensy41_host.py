"""The Teensy 4.1's image that a host may order about: it sets the chip up and stops like the other."""

from __future__ import annotations

import unittest

from at_stops import AtStops
from in_set_up import InSetUp
from on_stack import OnStack
from teensy41 import Teensy41
from with_host import WithHost
from with_wiring import WithWiring


class TeensyWithHost(WithHost, InSetUp, OnStack, AtStops, WithWiring, unittest.TestCase):
    BOARD, NAME = Teensy41, "teensy41_host"
    TESTED = 0
