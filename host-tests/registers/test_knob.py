"""The knob on the Nucleo-G474RE, beyond what every board must do. What it does while it is driven is its alignment,
which is driven as soon as the button is pressed."""

from __future__ import annotations

import unittest

import telemetry
from at_resets import AtResets
from at_stops import AtStops
from bench import A_WHILE
from in_set_up import InSetUp
from machine import Machine
from on_stack import OnStack
from shield import Shield
from stm32g4 import GPIO, PWR, SPI1
from with_angle_sensors import WithAngleSensors


class Knob(InSetUp, OnStack, WithAngleSensors, AtResets, AtStops, unittest.TestCase):
    BOARD, NAME = Shield, "knob"
    DRIVING, HAS_LIGHT = telemetry.CALIBRATE, False

    @staticmethod
    def home(machine: Machine) -> None:
        """There is nothing to home by hand."""
        machine.ticks(A_WHILE)

    def test_phases_have_25_khz(self) -> None:
        chip = self.after_set_up().chip
        for timer, _ in chip.WIDTHS:
            self.assertEqual(chip.word(timer.CR1) & 0b11_1_0_0_0_1, 1, "it counts, and only up")
            periods = chip.timer_clock() / (chip.word(timer.PSC) + 1) / (chip.word(timer.ARR) + 1)
            self.assertAlmostEqual(periods, 25_000, delta=25)

    def test_phases_are_driven_through_their_pins_only_once_enable_is_low(self) -> None:
        log = self.after_set_up().log
        low = next(index for index, levels in log.enables if set(levels) == {0})
        for port, pin in (("B", 10), ("C", 7), ("B", 4)):
            given = log.first(GPIO[port].MODER, lambda value, pin=pin: value >> 2 * pin & 3 == 2)
            self.assertLess(low, given)

    def test_dead_battery_pull_downs_are_off_before_the_pins_are_used(self) -> None:
        # What is on PA9 and PA10 pulls at PB6 and PB4.
        log = self.after_set_up().log
        off = log.first(PWR.CR3, lambda value: value & 1 << 14)
        used = [log.first(GPIO["B"].MODER, lambda value, pin=pin: value >> 2 * pin & 3 != 3) for pin in (4, 6)]
        self.assertLess(off, min(used))

    def test_sensors_bus_is_in_mode_1(self) -> None:
        # CPOL 0 and CPHA 1 ("SPI control register 1").
        self.assertEqual(self.after_set_up().chip.word(SPI1.CR1) & 0b11, 0b01)
