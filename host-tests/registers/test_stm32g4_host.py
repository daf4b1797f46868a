"""The Nucleo-G474RE's image that a host may order about: it sets the chip up and stops like the other."""

from __future__ import annotations

import unittest

import telemetry
import unicorn
from at_stops import AtStops
from in_set_up import InSetUp
from machine import NMI, Machine
from nucleo import Nucleo
from on_stack import OnStack
from stm32g4 import BANK_2, BANK_SIZE, BFB2, BK_ECC, DBANK, DELIVERED, ECCD, FLASH
from supervised import Supervised
from with_host import WithHost
from with_wiring import WithWiring

# The last page of the second bank of the flash.
CALIBRATION = BANK_2 + BANK_SIZE - 0x800


class Stm32g4WithHost(WithHost, Supervised, InSetUp, OnStack, AtStops, WithWiring, unittest.TestCase):
    BOARD, NAME = Nucleo, "stm32g4_host"

    # Erasing a page of flash takes up to 25 ms.
    WATCHDOG = 0.040

    def began_with(self, is_damaged: bool) -> Machine:
        """A board whose second bank is erased; the words of its calibration can be read, or make the chip say that they
        cannot: by an NMI ("Error code correction")."""
        machine = self.new_machine()
        machine.unicorn.mem_write(BANK_2, b"\xff" * BANK_SIZE)
        machine.reset(power=True)
        machine.chip.keep(FLASH.OPTR, DELIVERED)
        if is_damaged:
            hook = machine.unicorn.hook_add(
                unicorn.UC_HOOK_MEM_READ, lambda uc, *_: uc.emu_stop(), begin=CALIBRATION, end=CALIBRATION + 63
            )
            machine.run(self.LONG)
            machine.unicorn.hook_del(hook)
            machine.chip.keep(FLASH.ECCR, ECCD | BK_ECC)
            machine.exception(NMI)
        machine.set_up()
        return machine

    def test_chip_that_starts_in_its_second_bank_keeps_nothing_there(self) -> None:
        for options, reads in ((DELIVERED, True), (DELIVERED | BFB2, False), (DELIVERED & ~DBANK, False)):
            machine, read = self.new_machine(), []
            machine.unicorn.mem_write(BANK_2, b"\xff" * BANK_SIZE)
            machine.reset(power=True)
            machine.chip.keep(FLASH.OPTR, options)
            machine.unicorn.hook_add(
                unicorn.UC_HOOK_MEM_READ, lambda *_, read=read: read.append(_), begin=BANK_2, end=BANK_2 + BANK_SIZE - 1
            )
            machine.set_up()
            self.assertEqual(bool(read), reads)

    def test_calibration_that_cannot_be_read_keeps_the_motors_off(self) -> None:
        self.assertTrue(self.drive_again(self.began_with(is_damaged=False)), "none is kept: as it was built")
        machine = self.began_with(is_damaged=True)
        self.assertFalse(self.drive_again(machine))
        self.assert_never_high(machine)
        self.assertEqual(self.last(machine).phase, telemetry.FAULT)
