"""The stack: how deep it has been, and what lies under it."""

from __future__ import annotations

import unicorn
from unicorn import arm_const as arm
from bench import Bench
from core import NOISE, Stuck
from machine import HARD_FAULT, INTERRUPTS, NMI, Machine

# What the core pushes of its floating-point registers, which Unicorn's exceptions leave out: for each of the three that
# can lie on each other.
FLOATS = 3 * 72
# What is to be left, as a share of all: an upload, which is not run here, goes deeper than what is.
LEFT = 0.25
# Bytes under the stack that there are for a test.
UNDER = 0x1000


class OnStack(Bench):
    """The stack."""

    def stack(self) -> tuple[int, int]:
        """Where the memory begins that the stack is in, and where the stack does, which grows down."""
        top = self.image.symbol("_stack_start")
        [start] = [start for start, size in self.BOARD.MEMORY if start < top <= start + size]
        return start, top

    def deepest(self, machine: Machine) -> int:
        """The lowest address that anything on the stack ever had."""
        start, top = self.stack()
        return start + next(index for index, byte in enumerate(machine.memory(start, top - start)) if byte != NOISE)

    def test_nothing_that_is_kept_lies_under_the_stack(self) -> None:
        start, top = self.stack()
        # Some linker scripts place the stack like a variable.
        placed = [(first, size) for first, size in self.image.placed if (first, size) != (start, top - start)]
        kept = [(first, size) for first, size in placed if first < top and start < first + size]
        self.assertEqual(kept, [], "a stack that grows too deep stops the core before it spoils anything")

    def test_stack_has_room_left_when_all_that_can_is_on_it(self) -> None:
        machine = self.while_driving()
        machine.stop_when = machine.chip.is_acknowledged
        machine.exception(INTERRUPTS + machine.chip.TICK, returns=None)
        machine.exception(HARD_FAULT, returns=False)
        machine.exception(NMI, returns=False)
        start, top = self.stack()
        left = self.deepest(machine) - FLOATS - start
        self.assertGreater(left, LEFT * (top - start), f"{top - start} bytes")

    # Instructions after which the board has tested its memory.
    TESTED = 500_000

    def test_bit_of_memory_that_sticks_keeps_the_program_from_starting(self) -> None:
        start, top = self.stack()
        machine = self.new_machine()
        machine.reset(power=True)
        machine.run(self.TESTED)
        self.assertTrue(machine.log.entries, "without a fault it has gone on by then")
        places = (start, top - 4, self.image.symbol("__ebss") - 4)
        for place in places:
            for bit, level in ((0, 0), (13, 1)):
                with self.subTest(place=hex(place), bit=bit, level=level):
                    machine = self.new_machine()
                    machine.reset(power=True)

                    def sticks(uc, _access, at, _size, _value, _data, bit=bit, level=level) -> None:
                        word = int.from_bytes(uc.mem_read(at, 4), "little") & ~(1 << bit) | level << bit
                        uc.mem_write(at, word.to_bytes(4, "little"))

                    machine.unicorn.hook_add(unicorn.UC_HOOK_MEM_READ, sticks, begin=place, end=place)
                    machine.run(self.TESTED)
                    self.assert_did_not_start(machine)

    def assert_did_not_start(self, machine: Machine) -> None:
        self.assertEqual(machine.log.entries, [], "nothing but memory was touched")

    def test_stack_that_overflows_stops_the_core(self) -> None:
        machine = self.while_driving()
        start, _ = self.stack()
        # A core with a limit of its own stops before anything is touched, whatever lies under the stack.
        has_limit = self.BOARD.CORE == arm.UC_CPU_ARM_CORTEX_M33
        if has_limit:
            machine.unicorn.mem_map(start - UNDER, UNDER)
        # Just enough for what the core pushes before the tick.
        machine.set_registers(SP=start + 64)
        try:
            with self.assertRaises((Stuck, unicorn.UcError)):
                machine.exception(INTERRUPTS + machine.chip.TICK)
        finally:
            if has_limit:
                machine.unicorn.mem_unmap(start - UNDER, UNDER)
