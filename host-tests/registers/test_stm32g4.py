"""The Nucleo-G474RE, beyond what every board must do."""

from __future__ import annotations

import math
import unittest

import telemetry
import unicorn
from at_resets import AtResets
from at_stops import AtStops
from bench import A_WHILE, OF_PANIC
from in_force import InForce
from in_set_up import InSetUp
from nucleo import Nucleo
from on_stack import OnStack
from stm32g4 import (
    ADC1, ADCAL, ADEN, ADVREGEN, CATCHES, CAUGHT, DAMAGE, DBGMCU, DELIVERED, FLASH, GPIO, IWDG_STOP, LOCKUP, MOE, NRST_STOP,
    OSSI, PARITY, PWR, RCC, SRAM_PE, SUPPLY, TIM1, TIM2, TIM3, TIM4,
)  # fmt: skip


# Half-words of code, more than set-up has.
LONG_SET_UP = 1_000_000


class Stm32g4(InSetUp, OnStack, InForce, AtResets, AtStops, unittest.TestCase):
    BOARD, NAME = Nucleo, "stm32g4"

    def test_power_interface_has_its_clock_before_the_boost_is_set(self) -> None:
        log = self.after_set_up().log
        boost = log.first(PWR.CR5, lambda value: not value & 1 << 8)
        set_at = log.first(RCC.APB1ENR1, lambda value: value & 1 << 28)
        read_back = log.first(RCC.APB1ENR1, lambda value: value & 1 << 28, write=False)
        self.assertLess(set_at, read_back)
        # Nothing of it is touched before: "after the enable bit is set, there is a delay of two clock cycles".
        touched = [entry.index for entry in log.entries if PWR.base <= entry.address < PWR.base + 0x400]
        self.assertLess(read_back, touched[0])
        self.assertIn(boost, touched)

    def test_boost_and_wait_states_come_before_170_megahertz(self) -> None:
        machine = self.after_set_up()
        log, clock = machine.log, machine.chip.core_clock
        switch = log.first(RCC.CFGR, lambda value: value & 3 == 3)
        # RM0440, "Dynamic voltage scaling management": the boost, half the clock at first.
        self.assertFalse(log.value(PWR.CR5, switch) & 1 << 8)
        # "Number of wait states according to CPU clock": in boost mode four reach 170 MHz.
        self.assertEqual(log.value(FLASH.ACR, switch) & 0xF, 4)
        self.assertEqual(clock(switch + 1), 85e6)
        whole = log.first(RCC.CFGR, lambda value: value & 0xF3 == 3)
        # A microsecond at half the clock; a half-word of code takes a cycle or more.
        self.assertGreater(log.entries[whole].time - log.entries[switch].time, 85)
        self.assertEqual(clock(), 170e6)

    def test_dead_battery_pull_downs_are_off_before_the_pins_are_used(self) -> None:
        log = self.after_set_up().log
        off = log.first(PWR.CR3, lambda value: value & 1 << 14)
        # What is on PA9 and PA10 pulls at PB6 and PB4.
        used = log.first(GPIO["B"].MODER, lambda value: value >> 12 & 3 == 2)
        set_points = log.first(GPIO["A"].MODER, lambda value: value >> 18 & 3 == 2)
        self.assertLess(off, min(used, set_points))

    def test_set_points_have_2_khz(self) -> None:
        chip = self.after_set_up().chip
        self.assertEqual(chip.timer_clock() / (chip.word(TIM1.PSC) + 1) / (chip.word(TIM1.ARR) + 1), 2_000)

    def test_encoders_are_filtered_and_count_every_edge(self) -> None:
        machine = self.after_set_up()
        for timer in (TIM2, TIM3, TIM4):
            # Both channels: mapped to their own inputs, and eight samples at an eighth of the clock have to agree.
            self.assertEqual(machine.chip.word(timer.CCMR1), 0b1001_00_01_1001_00_01)
            self.assertEqual(machine.chip.word(timer.SMCR) & 7, 3)
            self.assertEqual(machine.chip.word(timer.CR1) & 1, 1)
            self.assertLess(machine.log.first(timer.CCMR1), machine.log.first(timer.CR1))

    def test_counts_are_caught_at_index_marks_through_pins_that_are_pulled_down(self) -> None:
        machine = self.after_set_up()
        chip = machine.chip
        for timer, enable, port, pin in ((TIM2, 8, "B", 10), (TIM3, 8, "C", 8), (TIM4, 12, "B", 9)):
            # Channels 3 and 4 take their own inputs, filtered like the others; one of them is on, at rising edges.
            self.assertEqual(chip.word(timer.CCMR2), 0b1001_00_01_1001_00_01)
            self.assertEqual(chip.word(timer.CCER), 1 << enable)
            self.assertEqual(chip.mode(port, pin), 2)
            self.assertEqual(chip.word(GPIO[port].PUPDR) >> 2 * pin & 3, 2)

    def test_mark_that_was_passed_is_read_once_in_the_next_tick(self) -> None:
        for caught, timer in CAUGHT.items():
            machine = self.once_homed()
            chip = machine.chip
            chip.pass_mark(caught)
            since = len(machine.log.entries)
            machine.ticks(3)
            reads = [entry for entry in machine.log.entries[since:] if entry.address in CAUGHT]
            self.assertEqual([entry.address for entry in reads], [caught])
            self.assertFalse(chip.word(timer.SR) & CATCHES[caught])

    def test_converter_has_a_clock_that_it_takes_and_is_calibrated(self) -> None:
        machine = self.after_set_up()
        mode = machine.chip.word(ADC1.CCR) >> 16 & 3
        self.assertNotEqual(mode, 0, "the clock is the bus's, divided by 1, 2 or 4")
        # Data sheet DS12288, "ADC characteristics": 60 MHz, of a converter that works alone.
        self.assertLessEqual(machine.chip.core_clock() / (1, 2, 4)[mode - 1], 60e6)
        writes = machine.log.writes(ADC1.CR)
        regulator, calibrates, on = (
            next(entry.time for entry in writes if entry.written >> bit & 1) for bit in (ADVREGEN, ADCAL, ADEN)
        )
        # 20 µs for the regulator ("ADC voltage regulator"); calibrated before it is on ("Calibration").
        self.assertGreater(calibrates - regulator, 20e-6 * machine.chip.core_clock())
        self.assertLess(calibrates, on)

    # What ends the set-points without the program.

    def test_break_is_tried_in_set_up_and_one_that_does_not_work_drives_nothing(self) -> None:
        machine = self.after_set_up()
        self.assertTrue([entry for entry in machine.log.writes(TIM1.EGR) if entry.written >> 7 & 1])
        self.assertTrue(machine.chip.word(TIM1.BDTR) >> MOE & 1, "it is taken back")
        machine = self.new_machine()
        machine.reset(power=True)
        machine.chip.ends_widths = False
        machine.run(LONG_SET_UP)
        self.assertTrue(machine.is_masked())
        self.assert_memo(machine, OF_PANIC)
        self.assert_never_high(machine)

    def test_option_bytes_by_which_the_watchdog_stands_still_in_stop_mode_drive_nothing(self) -> None:
        machine = self.new_machine()
        machine.reset(power=True)
        machine.chip.keep(FLASH.OPTR, DELIVERED & ~IWDG_STOP)
        machine.run(LONG_SET_UP)
        self.assertTrue(machine.is_masked())
        self.assertTrue(machine.chip.light())
        self.assert_memo(machine, OF_PANIC)
        self.assert_never_high(machine)
        # Where that mode resets the chip, a watchdog has nothing to do in it.
        machine = self.new_machine()
        machine.reset(power=True)
        machine.chip.keep(FLASH.OPTR, DELIVERED & ~IWDG_STOP & ~NRST_STOP)
        machine.set_up()
        self.assertTrue(self.drive_again(machine))

    def test_core_that_locks_up_damaged_memory_and_a_falling_supply_end_the_set_points(self) -> None:
        for failure in (LOCKUP, PARITY, SUPPLY, DAMAGE):
            machine = self.while_driving()
            self.assertTrue(all(machine.chip.widths()))
            machine.chip.fail(failure)
            self.assertEqual(machine.chip.widths(), [0, 0, 0])
        # The detector of the supply is on, at 2.9 V ("PWR_CR2").
        self.assertEqual(machine.chip.word(PWR.CR2) & 0xF, 6 << 1 | 1)

    def test_debugger_that_halts_the_core_ends_the_set_points(self) -> None:
        chip = self.after_set_up().chip
        # "Debug mode": with DBG_TIM1_STOP outputs are off as if by MOE, and low with OSSI.
        self.assertTrue(chip.word(DBGMCU.APB2FZR) >> 11 & 1)
        self.assertTrue(chip.word(TIM1.BDTR) >> OSSI & 1)

    def test_stop_loop_at_the_break_input_ends_the_set_points_between_two_ticks(self) -> None:
        machine = self.while_driving()
        machine.chip.levels["B", 12] = 1
        machine.chip.fail()
        self.assertEqual(machine.chip.widths(), [0, 0, 0])
        machine.ticks(1)
        self.assertFalse(self.drives(machine))
        del machine.chip.levels["B", 12]
        machine.ticks(A_WHILE)
        self.assertTrue(self.drives(machine), "a pulse that is over")
        machine.chip.levels["B", 12] = 1
        machine.chip.fail()
        machine.ticks(A_WHILE)
        del machine.chip.levels["B", 12]
        machine.ticks(A_WHILE)
        self.assertFalse(self.drives(machine))
        self.assertEqual(self.last(machine).phase, telemetry.FAULT)

    def test_supply_is_sampled_long_enough_for_its_divider(self) -> None:
        chip = self.after_set_up().chip
        self.assertEqual(chip.word(ADC1.SQR1) >> 6 & 0x1F, 12, "PB1")
        # Half a step of 12 bits is ln 8192 time constants of the divider, the switch (1 kΩ) and some 10 pF.
        settles = math.log(8_192) * (1 / (1 / 100e3 + 1 / 10e3) + 1e3) * 10e-12
        cycles = (2.5, 6.5, 12.5, 24.5, 47.5, 92.5, 247.5, 640.5)[chip.word(ADC1.SMPR2) >> 6 & 7]
        self.assertGreater(cycles / (chip.core_clock() / 4), 2 * settles)

    def test_memory_whose_parity_is_checked_is_not_read_before_it_is_written(self) -> None:
        machine = self.new_machine()
        machine.reset(power=True)
        machine.chip.keep(FLASH.OPTR, machine.chip.RESET[FLASH.OPTR] & ~SRAM_PE)
        memo = self.image.symbol("stm32g44MEMO")
        accesses = []
        machine.unicorn.hook_add(
            unicorn.UC_HOOK_MEM_READ | unicorn.UC_HOOK_MEM_WRITE,
            lambda _uc, kind, address, *_: accesses.append((kind, address)),
            begin=memo, end=memo + 7,
        )  # fmt: skip
        machine.set_up()
        for word in (memo, memo + 4):
            kind = next(kind for kind, address in accesses if address == word)
            self.assertEqual(kind, unicorn.UC_MEM_WRITE)

    def test_reset_that_was_asked_for_is_told(self) -> None:
        self.assert_is_told(telemetry.SOFTWARE, software=True)

    def test_window_watchdog_is_a_program_that_hung(self) -> None:
        self.assert_is_told(telemetry.WATCHDOG, window=True)
