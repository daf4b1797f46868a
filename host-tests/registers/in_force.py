"""Force, and what keeps or takes it away: whatever breaks stops, and nothing but a person's press begins it."""

from __future__ import annotations

import telemetry
from bench import A_WHILE, HELD, HOMING
from machine import Machine
from supervised import Supervised

# A supply is too low once it was so for four ticks: one reading may be noise. One that is too high holds at once.
SUPPLY_TICKS = 4


class InForce(Supervised):
    """Force."""

    def ready(self) -> list[str]:
        """All ready lines."""
        return [f"ready {number + 1}" for number in range(self.BOARD.AMPLIFIERS)]

    # Nothing moves by itself.

    def assert_no_force_until_released_and_pressed(self, **reset: bool) -> None:
        machine = self.started(pressed=True, **reset)
        machine.ticks(HOMING)
        self.assert_never_high(machine)
        machine.chip.press(enable=False)
        machine.ticks(A_WHILE)
        self.assertTrue(self.drive_again(machine))
        self.assertEqual(self.last(machine).phase, self.DRIVING)

    def test_enable_held_at_power_on_moves_nothing_until_released_and_pressed(self) -> None:
        self.assert_no_force_until_released_and_pressed(power=True)

    def test_enable_held_at_a_reset_by_the_pin_moves_nothing_until_released_and_pressed(self) -> None:
        self.assert_no_force_until_released_and_pressed(**self.BOARD.BY_PIN)

    def test_force_comes_back_only_once_enable_was_let_go_of(self) -> None:
        machine = self.while_driving()
        machine.chip.press(stop=True)
        machine.ticks(1)
        self.assertFalse(self.drives(machine))
        since = len(machine.log.entries)
        machine.chip.press(stop=False)
        machine.ticks(A_WHILE)
        self.assert_never_high(machine, since)
        self.assertTrue(self.last(machine).hold & telemetry.RELEASE_FIRST)
        machine.chip.press(enable=False)
        machine.ticks(A_WHILE)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        self.assertTrue(self.drives(machine))

    def test_button_that_is_held_from_power_on_and_chatters_moves_nothing(self) -> None:
        machine = self.started(pressed=True, power=True)
        for released in (1, 2, 20):
            for _ in range(3):
                machine.chip.press(enable=False)
                machine.ticks(released)
                machine.chip.press(enable=True)
                machine.ticks(4)
        machine.ticks(HOMING)
        self.assert_never_high(machine)
        self.assertTrue(self.last(machine).hold & telemetry.RELEASE_FIRST)

    # What breaks while the motors are driven stops them.

    def assert_stops_within(self, machine: Machine, ticks: int) -> None:
        """The enable lines are low and the set-points at rest, whatever they were."""
        self.assertTrue(self.drives(machine))
        machine.ticks(ticks - 1)
        machine.chip.spoil_widths()
        machine.ticks(1)
        self.assertFalse(self.drives(machine))
        self.assert_set_points_rest(machine)

    def assert_broken_line_stops_within(self, ticks: int, *lines: str) -> None:
        for line in lines:
            with self.subTest(line):
                machine = self.while_driving()
                machine.chip.break_line(line)
                self.assert_stops_within(machine, ticks)

    def test_button_let_go_of_stops_in_the_same_tick(self) -> None:
        machine = self.while_driving()
        machine.chip.press(enable=False)
        self.assert_stops_within(machine, 1)

    def test_broken_button_wire_stops_in_the_same_tick(self) -> None:
        self.assert_broken_line_stops_within(1, "button")

    def test_stop_pressed_or_its_wire_broken_stops_in_the_same_tick(self) -> None:
        self.assert_broken_line_stops_within(1, "stop")

    def test_broken_ready_wire_of_any_amplifier_stops_in_the_same_tick(self) -> None:
        self.assert_broken_line_stops_within(1, *self.ready())

    def assert_supply_stops(self, volts: float, within: int) -> None:
        machine = self.while_driving()
        machine.chip.volts = volts
        self.assert_stops_within(machine, within)
        self.assertTrue(self.drives_again_with_supply(machine), "it is a hold, no fault")

    def drives_again_with_supply(self, machine: Machine) -> bool:
        _, machine.chip.volts, _ = self.BOARD.SUPPLY_RANGE
        machine.chip.press(enable=False)
        # A hold of the supply lasts for 25 ms more, and the button must be up for as long.
        machine.ticks(HELD)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        return self.drives(machine)

    def test_supply_below_its_range_stops_within_four_ticks(self) -> None:
        self.assert_supply_stops(self.BOARD.SUPPLY_RANGE[0], SUPPLY_TICKS)

    def test_supply_above_its_range_stops_in_the_same_tick(self) -> None:
        self.assert_supply_stops(self.BOARD.SUPPLY_RANGE[2], 1)

    def test_late_tick_takes_the_enable_lines_down(self) -> None:
        machine = self.while_driving()
        machine.late = 2 * machine.chip.PERIOD
        self.assert_stops_within(machine, 1)
        self.assertEqual(machine.late, 0, "the tick looked at the clock again")

    # The converter of the supply.

    def test_converter_that_measures_its_own_reference_wrong_stops_within_five_ticks(self) -> None:
        # What is read in a tick may have been converted in the one before.
        machine = self.while_driving()
        machine.chip.reference = round(machine.chip.reference * machine.chip.IMPLAUSIBLE)
        self.assert_stops_within(machine, SUPPLY_TICKS + 1)

    def test_conversion_that_never_ends_stops_within_five_ticks(self) -> None:
        machine = self.while_driving()
        machine.chip.converts = False
        self.assert_stops_within(machine, SUPPLY_TICKS + 1)

    # What is broken before is not driven at all.

    def assert_is_never_driven(self, machine: Machine, hold: int) -> None:
        since = len(machine.log.entries)
        machine.ticks(A_WHILE)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        self.assert_never_high(machine, since)
        self.assertTrue(self.last(machine).hold & hold)

    def assert_is_never_driven_without(self, hold: int, *lines: str) -> None:
        for line in lines:
            with self.subTest(line):
                machine = self.once_homed()
                machine.chip.break_line(line)
                self.assert_is_never_driven(machine, hold)

    def test_stop_pressed_or_its_wire_broken_keeps_force_away(self) -> None:
        self.assert_is_never_driven_without(telemetry.STOP, "stop")

    def test_broken_ready_wire_of_any_amplifier_keeps_force_away(self) -> None:
        self.assert_is_never_driven_without(telemetry.NOT_READY, *self.ready())

    def test_supply_out_of_its_range_keeps_force_away(self) -> None:
        too_low, _, too_high = self.BOARD.SUPPLY_RANGE
        for volts in (too_low, too_high):
            with self.subTest(volts):
                machine = self.once_homed()
                machine.chip.volts = volts
                self.assert_is_never_driven(machine, telemetry.SUPPLY)
