"""The Nucleo-G474RE's image with which it is accepted."""

from __future__ import annotations

import unittest

import telemetry
from nucleo import Nucleo
from stm32g4 import DELIVERED, FLASH, IWDG_STOP
from that_cannot_drive import ThatCannotDrive

# docs/reference/wire.md, "Request": who are you.
IDENTITY = b"\0"


class Stm32g4Accepted(ThatCannotDrive, unittest.TestCase):
    BOARD, NAME = Nucleo, "stm32g4_accept"

    def test_option_bytes_are_told_whatever_they_are(self) -> None:
        for options in (DELIVERED, DELIVERED & ~IWDG_STOP):
            machine = self.new_machine()
            machine.reset(power=True)
            machine.chip.keep(FLASH.OPTR, options)
            machine.set_up()
            machine.chip.received += telemetry.framed(IDENTITY)
            machine.ticks(120)
            finding = telemetry.unstuffed(bytes(machine.chip.sent).split(b"\0")[0])[:-4]
            # The last of the identity: LEB128, in five bytes.
            self.assertEqual(finding[0], 0)
            self.assertEqual(sum((byte & 0x7F) << 7 * at for at, byte in enumerate(finding[-5:])), options)
