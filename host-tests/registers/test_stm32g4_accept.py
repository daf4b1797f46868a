"""The Nucleo-G474RE's image with which it is accepted."""

from __future__ import annotations

import unittest

from nucleo import Nucleo
from that_cannot_drive import ThatCannotDrive


class Stm32g4Accepted(ThatCannotDrive, unittest.TestCase):
    BOARD, NAME = Nucleo, "stm32g4_accept"
