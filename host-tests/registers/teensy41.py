"""The Teensy 4.1 as its README wires it."""

from __future__ import annotations

from angle_sensor import AngleSensor
from imxrt1062 import EMC_07, EN, FEED, GPIO, IOMUXC, LOW_POWER, LPSPI4, PIT, PWM2, SNVS, WDOG3, Imxrt1062

# Pins: port, bit, and the place of their pad among all of them (EMC, AD_B0, AD_B1, B0, B1 and so on).
AD_B1, EMC, B0, B1 = 0xFC, 0x14, 0x13C, 0x17C
ENABLES = ((1, 23, AD_B1 + 4 * 7), (1, 22, AD_B1 + 4 * 6), (1, 17, AD_B1 + 4 * 1))
DIRECTIONS = ((4, 4, EMC + 4 * 4), (4, 5, EMC + 4 * 5), (2, 17, B1 + 4 * 1))
SET_POINTS = (EMC + 4 * 6, EMC + 4 * 8, B0 + 4 * 10)
SELECTS = ((2, 16, B1), (2, 11, B0 + 4 * 11), (2, 0, B0))
BUTTON, STOP = (1, 18, AD_B1 + 4 * 2), (1, 27, AD_B1 + 4 * 11)
READY = ((1, 19, AD_B1 + 4 * 3), (1, 16, AD_B1), (1, 26, AD_B1 + 4 * 10))
LIGHT = (1, 24, AD_B1 + 4 * 8)
PADS = {pin[:2]: pin[2] for pin in (*ENABLES, *DIRECTIONS, *SELECTS, BUTTON, STOP, *READY, LIGHT)}
WIDTHS = ((PWM2.SM0_VAL3, PWM2.SM0_VAL1), (PWM2.SM1_VAL3, PWM2.SM1_VAL1), (PWM2.SM2_VAL3, PWM2.SM2_VAL1))
EDGES = {GPIO[2].DR_CLEAR: "falls", GPIO[2].DR_SET: "rises"}
# From a pad's multiplexer to its pulls.
TO_PULLS = 0x1F0


