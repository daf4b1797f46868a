"""The Pico 2, beyond what every board must do."""

from __future__ import annotations

import unittest

import telemetry
from at_resets import AtResets
from at_stops import AtStops
from in_set_up import InSetUp
from on_stack import OnStack
from pico2 import BUTTON, ENABLES, MOTORS, READY, SELECTS, SET_POINTS, SLICES, STOP, SUPPLY, Pico2
from rp2350 import (
    IE, IO, PADS, PDE, POWMAN, PSM, PUE, PWM, PWM_FUNCTION, RESETS_STAGE, ROSC, SIO_FUNCTION, SPI0, STAGES, WATCHDOG,
    XOSC_STAGE,
)  # fmt: skip
from with_angle_sensors import WithAngleSensors


class Pico(InSetUp, OnStack, WithAngleSensors, AtResets, AtStops, unittest.TestCase):
    BOARD, NAME, WINDOW = Pico2, "pico2", 0.0

    # Pins.

    def test_enable_line_is_pulled_down_from_reset_on(self) -> None:
        machine = self.after_set_up()
        for pin in ENABLES:
            pads = [entry.value for entry in machine.log.writes(getattr(PADS, f"GPIO{pin}"))]
            for pad in (machine.chip.RESET[getattr(PADS, f"GPIO{pin}")], *pads):
                self.assertEqual(pad >> PDE & 0b11, 0b01)

    def test_motors_pins_are_never_pulled_up(self) -> None:
        log = self.after_set_up().log
        for pin in MOTORS:
            self.assertFalse(any(entry.value >> PUE & 1 for entry in log.writes(getattr(PADS, f"GPIO{pin}"))))

    def test_slices_stand_at_no_width_before_their_pins_are_given_to_them(self) -> None:
        log = self.after_set_up().log
        for pin, number in zip(SET_POINTS, SLICES):
            given = log.first(getattr(IO, f"GPIO{pin}_CTRL"), lambda value: value & 0x1F == PWM_FUNCTION)
            self.assertLess(log.first(getattr(PWM, f"CH{number}_CC"), lambda value: value & 0xFFFF == 0), given)
            self.assertLess(log.first(getattr(PWM, f"CH{number}_TOP")), given)

    def test_motors_widths_have_20_khz(self) -> None:
        chip = self.after_set_up().chip
        for number in SLICES:
            self.assertEqual(chip.slice_rate(number), 20_000)

    def test_buttons_are_pulled_up(self) -> None:
        chip = self.after_set_up().chip
        for pin in (BUTTON, STOP):
            self.assertEqual([chip.pad(pin, bit) for bit in (PUE, PDE, IE)], [1, 0, 1])

    def test_ready_lines_are_left_to_the_resistors_on_the_board(self) -> None:
        # The chip's own pull-down is weaker than its leakage (erratum RP2350-E9).
        chip = self.after_set_up().chip
        for pin in READY:
            self.assertEqual([chip.pad(pin, bit) for bit in (PUE, PDE, IE)], [0, 0, 1])
            self.assertEqual(chip.function(pin), SIO_FUNCTION)

    def test_nothing_but_the_divider_is_at_the_converters_pin(self) -> None:
        # Whatever is written to a pad that is still isolated, it keeps the pull-down that it has from reset.
        chip = self.after_set_up().chip
        self.assertEqual([chip.pad(SUPPLY, bit) for bit in (PUE, PDE, IE)], [0, 0, 0])
        self.assertFalse(chip.is_output(SUPPLY))

    def test_sensors_bus_is_in_mode_1(self) -> None:
        # SPO 0 and SPH 1 ("SSPCR0").
        machine = self.after_set_up()
        self.assertEqual(machine.chip.word(SPI0.SSPCR0) >> 6 & 0b11, 0b10)
        self.assertEqual(len(SELECTS), 3)

    # Resets.

    def test_watchdog_resets_the_pads_and_starts_the_processors_anew(self) -> None:
        selected = self.after_set_up().chip.word(PSM.WDSEL)
        # The sequence restarts at the first that is selected: peripherals and pads come after it.
        self.assertTrue(selected & (1 << RESETS_STAGE + 1) - 1)
        self.assertEqual(selected, (1 << STAGES) - 1 & ~(1 << ROSC | 1 << XOSC_STAGE))

    def test_watchdog_never_switches_the_cores_supply_which_would_hold_the_pads(self) -> None:
        log = self.after_set_up().log
        self.assertEqual(log.writes(POWMAN.WDSEL), [])

    def test_reboot_by_picotool_is_told_from_a_program_that_hung(self) -> None:
        self.assert_is_told(telemetry.TOOL, tool=True)

    def test_reset_that_was_asked_for_is_told(self) -> None:
        self.assert_is_told(telemetry.SOFTWARE, force=True)

    def test_reset_by_a_debuggers_port_is_told(self) -> None:
        self.assert_is_told(telemetry.SOFTWARE, debugger=True)

    def test_glitch_of_the_supply_is_a_brown_out(self) -> None:
        self.assert_is_told(telemetry.BROWN_OUT, glitch=True)

    def test_brown_out_is_not_believed_twice(self) -> None:
        machine = self.started(**self.BOARD.BROWN_OUT)
        self.assert_stays_safe(self.started(memory=machine, watchdog=True), telemetry.WATCHDOG)

    def test_brown_out_before_is_none_of_a_reset_that_was_asked_for_later(self) -> None:
        for before, reason in ((self.BOARD.BROWN_OUT, telemetry.BROWN_OUT), ({"glitch": True}, telemetry.BROWN_OUT)):
            machine = self.started(**before)
            machine.ticks(2 * self.A_WHILE)
            self.assertEqual(self.last(machine).reset, reason)
            machine = self.started(memory=machine, force=True)
            machine.ticks(2 * self.A_WHILE)
            self.assertEqual(self.last(machine).reset, telemetry.SOFTWARE)

    def test_memo_is_not_where_the_boot_rom_writes(self) -> None:
        # It keeps what it boots from the third of the watchdog's scratch registers on.
        written = {entry.address for entry in self.after_set_up().log.entries if entry.is_write}
        kept = {at for at in written if WATCHDOG.SCRATCH0 <= at < WATCHDOG.SCRATCH0 + 0x20}
        self.assertEqual(kept, {WATCHDOG.SCRATCH0, WATCHDOG.SCRATCH1})
