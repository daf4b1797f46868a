"""The Teensy 4.1's image with which it is accepted."""

from __future__ import annotations

import unittest

from teensy41 import Teensy41
from that_cannot_drive import ThatCannotDrive


class TeensyAccepted(ThatCannotDrive, unittest.TestCase):
    BOARD, NAME = Teensy41, "teensy41_accept"
