"""The knob on the Nucleo-G474RE, beyond what every board must do. What it does while it is driven is its alignment,
which is driven as soon as the button is pressed."""

from __future__ import annotations

import math
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

# Ticks in which the alignment's field comes up, and in which it goes round.
LED, TURN = 800, 2_200


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

    def test_phases_get_the_widths_of_their_field(self) -> None:
        machine = self.while_driving()
        for ahead in (LED, TURN // 3, TURN // 3):
            machine.ticks(ahead)
            widths = machine.chip.widths()
            self.assertLess(max(widths), 1.0)
            # 30 mN·m of 84 mN·m/A, of which √(2/3) is the amplitude of a phase: dead time and the torque's own ramp take
            # some.
            a, b, _ = machine.chip.currents()
            amplitude = math.hypot(a, (a + 2 * b) / math.sqrt(3))
            self.assertAlmostEqual(amplitude, 0.03 / 0.0844 * math.sqrt(2 / 3), delta=0.1)

    # Currents.

    def assert_currents_stop(self, machine: Machine, ticks: int) -> None:
        self.assert_stops_within(machine, ticks)
        machine.ticks(A_WHILE)
        self.assertEqual(self.last(machine).fault, telemetry.DRIVE)
        self.assertFalse(self.drive_again(machine), "until the next reset")

    def led(self) -> Machine:
        """A motor whose field is up, as the alignment has it after a fifth of a second."""
        machine = self.while_driving()
        machine.ticks(LED)
        self.assertTrue(self.drives(machine), "the currents are those of the widths")
        self.assertGreater(max(map(abs, machine.chip.currents())), 0.2)
        return machine

    def test_short_of_a_measured_phase_to_ground_stops_within_a_millisecond(self) -> None:
        # The third has no amplifier.
        for phase in range(2):
            machine = self.led()
            machine.chip.short_phase = phase
            self.assert_currents_stop(machine, 4)

    def test_open_phase_stops_while_its_field_needs_it(self) -> None:
        for phase in range(3):
            machine = self.led()
            machine.chip.open_phase = phase
            ticks = next((tick for tick in range(1, TURN) if machine.ticks(1) or not self.drives(machine)), None)
            self.assertIsNotNone(ticks, f"phase {phase}")
            print(f"{self.NAME}: phase {'ABC'[phase]} opens: off after {ticks / 4:.1f} ms")
            machine.ticks(A_WHILE)
            self.assertEqual(self.last(machine).fault, telemetry.DRIVE)

    def test_currents_that_are_not_measured_stop_within_four_ticks(self) -> None:
        machine = self.led()
        machine.chip.converts = False
        self.assert_stops_within(machine, 4)

    def test_amplifiers_whose_zero_is_implausible_drive_nothing(self) -> None:
        machine = self.new_machine()
        machine.reset(power=True)
        machine.chip.amplifiers = 0.0
        machine.set_up()
        self.assertFalse(self.drive_again(machine))
        self.assertEqual(self.last(machine).fault, telemetry.DRIVE)

    # The brake chopper.

    def burns_at(self, machine: Machine, volts: float) -> bool:
        machine.chip.volts = volts
        machine.ticks(2)
        return machine.chip.burns()

    def test_chopper_burns_above_one_voltage_until_a_lower_one_whether_the_motor_is_driven_or_not(self) -> None:
        for machine in (self.after_set_up(), self.once_homed(), self.while_driving()):
            self.assertFalse(self.burns_at(machine, 13.3))
            self.assertTrue(self.burns_at(machine, 13.5))
            self.assertTrue(self.burns_at(machine, 13.1))
            self.assertFalse(self.burns_at(machine, 12.9))
            self.assertFalse(self.burns_at(machine, 13.3))

    def test_chopper_rests_once_its_resistor_has_taken_its_energy(self) -> None:
        machine = self.once_homed()
        machine.chip.volts = 13.5
        taken = 0
        while taken < 10_000 and (not taken or machine.chip.burns()):
            machine.ticks(10)
            taken += 10
        # 20 J of 18.2 W less 5 W: 1.51 s.
        self.assertAlmostEqual(taken / 4_000, 20 / (13.5**2 / 10 - 5), delta=0.02)
        machine.ticks(1_000)
        self.assertFalse(machine.chip.burns(), "half of it takes 2 s to be gone")
        print(f"{self.NAME}: the chopper rests after {taken / 4_000:.2f} s at 13.5 V")

    def test_stop_of_the_program_ends_the_chopper(self) -> None:
        machine = self.once_homed()
        self.assertTrue(self.burns_at(machine, 13.5))
        machine.panic()
        self.assertFalse(machine.chip.burns())

    def test_sensors_bus_is_in_mode_1(self) -> None:
        # CPOL 0 and CPHA 1 ("SPI control register 1").
        self.assertEqual(self.after_set_up().chip.word(SPI1.CR1) & 0b11, 0b01)
