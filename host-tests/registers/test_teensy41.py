"""The Teensy 4.1, beyond what every board must do."""

from __future__ import annotations

import unittest

import telemetry
from at_resets import AtResets
from at_stops import AtStops
from bench import A_WHILE, OF_PANIC, Bench
from imxrt1062 import EN, LPSPI4, PWM2, RCS, UPDATE, WDOG3
from in_set_up import InSetUp
from machine import Machine
from on_stack import OnStack
from teensy41 import Teensy41
from with_angle_sensors import WithAngleSensors


def assert_stopped_in_set_up(test: Bench, machine: Machine) -> None:
    """It panicked before anything of the motors was touched, except to take their power."""
    test.assert_memo(machine, OF_PANIC)
    test.assertEqual(machine.unmasked(), [])
    of_motors = [entry for entry in machine.log.entries if machine.chip.is_of_motors(entry)]
    test.assertEqual([entry for entry in of_motors if not machine.chip.is_of_enables(entry)], [])


class Teensy(InSetUp, OnStack, WithAngleSensors, AtResets, AtStops, unittest.TestCase):
    BOARD, NAME = Teensy41, "teensy41"
    # The run time copies its code first.
    TESTED = 3_000_000

    def assert_did_not_start(self, machine: Machine) -> None:
        assert_stopped_in_set_up(self, machine)

    def test_watchdog_takes_its_configuration_which_is_read_back(self) -> None:
        machine = self.after_set_up()
        log, status = machine.log, machine.chip.word(WDOG3.CS)
        self.assertTrue(status >> EN & status >> RCS & 1)
        self.assertFalse(status >> UPDATE & 1, "until the next reset")
        last = log.writes(WDOG3.CS)[-1].index
        reads = {entry.address for entry in log.entries[last:] if not entry.is_write}
        self.assertLessEqual({WDOG3.CS, WDOG3.TOVAL}, reads)

    def test_watchdog_that_takes_no_configuration_stops_the_program(self) -> None:
        machine = self.new_machine()
        machine.reset(power=True)
        # As if the boot ROM had closed it for good.
        machine.chip.keep(WDOG3.CS, machine.chip.RESET[WDOG3.CS] & ~(1 << UPDATE))
        machine.run(self.LONG)
        self.assertEqual(machine.unmasked(), [])
        self.assert_stops(machine, OF_PANIC)

    def test_set_points_have_2_khz(self) -> None:
        chip = self.after_set_up().chip
        for control, period in (
            (PWM2.SM0_CTRL, PWM2.SM0_VAL1), (PWM2.SM1_CTRL, PWM2.SM1_VAL1), (PWM2.SM2_CTRL, PWM2.SM2_VAL1),
        ):  # fmt: skip
            # PRSC is the exponent of a divider of the bus's clock ("SMCTRL"); it counts from 0 to VAL1.
            counts = (chip.word(period) >> 16) + 1
            self.assertEqual(chip.bus_clock() / (1 << (chip.word(control) >> 20 & 7)) / counts, 2_000)

    def test_debugger_that_halts_the_core_ends_the_set_points(self) -> None:
        # DBGEN is clear: "the PWM outputs will be disabled until debug mode is exited" ("SMCTRL2").
        chip = self.after_set_up().chip
        for control in (PWM2.SM0_CTRL, PWM2.SM1_CTRL, PWM2.SM2_CTRL):
            self.assertFalse(chip.word(control) >> 15 & 1)

    def test_no_set_point_is_written_while_the_chip_ignores_it(self) -> None:
        # Each holds from the next of its periods on, which are two ticks long; until then it takes no other unless it
        # is told so. Whatever the phase of the ticks in a period: a tick just before its end waits for that.
        for ahead in (0, 1_000, *range(140_000, 150_001, 500)):
            machine = self.while_driving()
            machine.ahead += ahead
            machine.ticks(4)
            machine.chip.press(enable=False)
            machine.ticks(2)
            self.assertEqual(machine.chip.ignored, 0)
            self.assert_set_points_rest(machine)
            # And they come through: nothing waits for longer than a period.
            machine.ahead += 2 * machine.chip.PERIOD
            self.assertFalse(any(machine.chip.waits_for_reload(number) for number in range(3)))

    def test_no_fault_input_holds_the_set_points_off(self) -> None:
        log = self.after_set_up().log
        # Nothing drives the fault inputs: a low one must be no fault (FLVL), and what was latched is cleared (FFLAG),
        # before outputs are enabled.
        enabled = log.first(PWM2.OUTEN, lambda value: value >> 8 & 7)
        self.assertEqual(log.value(PWM2.FCTRL0, enabled) >> 12 & 0xF, 0xF)
        before = [entry.written for entry in log.writes(PWM2.FCTRL0) if entry.index < enabled]
        self.assertIn(0xF, [written >> 16 & 0xF for written in before])

    def test_stop_loop_at_the_fault_input_ends_the_set_points_between_two_ticks(self) -> None:
        machine = self.while_driving()
        self.assertTrue(all(machine.chip.widths()))
        machine.chip.fault_loop = 1
        self.assertEqual(machine.chip.widths(), [0, 0, 0])
        machine.ticks(1)
        self.assertFalse(self.drives(machine))
        machine.chip.fault_loop = 0
        machine.ticks(A_WHILE)
        self.assertTrue(self.drives(machine), "a pulse that is over")
        machine.chip.fault_loop = 1
        machine.ticks(A_WHILE)
        machine.chip.fault_loop = None
        machine.ticks(A_WHILE)
        self.assertFalse(self.drives(machine))
        self.assertEqual(self.last(machine).fault, telemetry.DRIVE)

    def test_fault_input_without_a_wire_is_pulled_down(self) -> None:
        chip = self.after_set_up().chip
        self.assertEqual((chip.fault_level(), chip.has_fault()), (0, False))

    def test_sensors_bus_is_in_mode_1(self) -> None:
        # CPOL and CPHA ("LPSPI_TCR").
        machine = self.after_set_up()
        machine.ticks(1)
        self.assertEqual(machine.chip.word(LPSPI4.TCR) >> 30, 0b01)

    def test_converter_is_calibrated(self) -> None:
        self.assertTrue(self.after_set_up().chip.is_calibrated)

    def test_core_that_locked_up_is_a_program_that_hung(self) -> None:
        self.assert_is_told(telemetry.WATCHDOG, lockup=True)

    def test_chip_that_got_too_hot_is_a_program_that_hung(self) -> None:
        self.assert_is_told(telemetry.WATCHDOG, heat=True)
