"""The Pico 2 as its README wires it."""

from __future__ import annotations

from angle_sensor import AngleSensor
from rp2350 import (
    CLOCKS, ENABLE, IO, ISO, PADS, PAUSES, PDE, PUE, PWM, SIO, SPI0, TICKS, WATCHDOG, Rp2350,
)  # fmt: skip

ENABLES, DIRECTIONS, SET_POINTS, SELECTS = (16,), (11, 13, 15), (10, 12, 14), (5, 6, 7)
SLICES = (5, 6, 7)
DATA = 4
BUTTON, STOP, READY, LIGHT, SUPPLY = 17, 21, (18, 19, 20), 25, 26
MOTORS = (*ENABLES, *DIRECTIONS, *SET_POINTS)
WIDTHS = tuple(getattr(PWM, f"CH{slice}_CC") for slice in SLICES)
EDGES = {SIO.GPIO_OUT_CLR: "falls", SIO.GPIO_OUT_SET: "rises"}
# Ω; the data sheet gives some tens of kΩ.
PULL = 50e3
# What drives pins, or makes them outputs.
LEVELS = (
    SIO.GPIO_OUT, SIO.GPIO_OUT_SET, SIO.GPIO_OUT_CLR, SIO.GPIO_OUT_XOR, SIO.GPIO_OE, SIO.GPIO_OE_SET, SIO.GPIO_OE_CLR,
    SIO.GPIO_OE_XOR,
)  # fmt: skip


def registers(*pins: int) -> set[int]:
    """What says what pins are."""
    return {getattr(block, f"GPIO{pin}{end}") for pin in pins for block, end in ((IO, "_CTRL"), (PADS, ""))}


