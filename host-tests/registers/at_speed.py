"""The fastest loop of a board, with all protection on."""

from __future__ import annotations

import telemetry
from bench import A_WHILE
from supervised import Supervised


class AtSpeed(Supervised):
    """Rate, lateness, the watchdog, and times that count ticks."""

    # s. Before the window opens the watchdog must not be fed; 0 where the chip has none.
    WINDOW = 0.001

    def test_period_is_that_of_the_rate(self) -> None:
        # A timer may count one more of 1,875.
        self.assertAlmostEqual(self.after_set_up().chip.tick_rate(), self.BOARD.RATE, delta=6e-4 * self.BOARD.RATE)

    def test_force_comes_by_homing_and_a_press(self) -> None:
        self.assertTrue(self.drives(self.while_driving()))

    def test_late_tick_takes_the_enable_lines_down_in_that_tick(self) -> None:
        machine = self.while_driving()
        self.assertTrue(self.drives(machine))
        machine.late = 2 * machine.chip.PERIOD
        self.show("a late tick", self.milliseconds_until_off(machine))
        self.assertEqual(machine.late, 0, "the tick looked at the clock again")
        self.wait(machine, A_WHILE)
        self.assertEqual(self.last(machine).phase, telemetry.FAULT)

    def test_watchdog_is_fed_within_its_window_beside_the_ticks(self) -> None:
        machine = self.once_homed()
        fed, last, times, longest = machine.chip.feeds(), 0, [], 0
        for tick in range(1, machine.chip.RATE // 40):
            began = machine.time
            machine.ticks(1, between=1)
            longest = max(longest, machine.time - began)
            # What the tick leaves of the period is main's; a half-word of code takes up to two cycles.
            machine.run(max(200, (machine.chip.PERIOD - 2 * longest) // 2))
            if machine.chip.feeds() > fed:
                self.assertEqual(machine.chip.feeds(), fed + 1)
                times.append((tick - last) / machine.chip.RATE)
                fed, last = fed + 1, tick
        print(f"{self.NAME}: a tick runs {longest} half-words of code at most, in {machine.chip.PERIOD} cycles")
        # Half of its time is left, and the window is open for as long again.
        self.assertGreater(min(times[1:]), 2 * self.WINDOW * 0.95)
        self.assertLess(max(times), machine.chip.watchdog_seconds() / 2)

    def test_press_of_less_than_half_a_millisecond_asks_for_no_force(self) -> None:
        # 0.5 ms as at 4 kHz, and two periods of a width, 1 ms, before amplifiers are enabled.
        for seconds, drives in ((0.000_45, False), (0.002, True)):
            machine = self.once_homed()
            machine.chip.press(enable=True)
            machine.ticks(int(seconds * machine.chip.RATE))
            self.assertEqual(self.drives(machine), drives, seconds)
