"""The Nucleo-G474RE as its README wires it."""

from __future__ import annotations

import struct

from stm32g4 import (
    CATCHES, CAUGHT, DBGMCU, FEEDS, GPIO, IWDG, LSI, MOE, RCC, STARTS, TIM1, TIM2, TIM3, TIM4, TIM7, USART2, Stm32g4, peripheral,
)  # fmt: skip


class Nucleo(Stm32g4):
    """The board."""

    BUTTON, STOP, READY, LIGHT = ("C", 13), ("B", 0), (("C", 3), ("C", 4), ("C", 5)), ("A", 5)
    ENABLES = (("C", 0), ("C", 1), ("C", 2))
    # Timer, its registers for widths.
    WIDTHS = ((TIM1, TIM1.CCR1), (TIM1, TIM1.CCR2), (TIM1, TIM1.CCR3))
    # Ports of set-points, directions and enables.
    PORTS = "ABC"
    # TIM7 ("STM32G4 series vector table").
    TICK = 55
    # Cycles of a tick.
    PERIOD = 170_000_000 // 4_000
    # Memory has not faded when the flag of power-on goes up.
    BROWN_OUT, BY_PIN = {"power": True}, {}
    # The share of a width that is no current, as the amplifiers are configured.
    REST = 0.1
    # Before any clock is there only power is taken away, which counts after a reset of the core alone.
    LOST = {"GPIOC_BSRR", "TIM1_BDTR"}
    AMPLIFIERS = 3
    # V: too low, on, too high.
    SUPPLY_RANGE = (19.0, 24.0, 31.0)

    def reset(self, machine, **reasons: bool) -> None:
        super().reset(machine, **reasons)
        # V, and levels from outside: nothing is pressed, stop's contact is closed, amplifiers are ready.
        _, self.volts, _ = self.SUPPLY_RANGE
        self.levels = {self.BUTTON: 0, self.STOP: 0, **{line: 1 for line in self.READY}}
        self.counts = {TIM2.CNT: 0, TIM3.CNT: 0, TIM4.CNT: 0}

    def level_outside(self, port: str, pin: int) -> int | None:
        return self.levels.get((port, pin))

    def reading(self) -> int:
        """12 bits of 3.3 V, behind 100 kΩ and 10 kΩ."""
        return round(self.volts / 11 / 3.3 * 4_095)

    def count(self, address: int) -> int:
        return self.counts[address]

    def duties(self) -> list[float]:
        """What each amplifier makes of its pins: a width of 10 to 90 %, and a direction, high for ahead."""
        signs = (1 if self.level("B", 13 + channel) else -1 for channel in range(3))
        driven = all(self.enable_lines())
        return [driven * sign * (width - 0.1) / 0.8 for sign, width in zip(signs, self.widths())]

    def turn_encoder(self, channel: int, counts: int) -> None:
        """A joint stands at a count of the pose's."""
        self.counts[(TIM2.CNT, TIM3.CNT, TIM4.CNT)[channel]] = counts & 0xFFFF

    def pass_mark(self, caught: int) -> None:
        """A joint passes its index mark: its timer catches the count of that moment."""
        timer = CAUGHT[caught]
        self.keep(caught, self.counts[timer.CNT])
        self.keep(timer.SR, self.word(timer.SR) | CATCHES[caught])

    def press(self, enable: bool | None = None, stop: bool | None = None) -> None:
        """The buttons: the blue one gives a high level; stop's contact opens, and the pin is left to its pull."""
        if enable is not None:
            self.levels[self.BUTTON] = int(enable)
        if stop:
            del self.levels[self.STOP]
        elif stop is not None:
            self.levels[self.STOP] = 0

    def break_line(self, what: str) -> None:
        """Breaks a wire."""
        line, _, number = what.partition(" ")
        if line == "button":
            self.press(enable=False)
        else:
            del self.levels[self.STOP if line == "stop" else self.READY[int(number) - 1]]

    def short_enable(self) -> None:
        """Something holds the first enable line high."""
        self.shorted.add(self.ENABLES[0])

    def enable_lines(self) -> list:
        """What each enable line is: a level, or None while the chip leaves it to the resistor on the board."""
        return [self.level(*pin) if self.mode(*pin) == 1 else None for pin in self.ENABLES]

    def widths(self) -> list[float]:
        """The pulse widths, as shares; none of a timer whose main output is off, which drives low with OSSI."""
        return [
            0.0 if timer is TIM1 and not self.word(TIM1.BDTR) >> MOE & 1 else self.word(width) / self.word(timer.ARR)
            for timer, width in self.WIDTHS
        ]

    def spoil_widths(self) -> None:
        """Leaves others there."""
        for timer, width in self.WIDTHS:
            self.keep(width, self.word(timer.ARR) // 2)

    def waits_for_debugger(self) -> bool:
        """Whether a core that a debugger halts stops the watchdog ("DBGMCU APB1 freeze register 1")."""
        return bool(self.word(DBGMCU.APB1FZR1) >> 12 & 1)

    def light(self) -> bool:
        return self.mode(*self.LIGHT) == 1 and bool(self.level(*self.LIGHT))

    def is_of_motors(self, entry) -> bool:
        """A write that makes something of the motors' pins, or to the timer of the set-points."""
        registers = "MODER", "AFRL", "AFRH", "ODR", "BSRR", "BRR"
        outputs = {getattr(GPIO[port], register) for port in self.PORTS for register in registers}
        timers = {timer.base for timer, _ in self.WIDTHS}
        return entry.is_write and (entry.address in outputs or peripheral(entry.address) in timers)

    def is_of_enables(self, entry) -> bool:
        port, _ = self.ENABLES[0]
        return entry.address in (GPIO[port].MODER, GPIO[port].BSRR)

    def memo(self) -> tuple[int, ...]:
        """The memo of the cause, in memory that a reset leaves alone."""
        return struct.unpack("<2I", self.machine.memory(self.machine.image.symbol("stm32g44MEMO"), 8))

    def tick_is_due(self) -> bool:
        """TIM7 has come round: UIF goes up if it counts, and asks for its interrupt ("TIMx_DIER")."""
        if not self.word(TIM7.CR1) & 1:
            return False
        self.keep(TIM7.SR, self.word(TIM7.SR) | 1)
        return bool(self.word(TIM7.DIER) & 1)

    def is_acknowledged(self, entry) -> bool:
        return entry.is_write and entry.address == TIM7.SR and not entry.value & 1

    def tick_rate(self) -> float:
        return self.timer_clock() / ((self.word(TIM7.PSC) + 1) * (self.word(TIM7.ARR) + 1))

    def feeds(self) -> int:
        return sum(entry.written == FEEDS for entry in self.machine.log.writes(IWDG.KR))

    def watchdog_started(self) -> int:
        return self.machine.log.first(IWDG.KR, lambda value: value == STARTS)

    def watchdog_seconds(self) -> float:
        """Its clock, divided by 4, 8, 16 and so on, counts down from RLR ("IWDG_PR", "IWDG_RLR")."""
        return (self.word(IWDG.RLR) & 0xFFF) * (4 << (self.word(IWDG.PR) & 7)) / LSI

    def watchdog_window(self) -> float:
        """Fed while it counts above WINR it resets the chip ("Window option")."""
        return ((self.word(IWDG.RLR) & 0xFFF) - (self.word(IWDG.WINR) & 0xFFF)) * (4 << (self.word(IWDG.PR) & 7)) / LSI

    def baud(self) -> float:
        """Of the bus's clock, with sixteen samples a bit ("USART baud rate generation")."""
        assert self.word(RCC.CCIPR) >> 2 & 3 == 0 and not self.word(USART2.CR1) >> 15 & 1
        return self.timer_clock() / self.word(USART2.BRR)


