"""A SimpleFOCShield on the Nucleo-G474RE, as docs/howto/knob.md wires it."""

from __future__ import annotations

from angle_sensor import AngleSensor
from nucleo import Nucleo
from stm32g4 import ADC2, GPIO, SPI1, TIM2, TIM3

SELECT, CHOPPER = ("B", 6), ("C", 1)
# Ω of a phase; V of an amplifier for an ampere, 10 mΩ and 50 (docs/howto/knob.md).
RESISTANCE, SHORT, VOLTS_PER_AMP = 7.5, 1.0, 0.01 * 50


class Shield(Nucleo):
    """The board."""

    STOP, READY, LIGHT = ("C", 0), (("B", 0), ("A", 1)), None
    ENABLES = (("A", 9),)
    WIDTHS = ((TIM2, TIM2.CCR3), (TIM3, TIM3.CCR2), (TIM3, TIM3.CCR1))
    REST = 0.0
    LOST = {"GPIOA_BSRR", "GPIOC_BSRR"}
    AMPLIFIERS, SENSORS = 2, 1
    SUPPLY_RANGE = (9.0, 12.0, 15.0)

    def reset(self, machine, **reasons: bool) -> None:
        super().reset(machine, **reasons)
        self.sensors = [AngleSensor()]
        # What a line reads that nobody drives.
        self.silence = 0xFF
        # The phase without a wire, the one whose wire touches ground, and V at the amplifiers without current.
        self.open_phase = self.short_phase = None
        self.amplifiers = 1.65

    def exchange(self, byte: int) -> int:
        """A byte each way with the sensor, if it is selected."""
        [sensor] = self.sensors
        if self.level(*SELECT):
            return 0xFF
        answer = sensor.exchange_byte(byte)
        return self.silence if answer is None else answer

    def currents(self) -> list[float]:
        """Of the phases, A: what the mean of their widths drives through the windings at rest, which meet in a star."""
        volts = [width * self.volts * all(self.enable_lines()) for width in self.widths()]
        on = [phase for phase in range(3) if phase != self.open_phase]
        star = sum(volts[phase] for phase in on) / len(on)
        to_ground = [volts[phase] / SHORT * (phase == self.short_phase) for phase in range(3)]
        return [(volts[phase] - star) / RESISTANCE * (phase in on) + to_ground[phase] for phase in range(3)]

    def read(self, address: int) -> int:
        if address in (ADC2.JDR1, ADC2.JDR2):
            # The sequence of ADC2: channel 1 (PA0), then 17 (PA4) ("ADC_JSQR").
            assert self.word(ADC2.JSQR) & 3 == 1 and self.word(ADC2.JSQR) >> 9 & 0x1F == 1, "two, of which the first is PA0"
            assert self.word(ADC2.JSQR) >> 15 & 0x1F == 17, "the second is PA4"
            assert self.mode("A", 0) == self.mode("A", 4) == 3, "both are analogue"
            amps = self.currents()[(ADC2.JDR1, ADC2.JDR2).index(address)]
            return min(4_095, max(0, round((self.amplifiers + VOLTS_PER_AMP * amps) / 3.3 * 4_095)))
        return super().read(address)

    def burns(self) -> bool:
        """Whether the chopper is on."""
        return self.mode(*CHOPPER) == 1 and bool(self.level(*CHOPPER))

    def break_line(self, what: str) -> None:
        """Breaks a wire."""
        if what.startswith("sensor"):
            self.sensors[0].answers = False
        else:
            super().break_line(what)

    def light(self) -> bool:
        """It hangs on the sensor's clock, and says nothing."""
        return False

    def sensor_clock(self) -> float:
        """The clock of the sensor's bus, Hz: of its bus, divided by a power of two ("SPI control register 1")."""
        return self.timer_clock() / (2 << (self.word(SPI1.CR1) >> 3 & 7))

    def of_sensors(self, entry) -> str | None:
        """What a write does on the sensor's bus."""
        port, pin = SELECT
        if entry.is_write and entry.address == GPIO[port].BSRR and entry.written in (1 << pin, 1 << pin + 16):
            return "rises" if entry.written >> pin & 1 else "falls"
        return "byte" if entry.is_write and entry.address == SPI1.DR else None
