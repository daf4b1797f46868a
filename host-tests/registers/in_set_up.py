"""Before the first tick: what a board's set-up must have done, whichever chip it is."""

from __future__ import annotations

from bench import A_WHILE, OF_PANIC, Bench
from machine import STOPS

# What the boards' settings and READMEs say.
RATE, BAUD = 4_000, 500_000


class InSetUp(Bench):
    """Set-up."""

    # s. Before the window opens the watchdog must not be fed; 0 where the chip has none.
    WATCHDOG, WINDOW = 0.020, 0.001

    def test_enable_lines_are_low_outputs_before_anything_else_of_the_motors(self) -> None:
        machine = self.after_set_up()
        log, chip = machine.log, machine.chip
        self.assertEqual(set(log.enables[0][1]), {None}, "reset leaves them to the board")
        low = next(index for index, levels in log.enables if set(levels) == {0})
        of_motors = [entry for entry in log.entries if chip.is_of_motors(entry)]
        self.assertTrue(of_motors)
        early = [entry for entry in of_motors if entry.index < low and not chip.is_of_enables(entry)]
        self.assertEqual([log.show(entry) for entry in early if not entry.is_lost], [])

    def test_no_enable_line_rises_in_set_up(self) -> None:
        for pressed in (False, True):
            machine = self.started(pressed, power=True)
            self.assert_never_high(machine)
            self.assertEqual(set(machine.chip.enable_lines()), {0})

    def test_watchdog_runs_before_the_first_tick_can_come(self) -> None:
        machine = self.after_set_up()
        self.assertAlmostEqual(machine.chip.watchdog_seconds(), self.WATCHDOG, delta=0.01 * self.WATCHDOG)
        self.assertLess(machine.chip.watchdog_started(), len(machine.log.entries) - 1)

    def test_watchdog_is_fed_only_while_ticks_go_on(self) -> None:
        machine = self.after_set_up()
        machine.ticks(A_WHILE)
        fed = machine.chip.feeds()
        machine.ticks(A_WHILE)
        # Every eighth tick, and as much again is left.
        self.assertGreater(machine.chip.feeds() - fed, A_WHILE // 16)
        machine.run(20_000)
        fed = machine.chip.feeds()
        machine.run(200_000)
        self.assertEqual(machine.chip.feeds(), fed)

    def test_watchdog_is_fed_within_its_window_alone(self) -> None:
        machine = self.after_set_up()
        if self.WINDOW:
            self.assertAlmostEqual(machine.chip.watchdog_window(), self.WINDOW, delta=0.15 * self.WINDOW)
        fed, last = machine.chip.feeds(), 0
        for tick in range(1, A_WHILE):
            # Main has most of a period, as on the chip: cut off early, between its look at the ticks and its feeding, it
            # would feed a whole period later, and the next time a period too soon.
            machine.ticks(1, between=10_000)
            now = machine.chip.feeds()
            if now > fed:
                self.assertEqual(now, fed + 1)
                # An oscillator may be a tenth fast, and main feeds some turns after the tick: half of the time is left.
                self.assertGreater((tick - last) / RATE, 2 * self.WINDOW * 0.99)
                fed, last = now, tick
        self.assertGreater(last, 0)

    def test_nothing_can_delay_the_tick(self) -> None:
        machine = self.after_set_up()
        self.assertEqual(machine.priority(machine.chip.TICK), 0)
        self.assertEqual(machine.unmasked(), [machine.chip.TICK])
        self.assertFalse(machine.is_masked())

    def test_rate_comes_of_the_clock_as_it_was_set(self) -> None:
        machine = self.after_set_up()
        # A timer may count one more: the rate is then a cycle in some ten thousand off, and crystals are no better.
        self.assertAlmostEqual(machine.chip.tick_rate(), RATE, delta=1e-4 * RATE)
        machine.ticks(A_WHILE)
        self.assertEqual(self.last(machine).clock, machine.chip.counter_clock(), "what the records count in")

    def test_serial_port_has_its_rate(self) -> None:
        # A frame of ten bits is understood while its last bit is met: both ends together may be off by 5 %.
        self.assertAlmostEqual(self.after_set_up().chip.baud(), BAUD, delta=0.02 * BAUD)

    def test_no_peripheral_is_touched_before_it_has_its_clock(self) -> None:
        machine = self.while_driving()
        lost = {machine.chip.name(entry.address) for entry in machine.log.entries if entry.is_lost}
        self.assertEqual(lost, self.BOARD.LOST)

    def test_set_points_rest_until_they_are_driven(self) -> None:
        machine = self.after_set_up()
        self.assertEqual(machine.chip.widths(), [0, 0, 0])
        machine.ticks(1)
        self.assert_set_points_rest(machine)

    def test_clock_that_disagrees_with_another_of_the_chip_stops(self) -> None:
        # More than a fifth either way, within a tenth of a second.
        for share in (0.7, 1.4):
            machine = self.after_set_up()
            machine.chip.slow = share
            for _ in range(RATE // 10):
                if not machine.is_masked():
                    machine.ticks(1)
            machine.run(STOPS)
            self.assertTrue(machine.is_masked(), share)
            self.assert_memo(machine, OF_PANIC)

    def test_no_debugger_stops_the_counter_that_supervises_ticks(self) -> None:
        self.assertTrue(self.after_set_up().chip.counts_at_a_halt())

    def test_watchdog_bites_at_a_breakpoint_too(self) -> None:
        # The motors would go on as they were driven last.
        self.assertFalse(self.after_set_up().chip.waits_for_debugger())
