"""What the registers of an RP2350 answer: our reading of its data sheet. No silicon was asked.

A register remembers what was written, if its peripheral is out of reset. What answers otherwise is here, with the
section of the data sheet that says so; a register's own is named like the register.
"""

from __future__ import annotations

from unicorn import arm_const

from chip import Block, Chip

CLOCKS = Block(
    "CLOCKS", 0x4001_0000, CLK_REF_CTRL=0x30, CLK_REF_SELECTED=0x38, CLK_SYS_CTRL=0x3C, CLK_SYS_DIV=0x40,
    CLK_SYS_SELECTED=0x44, CLK_PERI_CTRL=0x48, CLK_PERI_DIV=0x4C, CLK_PERI_SELECTED=0x50, CLK_HSTX_SELECTED=0x5C,
    CLK_USB_SELECTED=0x68, CLK_ADC_SELECTED=0x74, FC0_REF_KHZ=0x8C, FC0_SRC=0xA0, FC0_STATUS=0xA4, FC0_RESULT=0xA8,
)  # fmt: skip
PSM = Block("PSM", 0x4001_8000, WDSEL=8)
RESETS = Block("RESETS", 0x4002_0000, RESET=0, WDSEL=4, RESET_DONE=8)
PINS = 30
IO = Block("IO_BANK0", 0x4002_8000, **{f"GPIO{pin}_CTRL": 8 * pin + 4 for pin in range(PINS)})
PADS = Block("PADS_BANK0", 0x4003_8000, **{f"GPIO{pin}": 4 * pin + 4 for pin in range(PINS)})
XOSC = Block("XOSC", 0x4004_8000, CTRL=0, STATUS=4)
PLL_SYS, PLL_USB = (
    Block(name, base, CS=0, PWR=4, FBDIV_INT=8, PRIM=0xC) for name, base in (("PLL_SYS", 0x4005_0000),
                                                                             ("PLL_USB", 0x4005_8000))
)  # fmt: skip
UART0 = Block("UART0", 0x4007_0000, DR=0, FR=0x18, IBRD=0x24, FBRD=0x28, LCR_H=0x2C, CR=0x30)
SPI0 = Block("SPI0", 0x4008_0000, SSPCR0=0, SSPCR1=4, SSPDR=8, SSPSR=0xC, SSPCPSR=0x10)
ADC = Block("ADC", 0x400A_0000, CS=0, RESULT=4)
PWM = Block(
    "PWM", 0x400A_8000, EN=0xF0, INTR=0xF4, IRQ0_INTE=0xF8,
    **{
        f"CH{n}_{name}": 0x14 * n + at
        for n in range(12)
        for name, at in (("CSR", 0), ("DIV", 4), ("CTR", 8), ("CC", 0xC), ("TOP", 0x10))
    },
)  # fmt: skip
WATCHDOG = Block("WATCHDOG", 0x400D_8000, CTRL=0, LOAD=4, REASON=8, SCRATCH0=0xC, SCRATCH1=0x10)
POWMAN = Block("POWMAN", 0x4010_0000, CHIP_RESET=0x2C, WDSEL=0x30)
TIMER0 = Block("TIMER0", 0x400B_0000, TIMERAWL=0x28, DBGPAUSE=0x2C, PAUSE=0x30, SOURCE=0x38)
TICKS = Block("TICKS", 0x4010_8000, WATCHDOG_CTRL=0x30, WATCHDOG_CYCLES=0x34)
USB_MEMORY, USB = 0x5010_0000, 0x5011_0000
SIO = Block(
    "SIO", 0xD000_0000, CPUID=0, GPIO_IN=4, GPIO_OUT=0x10, GPIO_OUT_SET=0x18, GPIO_OUT_CLR=0x20, GPIO_OUT_XOR=0x28,
    GPIO_OE=0x30, GPIO_OE_SET=0x38, GPIO_OE_CLR=0x40, GPIO_OE_XOR=0x48,
)  # fmt: skip
# Clocks that cannot choose: they say that the first is chosen.
SELECTED_ONE = {CLOCKS.CLK_PERI_SELECTED, CLOCKS.CLK_HSTX_SELECTED, CLOCKS.CLK_USB_SELECTED, CLOCKS.CLK_ADC_SELECTED}
# 32 locks: a read takes one.
SPINLOCKS = SIO.base + 0x100
# Hz.
CRYSTAL, RING = 12e6, 11e6
# Functions of a pin ("GPIO functions (Bank 0)").
SPI_FUNCTION, UART_FUNCTION, PWM_FUNCTION, SIO_FUNCTION, NULL = 1, 2, 4, 5, 0x1F
# Bits of a pad: pulls, input enable, output disable, isolation.
PDE, PUE, IE, OD, ISO = 2, 3, 6, 7, 8
# Bits of the watchdog's CTRL; those that pause it under a debugger.
ENABLE, PAUSES = 30, 0b111 << 24
# Bits of the converter's CS.
TS_EN, START_ONCE = 1, 2
# Which bit of RESETS holds which peripheral ("Subsystem resets").
HELD = {
    ADC.base: 0, IO.base: 6, PADS.base: 9, PLL_SYS.base: 14, PLL_USB.base: 15, PWM.base: 16, SPI0.base: 18,
    TIMER0.base: 23, UART0.base: 26, USB: 28,
}  # fmt: skip
# Stages of the power-on state machine ("PSM: WDSEL"): the oscillators, and that of the peripherals' resets.
ROSC, XOSC_STAGE, RESETS_STAGE, STAGES = 2, 3, 4, 25
# The bit of CHIP_RESET for each reason, and those of WATCHDOG_REASON.
CHIP_LEVEL = {"power": 16, "brown_out": 17, "pin": 18, "debugger": 19, "rescue": 21, "glitch": 26}
BY_WATCHDOG = {"watchdog": 1, "tool": 1, "force": 2}


