"""A SimpleFOCShield on the Nucleo-G474RE, as docs/howto/knob.md wires it."""

from __future__ import annotations

from angle_sensor import AngleSensor
from nucleo import Nucleo
from stm32g4 import GPIO, SPI1, TIM2, TIM3

SELECT = ("B", 6)


class Shield(Nucleo):
    """The board."""

    STOP, READY, LIGHT = ("C", 0), (("B", 0), ("A", 1)), None
    ENABLES = (("A", 9),)
    WIDTHS = ((TIM2, TIM2.CCR3), (TIM3, TIM3.CCR2), (TIM3, TIM3.CCR1))
    REST = 0.0
    LOST = {"GPIOA_BSRR"}
    AMPLIFIERS, SENSORS = 2, 1
    SUPPLY_RANGE = (9.0, 12.0, 15.0)

    def reset(self, machine, **reasons: bool) -> None:
        super().reset(machine, **reasons)
        self.sensors = [AngleSensor()]
        # What a line reads that nobody drives.
        self.silence = 0xFF

    def exchange(self, byte: int) -> int:
        """A byte each way with the sensor, if it is selected."""
        [sensor] = self.sensors
        if self.level(*SELECT):
            return 0xFF
        answer = sensor.exchange_byte(byte)
        return self.silence if answer is None else answer

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