class Pico2(Rp2350):
    """The board."""

    # PWM_IRQ_WRAP_0 ("Interrupts").
    TICK = 8
    # Cycles of a tick.
    PERIOD = 150_000_000 // 4_000
    INPUTS = (BUTTON, STOP, *READY, *SELECTS, *ENABLES)
    # A flag of its own, which power-on does not raise.
    BROWN_OUT, BY_PIN = {"brown_out": True}, {"pin": True}
    # The share of a width that drives nothing.
    REST = 0.0
    LOST: set[str] = set()
    AMPLIFIERS = SENSORS = 3
    # V: too low, on, too high.
    SUPPLY_RANGE = (19.0, 24.0, 31.0)

    def reset(self, machine, **reasons: bool) -> None:
        super().reset(machine, **reasons)
        # V, and levels from outside: stop's contact is closed, bridges are ready. The button is open.
        _, self.volts, _ = self.SUPPLY_RANGE
        self.levels = {STOP: 0, **{line: 1 for line in READY}}
        self.sensors = [AngleSensor() for _ in SELECTS]

    def level_outside(self, pin: int) -> int | None:
        """A ready line has a resistor to ground at the pin, whatever becomes of its wire."""
        return self.levels.get(pin, 0 if pin in READY else None)

    def reading(self, channel: int) -> int:
        """12 bits of 3.3 V, behind 100 kΩ and 10 kΩ, beside which the pad may pull."""
        assert channel == 0, "GP26 is input 0"
        to_ground = 1 / (1 / 10e3 + self.pad(SUPPLY, PDE) / PULL)
        return round(self.volts * to_ground / (100e3 + to_ground) / 3.3 * 4_095)

    def exchange(self, byte: int) -> int:
        """A byte each way with the sensor whose select line is low; of none, the line's own level."""
        selected = [sensor for sensor, pin in zip(self.sensors, SELECTS) if not self.level(pin)]
        answers = [sensor.exchange_byte(byte) for sensor in selected]
        assert len(answers) < 2, "one at a time"
        silence = 0xFF * self.pad(DATA, PUE)
        return silence if not answers or answers[0] is None else answers[0]

    def press(self, enable: bool | None = None, stop: bool | None = None) -> None:
        """The buttons: enable's contact closes to ground, stop's opens; the pins are pulled up."""
        for line, is_closed in ((BUTTON, enable), (STOP, None if stop is None else not stop)):
            if is_closed:
                self.levels[line] = 0
            elif is_closed is not None:
                self.levels.pop(line, None)

    def break_line(self, what: str) -> None:
        """Breaks a wire."""
        line, _, number = what.partition(" ")
        if line == "sensor":
            self.sensors[int(number) - 1].answers = False
        else:
            del self.levels[{"stop": STOP, "button": BUTTON}.get(line) or READY[int(number) - 1]]

    def duties(self) -> list[float]:
        """What each bridge makes of its pins: a width, and a direction, high for ahead."""
        driven = all(self.enable_lines())
        shares = [width / (self.word(getattr(PWM, f"CH{slice}_TOP")) + 1) for width, slice in zip(self.widths(), SLICES)]
        return [driven * share * (1 if self.level(way) else -1) for share, way in zip(shares, DIRECTIONS)]

    def turn_encoder(self, channel: int, counts: int) -> None:
        """A sensor's angle, from that of the pose."""
        self.sensors[channel].angle = (1_000 + counts) % 16_384

    def short_enable(self) -> None:
        """Something holds the enable line high."""
        self.shorted.add(ENABLES[0])

    def enable_lines(self) -> list:
        """What the enable line is: a level, or None while the chip leaves it to the resistor on the board."""
        return [self.level(pin) if self.is_output(pin) else None for pin in ENABLES]

    def widths(self) -> list[float]:
        """The motors' pulse widths, as shares: output A of their slices."""
        return [self.word(cc) & 0xFFFF for cc in WIDTHS]

    def spoil_widths(self) -> None:
        """Leaves others there."""
        for cc in WIDTHS:
            self.keep(cc, 1_000)

    def waits_for_debugger(self) -> bool:
        """Whether a core that a debugger halts stops the watchdog ("WATCHDOG: CTRL")."""
        return bool(self.word(WATCHDOG.CTRL) & PAUSES)

    def of_sensors(self, entry) -> str | None:
        """What a write does on the sensors' bus."""
        if entry.is_write and entry.address in EDGES and entry.written in (1 << pin for pin in SELECTS):
            return EDGES[entry.address]
        return "byte" if entry.is_write and entry.address == SPI0.SSPDR else None

    def light(self) -> bool:
        return self.is_output(LIGHT) and bool(self.level(LIGHT))

    def is_of_motors(self, entry) -> bool:
        """A write that makes something of the motors' pins, or to the slices of their pulse widths."""
        if not entry.is_write:
            return False
        bits = sum(1 << pin for pin in MOTORS)
        of_levels = entry.address in LEVELS and entry.written & bits
        of_slice = PWM.CH5_CSR <= entry.address <= PWM.CH7_TOP
        # What is written to a pad that stays isolated does not reach it.
        is_shut = PADS.base <= entry.address < PADS.base + 0x80 and entry.value >> ISO & 1
        return bool(of_levels) or of_slice or (entry.address in registers(*MOTORS) and not is_shut)

    def is_of_enables(self, entry) -> bool:
        orders = SIO.GPIO_OUT_CLR, SIO.GPIO_OE_SET
        return entry.address in registers(*ENABLES) or (entry.address in orders and entry.written == 1 << ENABLES[0])

    def memo(self) -> tuple[int, ...]:
        """The memo of the cause, in the watchdog's scratch registers."""
        return self.word(WATCHDOG.SCRATCH0), self.word(WATCHDOG.SCRATCH1)

    def tick_is_due(self) -> bool:
        """Slice 0 has come round: its flag goes up if it counts, and asks for its interrupt."""
        if not self.word(PWM.CH0_CSR) & 1:
            return False
        self.keep(PWM.INTR, self.word(PWM.INTR) | 1)
        return bool(self.word(PWM.IRQ0_INTE) & 1)

    def is_acknowledged(self, entry) -> bool:
        return entry.is_write and entry.address == PWM.INTR and not entry.value & 1

    def tick_rate(self) -> float:
        return self.slice_rate(0)

    def feeds(self) -> int:
        return len(self.machine.log.writes(WATCHDOG.LOAD))

    def watchdog_started(self) -> int:
        return self.machine.log.first(WATCHDOG.CTRL, lambda value: value >> ENABLE & 1)

    def watchdog_seconds(self) -> float:
        """It counts ticks, which are so many cycles of clk_ref, down from LOAD ("Watchdog", "Tick generators")."""
        assert self.word(WATCHDOG.CTRL) >> ENABLE & 1 and self.word(TICKS.WATCHDOG_CTRL) & 1, "both run"
        assert self.word(CLOCKS.CLK_REF_CTRL) & 3 == 0, "clk_ref is no crystal's"
        return self.word(WATCHDOG.LOAD) * (self.word(TICKS.WATCHDOG_CYCLES) & 0x1FF) / self.reference_clock()
