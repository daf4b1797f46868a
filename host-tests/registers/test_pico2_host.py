"""The Pico 2's image that a host may order about: it sets the chip up and stops like the other."""

from __future__ import annotations

import unittest

from at_stops import AtStops
from in_set_up import InSetUp
from on_stack import OnStack
from pico2 import Pico2


class PicoWithHost(InSetUp, OnStack, AtStops, unittest.TestCase):
    BOARD, NAME = Pico2, "pico2_host"
