"""The knob on the Nucleo-G474RE, beyond what every board must do. What it does while it is driven is its alignment,
which is driven as soon as the button is pressed."""

from __future__ import annotations

import math
import re
import struct
import unittest

import telemetry
import unicorn
from at_resets import AtResets
from at_stops import AtStops
from bench import A_WHILE
from in_set_up import InSetUp
from machine import NMI, Machine
from on_stack import OnStack
from shield import Shield
from stm32g4 import BANK_2, BANK_SIZE, BK_ECC, DBANK, DELIVERED, ECCD, FLASH, GPIO, IWDG, FEEDS, PAGE, PWR, SPI1, STRT
from with_angle_sensors import WithAngleSensors
from with_host import HELLO, WIRE

# Ticks in which the alignment's field comes up, and in which it goes round.
LED, TURN = 800, 2_200


# A part of a feel that this motor bears, a damping of 1 mN·m·s/rad, and the page's own frame to keep the feel.
PART = telemetry.framed(bytes([6, 0xAF, 2, 12, 5]) + struct.pack("<f", 1e-3))
KEEP = bytes.fromhex(re.search(r"## HostMessage: keep the feel\n.*?Frame: `(.*?)`", WIRE.read_text(), re.DOTALL)[1])
# The host's own feel comes after the table's; what became of the stored one (docs/reference/wire.md, "Dial").
OWN, NOTHING_KEPT, USED, REFUSED = 6, 0, 1, 2
# Why nothing is kept (docs/reference/wire.md, "Answer"): no flash, the motor is driven.
NO_FLASH, DRIVEN = 0, 2


class Knob(InSetUp, OnStack, WithAngleSensors, AtResets, AtStops, unittest.TestCase):
    BOARD, NAME = Shield, "knob"
    DRIVING, HAS_LIGHT = telemetry.CALIBRATE, False
    # Erasing a page of flash takes up to 25 ms.
    WATCHDOG = 0.040

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

    # A feel that is kept.

    def with_flash(self, page: bytes = b"", options: int = DELIVERED) -> Machine:
        """A board at its first tick whose flash has two banks, the second erased but for this."""
        machine = self.new_machine()
        machine.unicorn.mem_write(BANK_2, page + b"\xff" * (BANK_SIZE - len(page)))
        machine.reset(power=True)
        machine.chip.keep(FLASH.OPTR, options)
        machine.chip.watch_flash()
        machine.set_up()
        return machine

    def says(self, machine: Machine, frame: bytes, ticks: int = A_WHILE) -> list[bytes]:
        """What the board answers to a frame."""
        before = len(self.told(machine, telemetry.ANSWER))
        machine.chip.received += frame
        machine.ticks(ticks)
        return self.told(machine, telemetry.ANSWER)[before:]

    def told(self, machine: Machine, kind: int) -> list[bytes]:
        """What the board has said of a kind."""
        return [message for message in telemetry.messages(bytes(machine.chip.sent)) if message[0] == kind]

    def kept(self, machine: Machine) -> tuple[int, int]:
        """The active feel, and what became of the stored one."""
        self.says(machine, HELLO)
        dial = self.told(machine, telemetry.DIAL)[-1]
        # The last bytes: feel, detent, end stop, kept.
        return dial[-4], dial[-1]

    def confirmed(self, machine: Machine) -> bytes:
        """A person confirms; the answer."""
        self.assertEqual(self.says(machine, KEEP), [], "it waits for a person")
        machine.chip.press(enable=True)
        machine.ticks(2_100)
        self.assertNotIn(STRT, [entry.written & STRT for entry in machine.log.writes(FLASH.CR)], "not while it is held")
        machine.chip.press(enable=False)
        # Released, and the page is erased.
        [answer] = self.says(machine, b"", 3 * A_WHILE)
        return answer

    def test_feel_that_is_kept_is_used_after_power_was_off(self) -> None:
        # All that runs is in the first bank: none of it waits for the second.
        self.assertLessEqual(max(load + len(data) for load, data in self.image.segments if load < 0x1000_0000), BANK_2)
        machine = self.with_flash()
        self.assertEqual(self.kept(machine), (0, NOTHING_KEPT))
        [answer] = self.says(machine, PART)
        self.assertEqual(answer[-1], 0, "it is taken")
        answer = self.confirmed(machine)
        self.assertEqual(answer[-1], 0, "it is kept")
        self.assertEqual(machine.memory(BANK_2, 4), b"PFL1")
        self.assert_never_high(machine)
        self.assertNotEqual(self.last(machine).phase, telemetry.FAULT, "no tick was late, or took too long")
        # The watchdog's clock may be a tenth fast.
        fed = [entry.time for entry in machine.log.writes(IWDG.KR) if entry.written == FEEDS]
        longest = max(after - before for before, after in zip(fed, fed[1:])) / (4_000 * machine.chip.PERIOD)
        print(f"{self.NAME}: the watchdog waits for {longest * 1e3:.1f} ms at most while a feel is kept")
        self.assertLess(longest, 0.9 * self.WATCHDOG)

        # The power is off: nothing is left of RAM.
        machine = self.with_flash(machine.memory(BANK_2, PAGE))
        self.assertEqual(self.kept(machine), (OWN, USED))
        self.assertTrue(self.drive_again(machine))

    def test_feel_is_not_kept_while_the_button_is_held(self) -> None:
        machine = self.with_flash()
        self.says(machine, HELLO)
        self.says(machine, PART)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        self.assertTrue(self.drives(machine))
        [answer] = self.says(machine, KEEP)
        self.assertEqual(answer[-1], DRIVEN)
        self.assertTrue(self.drives(machine))
        self.assertEqual(machine.log.writes(FLASH.KEYR), [])

    def test_feel_that_is_damaged_or_of_another_version_leaves_the_table(self) -> None:
        page = self.recorded()
        self.assertEqual(self.kept(self.with_flash(page)), (OWN, USED))
        damaged = page[:20] + bytes([page[20] ^ 1]) + page[21:]
        for page in (damaged, b"PFL0" + page[4:], b"\0" * len(page)):
            self.assertEqual(self.kept(self.with_flash(page)), (0, REFUSED))

    def test_feel_that_cannot_be_read_leaves_the_table(self) -> None:
        # The power went while it was erased: the chip says so by an NMI ("Error code correction").
        machine = self.new_machine()
        machine.unicorn.mem_write(BANK_2, b"\xff" * BANK_SIZE)
        machine.reset(power=True)
        machine.chip.keep(FLASH.OPTR, DELIVERED)
        hook = machine.unicorn.hook_add(
            unicorn.UC_HOOK_MEM_READ, lambda uc, *_: uc.emu_stop(), begin=BANK_2, end=BANK_2 + PAGE - 1
        )
        machine.run(self.LONG)
        machine.unicorn.hook_del(hook)
        machine.chip.keep(FLASH.ECCR, ECCD | BK_ECC)
        machine.exception(NMI)
        machine.set_up()
        self.assertEqual(self.kept(machine), (0, REFUSED))
        self.assertTrue(self.drive_again(machine))

    def test_chip_of_one_bank_keeps_nothing(self) -> None:
        machine = self.with_flash(options=DELIVERED & ~DBANK)
        self.says(machine, HELLO)
        self.says(machine, PART)
        [answer] = self.says(machine, KEEP)
        self.assertEqual(answer[-1], NO_FLASH)

    def recorded(self) -> bytes:
        """The page of a kept feel."""
        machine = self.with_flash()
        self.says(machine, HELLO)
        self.says(machine, PART)
        self.confirmed(machine)
        return machine.memory(BANK_2, PAGE)

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