def peripheral(address: int) -> int:
    """The base of the peripheral that a register belongs to."""
    return address & ~0x7FFF if address < USB_MEMORY else address & ~0xFFFF


class Rp2350(Chip):
    """The chip. What is around it answers `level_outside`, `reading` and `exchange`, and names its `INPUTS`."""

    CORE = arm_const.UC_CPU_ARM_CORTEX_M33
    # Flash behind XIP, RAM, the USB controller's own.
    MEMORY = ((0x1000_0000, 0x40_0000), (0x2000_0000, 0x8_2000), (USB_MEMORY, 0x1000))
    REGISTERS = ((0x4000_0000, 0x12_0000), (USB, 0x4000), (0xD000_0000, 0x1000))
    VECTORS = 0x1000_0000
    # The share of its temperature sensor that a good converter does not measure.
    IMPLAUSIBLE = 0.6
    # Of 64 bits the lower 32, of clk_sys ("TIMER: SOURCE").
    COUNTER = TIMER0.TIMERAWL
    # Pins that anybody reads.
    INPUTS: tuple[int, ...]
    RESET = {
        RESETS.RESET: 0x1FFF_FFFF,
        **{getattr(IO, f"GPIO{pin}_CTRL"): NULL for pin in range(PINS)},
        **{getattr(PADS, f"GPIO{pin}"): 0x116 for pin in range(PINS)},
        CLOCKS.CLK_SYS_DIV: 1 << 16,
        CLOCKS.CLK_PERI_DIV: 1 << 16,
        PLL_SYS.CS: 1,
        PLL_SYS.PWR: 0x2D,
        PLL_SYS.PRIM: 0x7_7000,
        PLL_USB.CS: 1,
        PLL_USB.PWR: 0x2D,
        PLL_USB.PRIM: 0x7_7000,
        # Pauses under a debugger, unless it is told not to.
        WATCHDOG.CTRL: PAUSES,
        TIMER0.DBGPAUSE: 7,
        **{getattr(PWM, f"CH{slice}_{name}"): value
           for slice in range(12) for name, value in (("DIV", 0x10), ("TOP", 0xFFFF))},
    }  # fmt: skip

    def reset(self, machine, **reasons: bool) -> None:
        """The watchdog as it is set up here resets the system, not the chip: its own scratch registers keep what they
        hold, so does the reason of the last reset of the chip, and pads stay out of isolation ("Chip-level resets",
        "Pad isolation latches"). `tool` is the boot ROM's reboot, some time after a reset that left no memo."""
        self.machine, self.stands_since = machine, None
        # Pins that something outside holds high.
        self.shorted = set()
        is_of_chip = any(CHIP_LEVEL.get(reason) for reason, is_so in reasons.items() if is_so)
        if is_of_chip or "tool" in reasons or not hasattr(self, "scratch"):
            # What reaches each pad: what was written last while it was not isolated.
            self.pads = [self.RESET[PADS.GPIO0]] * PINS
            self.scratch, self.chip_reset = {}, 1 << CHIP_LEVEL["power"]
        if is_of_chip:
            self.chip_reset = sum(1 << CHIP_LEVEL[reason] for reason, is_so in reasons.items() if is_so)
        machine.words.update(self.scratch)
        self.reset_pads()
        self.keep(POWMAN.CHIP_RESET, self.chip_reset)
        self.keep(WATCHDOG.REASON, sum(BY_WATCHDOG.get(reason, 0) for reason, is_so in reasons.items() if is_so))
        self.received, self.sent, self.answers = bytearray(), bytearray(), []
        # The ring oscillator, as a share of what it usually makes; whether the sensors' bus ends its frames.
        self.slow, self.finishes = 1.0, True
        # What the converter measures of the temperature sensor, 0.706 V of 3.3 V; whether conversions end.
        self.reference, self.converts = round(0.706 / 3.3 * 4_095), True

    def is_lost(self, address: int) -> bool:
        """A peripheral that is held in reset takes nothing and gives nothing."""
        bit = HELD.get(peripheral(address))
        return bit is not None and bool(self.word(RESETS.RESET) >> bit & 1)

    def alias(self, address: int, value: int, mask: int) -> tuple[int, int, int]:
        """Every register four times: itself, and where a write toggles, sets or clears ("Atomic register access")."""
        if address >= SIO.base or not address & 0x3000:
            return address, value, mask
        base = address & ~0x3000
        old = self.word(base)
        return base, {1: old ^ value, 2: old | value, 3: old & ~value}[address >> 12 & 3], 0xFFFF_FFFF

    def read(self, address: int) -> int:
        value = self.word(address)
        if address == RESETS.RESET_DONE:
            value = ~self.word(RESETS.RESET) & 0x1FFF_FFFF
        elif address == XOSC.STATUS:
            # STABLE once it is enabled.
            value = (1 << 31 | 1 << 12) * (self.word(XOSC.CTRL) >> 12 & 0xFFF == 0xFAB)
        elif address in (PLL_SYS.CS, PLL_USB.CS):
            # LOCK once it and its oscillator have power.
            is_on = not self.word(address + 4) & (1 | 1 << 5)
            value = value & 0x7FFF_FFFF | is_on << 31
        elif address == CLOCKS.CLK_REF_SELECTED:
            value = 1 << (self.word(CLOCKS.CLK_REF_CTRL) & 3)
        elif address == CLOCKS.CLK_SYS_SELECTED:
            value = 1 << (self.word(CLOCKS.CLK_SYS_CTRL) & 1)
        elif address == CLOCKS.FC0_STATUS:
            # DONE: measured at once.
            value = 1 << 4
        elif address == CLOCKS.FC0_RESULT:
            value = self.measured() << 5
        elif address in SELECTED_ONE:
            value = 1
        elif address == ADC.CS:
            # READY: converted at once.
            value |= self.converts << 8
        elif address == UART0.FR:
            # TXFE; RXFE unless something waits.
            value = 1 << 7 | (not self.received) << 4
        elif address == UART0.DR:
            value = self.received.pop(0) if self.received else 0
        elif address == SPI0.SSPSR:
            # TFE, TNF; RNE while an answer waits. It is never busy: a byte goes at once.
            value = 3 | (self.finishes and bool(self.answers)) << 2
        elif address == SPI0.SSPDR:
            value = self.answers.pop(0) if self.answers else 0
        elif address == SIO.GPIO_IN:
            value = sum(self.level(pin) << pin for pin in self.INPUTS if self.pad(pin, IE))
        elif SPINLOCKS <= address < SPINLOCKS + 0x80:
            # Free, for there is nobody else.
            value = 1 << (address - SPINLOCKS) // 4
        return value

    def write(self, address: int, value: int) -> int:
        """Writes, and says what the register holds then."""
        for register, orders in (
            (SIO.GPIO_OUT, (SIO.GPIO_OUT_SET, SIO.GPIO_OUT_CLR, SIO.GPIO_OUT_XOR)),
            (SIO.GPIO_OE, (SIO.GPIO_OE_SET, SIO.GPIO_OE_CLR, SIO.GPIO_OE_XOR)),
        ):
            if address in orders:
                old = self.word(register)
                self.keep(register, (old | value, old & ~value, old ^ value)[orders.index(address)])
                return value
        if address == RESETS.RESET:
            for base, bit in HELD.items():
                if value >> bit & 1:
                    self.forget(base)
        elif PADS.base < address < PADS.base + 0x80:
            pin = (address - PADS.base) // 4 - 1
            self.pads[pin] = self.pads[pin] | 1 << ISO if value >> ISO & 1 else value
        elif address in (WATCHDOG.SCRATCH0, WATCHDOG.SCRATCH1):
            self.scratch[address] = value
        elif address == ADC.CS and value >> START_ONCE & 1 and self.converts:
            # Input 4 is the temperature sensor, where there are four pins, if TS_EN is up ("ADC: Channels").
            is_sensor = value >> 12 & 0xF == 4
            self.keep(ADC.RESULT, self.reference * (value >> TS_EN & 1) if is_sensor else self.reading(value >> 12 & 0xF))
            value &= ~(1 << START_ONCE)
        elif address == PWM.INTR:
            # Flags are cleared by writing 1.
            value = self.word(address) & ~value
        elif address == UART0.DR:
            self.sent.append(value & 0xFF)
        elif address == SPI0.SSPDR:
            assert self.word(SPI0.SSPCR0) & 0xF == 7 and self.word(SPI0.SSPCR1) >> 1 & 1, "it runs, with 8 bits"
            self.answers.append(self.exchange(value & 0xFF))
        return self.keep(address, value)

    def forget(self, base: int) -> None:
        """A peripheral is put into reset."""
        for address in [word for word in self.machine.words if peripheral(word) == base]:
            del self.machine.words[address]
        if base == PADS.base:
            self.reset_pads()

    def reset_pads(self) -> None:
        """Isolation has ended by software, and only a reset of the chip brings it back ("Pad isolation latches")."""
        for pin, pad in enumerate(self.pads):
            if not pad >> ISO & 1:
                self.pads[pin] = self.keep(PADS.base + 4 * pin + 4, self.RESET[PADS.GPIO0] & ~(1 << ISO))

    def is_counting(self) -> bool:
        """It counts clk_sys, and is not paused."""
        return self.word(TIMER0.SOURCE) & 1 and not self.word(TIMER0.PAUSE) & 1

    def counts_at_a_halt(self) -> bool:
        """Whether it goes on while a debugger halts a processor ("TIMER: DBGPAUSE")."""
        return not self.word(TIMER0.DBGPAUSE) >> 1 & 3

    def pad(self, pin: int, bit: int) -> int:
        """A bit of what reaches a pad."""
        return self.pads[pin] >> bit & 1

    def function(self, pin: int) -> int:
        """What a pin is given to."""
        return self.word(IO.base + 8 * pin + 4) & 0x1F

    def is_output(self, pin: int) -> bool:
        """Whether the processors drive it: an output of SIO, whose pad is neither isolated nor off."""
        if self.function(pin) != SIO_FUNCTION or not self.word(SIO.GPIO_OE) >> pin & 1:
            return False
        return not self.pad(pin, OD) and not self.pad(pin, ISO)

    def level(self, pin: int) -> int:
        """What is on a pin: its own output, the level from outside, or its pull."""
        if pin in self.shorted:
            return 1
        if self.is_output(pin):
            return self.word(SIO.GPIO_OUT) >> pin & 1
        outside = self.level_outside(pin)
        return outside if outside is not None else self.pad(pin, PUE)

    def core_clock(self) -> float:
        """clk_sys, Hz ("Clocks"): of the system PLL ("PLL", "Calculating PLL parameters")."""
        control, divider = self.word(CLOCKS.CLK_SYS_CTRL), self.word(CLOCKS.CLK_SYS_DIV)
        assert control & 1 and not control >> 5 & 7 and divider == 1 << 16, "of PLL_SYS, undivided"
        primary = self.word(PLL_SYS.PRIM)
        oscillator = CRYSTAL / (self.word(PLL_SYS.CS) & 0x3F) * (self.word(PLL_SYS.FBDIV_INT) & 0xFFF)
        return oscillator / (primary >> 16 & 7) / (primary >> 12 & 7)

    def reference_clock(self) -> float:
        """clk_ref, Hz: of the ring oscillator, or of the crystal."""
        return {0: RING * self.slow, 2: CRYSTAL}[self.word(CLOCKS.CLK_REF_CTRL) & 3]

    def measured(self) -> int:
        """What the frequency counter measures by clk_ref, as it is told to be, kHz ("Frequency counter")."""
        clock = {4: RING * self.slow, 9: self.core_clock()}[self.word(CLOCKS.FC0_SRC)]
        return int(clock / self.reference_clock() * self.word(CLOCKS.FC0_REF_KHZ))

    def peripheral_clock(self) -> float:
        """clk_peri, Hz, of UART and SPI."""
        control, divider = self.word(CLOCKS.CLK_PERI_CTRL), self.word(CLOCKS.CLK_PERI_DIV)
        assert control >> 11 & 1 and not control >> 5 & 7 and divider >> 16 == 1, "of clk_sys, undivided"
        return self.core_clock()

    def slice_rate(self, slice: int) -> float:
        """How often a slice comes round, Hz: from 0 to TOP, at an undivided clk_sys ("PWM")."""
        control, divider, top = (self.word(getattr(PWM, f"CH{slice}_{name}")) for name in ("CSR", "DIV", "TOP"))
        assert control & 1 and not control >> 1 & 1 and divider == 0x10, "it runs, up only, undivided"
        return self.core_clock() / (top + 1)

    def baud(self) -> float:
        """Of clk_peri, divided by 16 and by a number with six bits of a fraction ("UART", "Baud rate calculation")."""
        return self.peripheral_clock() / (16 * (self.word(UART0.IBRD) + self.word(UART0.FBRD) / 64))

    def sensor_clock(self) -> float:
        """The clock of the sensors' bus, Hz ("SPI", "Clock ratios")."""
        return self.peripheral_clock() / self.word(SPI0.SSPCPSR) / ((self.word(SPI0.SSPCR0) >> 8) + 1)
