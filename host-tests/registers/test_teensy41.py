"""The Teensy 4.1, beyond what every board must do."""

from __future__ import annotations

import unittest

import telemetry
from bench import Bench
from imxrt1062 import EN, GPIO, LPSPI4, PWM2, RCS, UPDATE, WDOG3
from teensy41 import SELECTS, Teensy41


class Teensy(Bench, unittest.TestCase):
    BOARD, NAME = Teensy41, "teensy41"

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
        self.assert_stops(machine, self.OF_PANIC)

    def test_set_points_rest_until_they_are_driven(self) -> None:
        machine = self.after_set_up()
        chip = machine.chip
        widths = (PWM2.SM0_VAL3, PWM2.SM1_VAL3, PWM2.SM2_VAL3)
        self.assertEqual([chip.word(width) >> 16 for width in widths], [0, 0, 0])
        machine.ticks(1)
        for width, control, period in zip(
            widths, (PWM2.SM0_CTRL, PWM2.SM1_CTRL, PWM2.SM2_CTRL), (PWM2.SM0_VAL1, PWM2.SM1_VAL1, PWM2.SM2_VAL1)
        ):
            # PRSC is the exponent of a divider of the bus's clock ("SMCTRL"); it counts from 0 to VAL1.
            counts = (chip.word(period) >> 16) + 1
            self.assertEqual(chip.bus_clock() / (1 << (chip.word(control) >> 20 & 7)) / counts, 2_000)
            # 10 % is no current, as the amplifiers are configured; to a count.
            self.assertAlmostEqual(chip.word(width) >> 16, 0.1 * counts, delta=1)

    def test_no_fault_input_holds_the_set_points_off(self) -> None:
        log = self.after_set_up().log
        # Nothing drives the fault inputs: a low one must be no fault (FLVL), and what was latched is cleared (FFLAG),
        # before outputs are enabled.
        enabled = log.first(PWM2.OUTEN, lambda value: value >> 8 & 7)
        self.assertEqual(log.value(PWM2.FCTRL0, enabled) >> 12 & 0xF, 0xF)
        before = [entry.written for entry in log.writes(PWM2.FCTRL0) if entry.index < enabled]
        self.assertIn(0xF, [written >> 16 & 0xF for written in before])

    def test_sensors_are_asked_as_their_data_sheet_wants(self) -> None:
        machine = self.after_set_up()
        machine.ticks(2)
        chip = machine.chip
        self.assertLessEqual(chip.sensor_clock(), 10e6)
        self.assertEqual(chip.word(LPSPI4.TCR) >> 30, 0b01, "mode 1")
        # 350 ns from the select line's fall to the first clock, and high as long between two frames.
        least = 350e-9 * chip.core_clock()
        bits = {bit for _, bit, _ in SELECTS}
        self.assertEqual(len(bits), 3)
        frames = 0
        fell = rose = None
        for entry in machine.log.entries:
            if entry.address == GPIO[2].DR_CLEAR and entry.is_write and any(entry.written >> bit & 1 for bit in bits):
                if rose is not None:
                    self.assertGreaterEqual(entry.time - rose, least)
                fell = entry.time
            elif entry.address == GPIO[2].DR_SET and entry.is_write:
                rose = entry.time
            elif entry.address == LPSPI4.TDR:
                self.assertGreaterEqual(entry.time - fell, least)
                frames += 1
        self.assertGreater(frames, 12)

    def test_converter_is_calibrated(self) -> None:
        self.assertTrue(self.after_set_up().chip.is_calibrated)

    def test_every_reason_of_a_reset_is_told(self) -> None:
        hung = {"lockup": telemetry.WATCHDOG, "heat": telemetry.WATCHDOG}
        for reason, number in ({"power": telemetry.POWER_ON, "pin": telemetry.PIN} | hung).items():
            with self.subTest(reason):
                machine = self.started(**{reason: True})
                machine.ticks(2 * self.A_WHILE)
                self.assertEqual(self.last(machine).reset, number)
