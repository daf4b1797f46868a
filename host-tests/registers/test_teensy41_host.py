"""The Teensy 4.1's image that a host may order about: it sets the chip up and stops like the other."""

from __future__ import annotations

import unittest

from at_stops import AtStops
from in_set_up import InSetUp
from machine import Machine
from on_stack import OnStack
from supervised import Supervised
from teensy41 import Teensy41
from test_teensy41 import assert_stopped_in_set_up
from with_host import WithHost
from with_wiring import WithWiring


class TeensyWithHost(WithHost, Supervised, InSetUp, OnStack, AtStops, WithWiring, unittest.TestCase):
    BOARD, NAME = Teensy41, "teensy41_host"
    TESTED = 3_000_000

    def assert_did_not_start(self, machine: Machine) -> None:
        assert_stopped_in_set_up(self, machine)
