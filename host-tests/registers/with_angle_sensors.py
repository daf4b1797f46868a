"""Boards with AS5047P sensors: how they are asked, and what happens when one does not answer."""

from __future__ import annotations

import telemetry
from angle_sensor import WEAK
from bench import A_WHILE
from in_force import InForce

# The sensor's data sheet, "SPI timing", s: from the select line's fall to the first clock, and high between two
# frames. Its greatest clock, Hz, and how long it takes to power up, s ("System parameters").
SET_UP, HIGH, CLOCK, POWER_UP = 350e-9, 350e-9, 10e6, 10e-3
# So many ticks show a select line that is taken up again and again.
TICKS = 8
# Two bad frames in a row are bridged.
BRIDGED = 2
# Equal readings after which a sensor is frozen.
FROZEN = 1_000


class WithAngleSensors(InForce):
    """Sensors."""

    def edges(self) -> list[tuple[str, float]]:
        """What happens on the sensors' bus in set-up and some ticks, and how long the program waited before it, s: by
        the core's own counter, for how long instructions take is not known."""
        machine = self.after_set_up()
        machine.ticks(TICKS)
        found, waited = [], 0
        for entry in machine.log.entries:
            waited += entry.waited
            what = machine.chip.of_sensors(entry)
            if what is not None:
                found.append((what, waited / machine.chip.core_clock()))
                waited = 0
        return found

    def assert_times(self, first: str, then: str, least: float) -> None:
        edges = self.edges()
        times = [waited for (a, _), (b, waited) in zip(edges, edges[1:]) if (a, b) == (first, then)]
        self.assertGreater(len(times), 12)
        self.assertGreaterEqual(min(times), least)

    def test_sensors_are_not_asked_before_they_have_powered_up(self) -> None:
        edges = self.edges()
        first = next(index for index, (what, _) in enumerate(edges) if what == "falls")
        self.assertGreaterEqual(sum(waited for _, waited in edges[: first + 1]), POWER_UP)

    def test_sensors_bus_is_no_faster_than_they_are(self) -> None:
        self.assertLessEqual(self.after_set_up().chip.sensor_clock(), CLOCK)

    def test_select_line_is_low_for_350_ns_before_the_first_clock(self) -> None:
        self.assert_times("falls", "byte", SET_UP)

    def test_select_line_is_high_for_350_ns_between_two_frames(self) -> None:
        self.assert_times("rises", "falls", HIGH)

    def test_select_line_is_low_for_half_a_clock_after_the_last(self) -> None:
        self.assert_times("byte", "rises", 0.5 / self.after_set_up().chip.sensor_clock())

    def test_every_frame_has_a_select_line_of_its_own(self) -> None:
        order = [what for what, _ in self.edges() if what != "byte"]
        frames = order[order.index("falls") :]
        self.assertEqual(set(order[: order.index("falls")]), {"rises"}, "set-up leaves all high")
        self.assertEqual(frames, ["falls", "rises"] * (len(frames) // 2))

    def test_silent_sensor_stops_in_the_third_tick(self) -> None:
        sensors = (f"sensor {number + 1}" for number in range(self.BOARD.SENSORS))
        self.assert_broken_line_stops_within(BRIDGED + 1, *sensors)

    def test_silent_sensor_whose_line_reads_low_near_angle_zero_stops_in_the_third_tick(self) -> None:
        for number in range(self.BOARD.SENSORS):
            machine = self.new_machine()
            machine.reset(power=True)
            machine.chip.silence = 0
            for sensor in machine.chip.sensors:
                sensor.angle = 0
            machine.set_up()
            self.assertTrue(self.drive_again(machine), "zero is an angle")
            machine.chip.break_line(f"sensor {number + 1}")
            self.assert_stops_within(machine, BRIDGED + 1)

    def test_magnet_that_falls_off_stops_in_the_fourth_tick(self) -> None:
        for number in range(self.BOARD.SENSORS):
            machine = self.while_driving()
            machine.chip.sensors[number].diagnostics = WEAK
            # The diagnostics of a reading come with the next.
            self.assert_stops_within(machine, BRIDGED + 2)
            machine.ticks(A_WHILE)
            self.assertEqual(self.last(machine).fault, telemetry.MAGNET)

    def test_frozen_sensor_stops_within_a_quarter_of_a_second(self) -> None:
        for number in range(self.BOARD.SENSORS):
            machine = self.while_driving()
            machine.chip.sensors[number].is_frozen = True
            machine.ticks(FROZEN // 2)
            self.assertTrue(self.drives(machine), "a joint is held still for as long")
            self.assert_stops_within(machine, FROZEN // 2 + BRIDGED + 2)
            machine.ticks(A_WHILE)
            self.assertEqual(self.last(machine).fault, telemetry.FROZEN)

    def test_bus_that_never_ends_a_frame_stops_in_the_third_tick_and_no_tick_is_long(self) -> None:
        machine = self.while_driving()
        machine.chip.finishes = False
        self.assert_stops_within(machine, BRIDGED + 1)
        machine.ticks(A_WHILE)
        record = self.last(machine)
        self.assertEqual(record.fault, telemetry.FRAME_LOST)
        print(f"{self.NAME}: a bus that never ends a frame: a tick of at least {record.took / record.clock * 1e6:.0f} µs")

    def test_silent_sensor_at_power_on_keeps_force_away(self) -> None:
        machine = self.new_machine()
        machine.reset(power=True)
        machine.chip.break_line(f"sensor {self.BOARD.SENSORS}")
        machine.set_up()
        self.assertFalse(self.drive_again(machine))
        self.assert_never_high(machine)
        self.assertEqual(self.last(machine).phase, telemetry.FAULT)
