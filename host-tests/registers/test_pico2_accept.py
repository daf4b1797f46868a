"""The Pico 2's image with which it is accepted."""

from __future__ import annotations

import unittest

from pico2 import Pico2
from that_cannot_drive import ThatCannotDrive


class PicoAccepted(ThatCannotDrive, unittest.TestCase):
    BOARD, NAME = Pico2, "pico2_accept"