class Teensy41(Imxrt1062):
    """The board."""

    CODE_IMAGE = "__sitext"
    # PIT ("CM7 interrupts").
    TICK = 122
    # Cycles of a tick.
    PERIOD = 600_000_000 // 4_000
    # The memo has not faded when the flag of power-on goes up.
    BROWN_OUT, BY_PIN = {"power": True}, {"pin": True}
    # The share of a width that is no current, as the amplifiers are configured.
    REST = 0.1
    LOST: set[str] = set()
    AMPLIFIERS = SENSORS = 3
    # V: too low, on, too high.
    SUPPLY_RANGE = (19.0, 24.0, 31.0)

    def reset(self, machine, **reasons: bool) -> None:
        super().reset(machine, **reasons)
        # V, and levels from outside: stop's contact is closed, amplifiers are ready. The button is open.
        _, self.volts, _ = self.SUPPLY_RANGE
        self.levels = {STOP: 0, **{line: 1 for line in READY}}
        self.sensors = [AngleSensor() for _ in SELECTS]
        # The level that a stop loop gives pin 33, if there is one.
        self.fault_loop: int | None = None
        # What the sensors' data line reads where nobody drives it.
        self.silence = 0xFFFF

    def level(self, port: int, bit: int) -> int:
        """What is on a pin: its own output, the level from outside, its pull; or whatever was last there (keeper)."""
        if (port, bit) in self.shorted:
            return 1
        if self.word(GPIO[port].GDIR) >> bit & 1:
            return self.word(GPIO[port].DR) >> bit & 1
        pad = PADS.get((port, bit))
        if pad is None:
            return 0
        if (port, bit, pad) in self.levels:
            return self.levels[port, bit, pad]
        pulls = self.word(IOMUXC + pad + TO_PULLS)
        # PKE and PUE; PUS is 0 for down.
        is_pulled = pulls >> 12 & 1 and pulls >> 13 & 1
        return int(pulls >> 14 & 3 != 0) if is_pulled else 1

    def reading(self) -> int:
        """12 bits of 3.3 V, behind 100 kΩ and 10 kΩ."""
        return round(self.volts / 11 / 3.3 * 4_095)

    def exchange(self, frame: int) -> int:
        """The answer of the sensor whose select line is low; of none, the line's own level."""
        selected = [sensor for sensor, (port, bit, _) in zip(self.sensors, SELECTS) if not self.level(port, bit)]
        answers = [sensor.exchange(frame) for sensor in selected]
        assert len(answers) < 2, "one at a time"
        return self.silence if not answers or answers[0] is None else answers[0]

    def pad_status(self, port: int, bit: int) -> int:
        """An output's pad is read with SION alone ("GPIO pad status register", "Software input on")."""
        pad = PADS.get((port, bit))
        is_blind = self.word(GPIO[port].GDIR) >> bit & 1 and (pad is None or not self.word(IOMUXC + pad) >> 4 & 1)
        return 0 if is_blind else self.level(port, bit)

    def fault_level(self) -> int:
        """Of pin 33: what the stop loop makes of it, or its pull."""
        return self.fault_loop if self.fault_loop is not None else int(self.word(IOMUXC + EMC_07 + TO_PULLS) >> 14 & 3 != 0)

    def short_enable(self) -> None:
        """Something holds the first enable line high."""
        self.shorted.add(ENABLES[0][:2])

    def duties(self) -> list[float]:
        """What each amplifier makes of its pins: a width of 10 to 90 %, and a direction, high for ahead."""
        signs = (1 if self.level(*way[:2]) else -1 for way in DIRECTIONS)
        driven = all(self.enable_lines())
        return [driven * sign * (width - 0.1) / 0.8 for sign, width in zip(signs, self.widths())]

    def turn_encoder(self, channel: int, counts: int) -> None:
        """A sensor's angle, from that of the pose."""
        self.sensors[channel].angle = (1_000 + counts) % 16_384

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

    def enable_lines(self) -> list:
        """What each enable line is: a level, or None while the chip leaves it to the resistor on the board."""
        return [self.level(*pin[:2]) if self.is_output(*pin) else None for pin in ENABLES]

    def is_output(self, port: int, bit: int, pad: int) -> bool:
        return bool(self.word(GPIO[port].GDIR) >> bit & 1) and self.word(IOMUXC + pad) & 0xF == 5

    def widths(self) -> list[float]:
        """The set-points, as shares: a submodule counts from 0 to VAL1."""
        on = not self.ends_widths()
        return [on * (self.word(width) >> 16) / ((self.word(most) >> 16) + 1) for width, most in WIDTHS]

    def spoil_widths(self) -> None:
        """Leaves others there."""
        for width, most in WIDTHS:
            self.keep(width, self.word(width) & 0xFFFF | self.word(most) >> 17 << 16)

    def waits_for_debugger(self) -> bool:
        """Whether a core that a debugger halts stops the watchdog: it does not with DBG ("RTWDOG_CS")."""
        return not self.word(WDOG3.CS) >> 2 & 1

    def of_sensors(self, entry) -> str | None:
        """What a write does on the sensors' bus."""
        bits = {1 << bit for _, bit, _ in SELECTS}
        if entry.is_write and entry.address in EDGES and entry.written in bits:
            return EDGES[entry.address]
        return "byte" if entry.is_write and entry.address == LPSPI4.TDR else None

    def light(self) -> bool:
        return bool(self.word(GPIO[1].GDIR) >> LIGHT[1] & self.word(GPIO[1].DR) >> LIGHT[1] & 1)

    def is_of_motors(self, entry) -> bool:
        """A write that makes something of the motors' pins, or to the timer of the set-points. Which level is a fault
        is no output: the board's package says so of every timer, first of all."""
        if not entry.is_write or entry.address == PWM2.FCTRL0:
            return False
        bits = {port: sum(1 << bit for at, bit, _ in (*ENABLES, *DIRECTIONS) if at == port) for port in GPIO}
        of_port = any(
            entry.written & bits[port] and entry.address in (block.DR, block.GDIR, block.DR_SET, block.DR_CLEAR)
            for port, block in GPIO.items()
        )
        pads = {IOMUXC + pad for pad in (*SET_POINTS, *(pin[2] for pin in (*ENABLES, *DIRECTIONS)))}
        return of_port or entry.address in pads or PWM2.base <= entry.address < PWM2.base + 0x200

    def is_of_enables(self, entry) -> bool:
        port = GPIO[1]
        return entry.address in (port.GDIR, port.DR_CLEAR, *(IOMUXC + pad for *_, pad in ENABLES))

    def memo(self) -> tuple[int, ...]:
        """The memo of the cause, in the always-on domain."""
        return self.word(SNVS.LPGPR0), self.word(SNVS.LPGPR1)

    def tick_is_due(self) -> bool:
        """The timer has come round: TIF goes up if it counts, and asks for its interrupt."""
        control = self.word(PIT.TCTRL0)
        if self.word(PIT.MCR) >> 1 & 1 or not control & 1:
            return False
        self.keep(PIT.TFLG0, 1)
        return bool(control >> 1 & 1)

    def is_acknowledged(self, entry) -> bool:
        return entry.is_write and entry.address == PIT.TFLG0 and not entry.value & 1

    def feeds(self) -> int:
        return sum(entry.written == FEED for entry in self.machine.log.writes(WDOG3.CNT))

    def watchdog_started(self) -> int:
        return self.machine.log.first(WDOG3.CS, lambda value: value >> EN & 1)

    def watchdog_seconds(self) -> float:
        """Its low-power clock, not divided, counts up to TOVAL ("RTWDOG_CS", "RTWDOG_TOVAL")."""
        status = self.word(WDOG3.CS)
        assert status >> EN & 1 and status >> 8 & 3 == 1 and not status >> 12 & 1, "it runs, of LPO_CLK"
        return (self.word(WDOG3.TOVAL) & 0xFFFF) / LOW_POWER

    def watchdog_window(self) -> float:
        """Fed before WIN counts it resets the chip ("Window mode")."""
        return (self.word(WDOG3.WIN) & 0xFFFF) / LOW_POWER if self.word(WDOG3.CS) >> 15 & 1 else 0.0
