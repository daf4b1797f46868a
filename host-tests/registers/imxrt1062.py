"""What the registers of an i.MX RT1062 answer: our reading of its reference manual, IMXRT1060RM. No silicon was asked.

A register remembers what was written, if its peripheral has a clock. What answers otherwise is here, with the chapter
of the manual that says so; a register's own is named like the register.
"""

from __future__ import annotations

import struct

from unicorn import arm_const

from chip import Block, Chip

DCDC = Block("DCDC", 0x4008_0000, REG0=0)
PIT = Block("PIT", 0x4008_4000, MCR=0, LDVAL0=0x100, TCTRL0=0x108, TFLG0=0x10C)
WDOG3 = Block("WDOG3", 0x400B_C000, CS=0, CNT=4, TOVAL=8, WIN=0xC)
ADC1 = Block("ADC1", 0x400C_4000, HC0=0, HS=0x20, R0=0x24, CFG=0x44, GC=0x48, GS=0x4C, CAL=0x58)
SNVS = Block("SNVS", 0x400D_4000, HPCR=8, HPRTCLR=0x28, LPGPR0=0x100, LPGPR1=0x104)
ANALOG = Block("CCM_ANALOG", 0x400D_8000, PLL_ARM=0, PLL_SYS=0x30)
SRC = Block("SRC", 0x400F_8000, SRSR=8)
CCM = Block("CCM", 0x400F_C000, CACRR=0x10, CBCDR=0x14, CBCMR=0x18, CSCMR1=0x1C, CSCDR1=0x24, CDHIPR=0x48)
CCGR = [0x400F_C068 + 4 * number for number in range(8)]
LPUART6 = Block("LPUART6", 0x4019_8000, BAUD=0x10, STAT=0x14, CTRL=0x18, DATA=0x1C, FIFO=0x28)
GPIO = {
    number: Block(f"GPIO{number}", base, DR=0, GDIR=4, PSR=8, DR_SET=0x84, DR_CLEAR=0x88, DR_TOGGLE=0x8C)
    for number, base in ((1, 0x401B_8000), (2, 0x401B_C000), (3, 0x401C_0000), (4, 0x401C_4000))
}
IOMUXC = 0x401F_8000
# The pad of pin 33.
EMC_07 = 0x14 + 4 * 7
OCOTP = Block("OCOTP", 0x401F_4000, ANA1=0x4E0)
GPT = [Block(f"GPT{number}", base, CR=0, PR=4, CNT=0x24) for number, base in ((1, 0x401E_C000), (2, 0x401F_0000))]
USB1 = Block("USB1", 0x402E_0000, USBCMD=0x140, ENDPTPRIME=0x1B0, ENDPTFLUSH=0x1B4)
LPSPI4 = Block(
    "LPSPI4", 0x403A_0000, PARAM=4, CR=0x10, SR=0x14, CCR=0x40, FSR=0x5C, TCR=0x60, TDR=0x64, RSR=0x70, RDR=0x74
)
# What the crossbar and a fault of PWM2 need: SEL48 and SEL49, the direction of its pins, the choice of its input 9.
XBAR1, GPR = Block("XBAR1", 0x403B_C000, SEL24=0x30), Block("IOMUXC_GPR", 0x400A_C000, GPR6=0x18)
XBAR1_IN09 = IOMUXC + 0x430
# Registers of 16 bits, two a word: CTRL2 and CTRL, VAL1 in the upper half, VAL3 too; FCTRL0 and FSTS0.
PWM2 = Block(
    "PWM2", 0x403E_0000, OUTEN=0x180, MCTRL=0x188, FCTRL0=0x18C,
    **{f"SM{n}_{name}": 0x60 * n + at for n in range(3) for name, at in (("CTRL", 4), ("VAL1", 0xC), ("VAL3", 0x14))},
)  # fmt: skip
# Of a submodule of PWM2: its registers' bytes, the words of its prescaler, its values and its start, and the core's
# cycles of one of its clock's.
SUBMODULE, BUFFERED, TO_PWM = 0x60, range(0x8, 0x20, 4), 4
# Hz; what opens the watchdog and feeds it ("RTWDOG").
CRYSTAL, LOW_POWER, SYSTEM_PLL, UNLOCK, FEED = 24e6, 32_768, 528e6, 0xD928_C520, 0xB480_A602
# Bits of the watchdog's CS.
UPDATE, EN, RCS, ULK = 5, 7, 10, 11
# Core cycles for which an opened watchdog takes a configuration: 255 of a bus at a quarter of the core's clock.
OPEN = 255 * 4
# Core cycles of a calibration. It takes milliseconds; what does not wait does not wait for this either.
CALIBRATION = 20_000
# Where a write to the register next to it sets, clears or toggles bits.
SET_CLEAR_TOGGLE = ((0x400D_8000, 0x400D_8200), (0x400D_9000, 0x400D_9100))
# Which two bits of which CCGR give which peripheral its clock ("System clocks, gating, and override").
CLOCKS = {
    PIT.base: (1, 6), LPUART6.base: (3, 3), LPSPI4.base: (1, 3), PWM2.base: (4, 9), ADC1.base: (1, 8),
    WDOG3.base: (5, 2), GPIO[1].base: (1, 13), GPIO[2].base: (0, 15), GPIO[3].base: (2, 13), GPIO[4].base: (3, 6),
    USB1.base: (6, 0), XBAR1.base: (2, 11),
}  # fmt: skip
# The bit of SRC_SRSR for each reason.
REASONS = {"power": 0, "lockup": 1, "pin": 3, "watchdog": 7, "heat": 8}


class Imxrt1062(Chip):
    """The chip. What is around it answers `level_outside`, `reading` and `exchange`."""

    CORE = arm_const.UC_CPU_ARM_CORTEX_M7
    # ITCM, DTCM, OCRAM, and flash behind FlexSPI.
    MEMORY = ((0, 0x8_0000), (0x2000_0000, 0x8_0000), (0x2020_0000, 0x8_0000), (0x6000_0000, 0x20_0000))
    REGISTERS = ((0x4000_0000, 0x40_0000),)
    VECTORS = 0x6000_0000
    # The share of its reference that a good converter does not measure.
    IMPLAUSIBLE = 0.95
    # 32 bits of the bus's clock, a quarter of the core's.
    COUNTER, COUNTER_CYCLES = GPT[0].CNT, 4
    RESET = {
        **{register: 0xFFFF_FFFF for register in CCGR},
        # As the boot ROM leaves them: it runs at 396 MHz, and its watchdog may be updated, which is what NXP's own
        # start-up code (SystemInit) builds on.
        CCM.CBCDR: 0x000A_8200,
        CCM.CSCMR1: 0x0490_0000,
        WDOG3.CS: 0x2980 | 1 << UPDATE,
        WDOG3.TOVAL: 0x400,
        PIT.MCR: 6,
        # The temperature sensor's calibration, which every chip has; the numbers are made up.
        OCOTP.ANA1: 0x58B4_E05F,
        # Every pad is a pin of its port, with a keeper ("SW_MUX_CTL_PAD", "SW_PAD_CTL_PAD").
        **{IOMUXC + at: 5 for at in range(0x14, 0x204, 4)},
        **{IOMUXC + at: 0x10B0 for at in range(0x204, 0x3F4, 4)},
    }

    def reset(self, machine, **reasons: bool) -> None:
        self.machine, self.stands_since = machine, None
        # Pins that something outside holds high.
        self.shorted = set()
        self.keep(SRC.SRSR, sum(1 << REASONS[reason] for reason, is_so in reasons.items() if is_so))
        # The always-on domain keeps what it holds over every reset ("SNVS_LP general purpose registers").
        self.always_on = getattr(self, "always_on", {})
        machine.words.update(self.always_on)
        self.open_until = self.calibrated_at = None
        self.is_calibrated = False
        # The slow oscillator, as a share of what it should make.
        self.slow = 1.0
        # What the converter measures of its own reference; whether conversions end, and the bus of the sensors its frames.
        self.reference, self.converts, self.finishes = 4_095, True, True
        self.received, self.sent, self.answers = bytearray(), bytearray(), []
        self.was_fault = False
        # When each submodule of PWM2 began to run, since when LDOK waits for its reload, and writes that it ignored.
        self.runs, self.waits, self.ignored = {}, {}, 0

    def entry(self) -> tuple[int, int]:
        """Where the boot ROM goes: the vector table that the image vector table names ("Program image")."""
        (table,) = struct.unpack("<I", self.machine.memory(0x6000_1004, 4))
        return struct.unpack("<II", self.machine.memory(table, 8))

    def is_lost(self, address: int) -> bool:
        """A peripheral without its clock takes nothing and gives nothing."""
        gate = CLOCKS.get(address & ~0x3FFF)
        return gate is not None and not self.word(CCGR[gate[0]]) >> 2 * gate[1] & 3

    def read(self, address: int) -> int:
        value = self.word(address)
        if address == DCDC.REG0 or ANALOG.base <= address < ANALOG.base + 0x100:
            # STS_DC_OK; LOCK of every PLL.
            value |= 1 << 31
        elif address == SNVS.HPRTCLR:
            # It counts the slow oscillator once RTC_EN is up, while the core's time goes by.
            runs = self.word(SNVS.HPCR) & 1
            value = int(self.machine.cycles * LOW_POWER * self.slow / self.core_clock()) if runs else 0
        elif address == CCM.CDHIPR:
            value = 0
        elif address == ADC1.GC:
            self.calibrate()
            value = self.word(address)
        elif address == ADC1.HS:
            # COCO0: converted at once.
            value = int(self.converts)
        elif address == ADC1.R0:
            # Input 25 is the reference ("ADC_HC0", VREFSH).
            value = self.reference if self.word(ADC1.HC0) & 0x1F == 25 else self.reading()
        elif address == PWM2.FCTRL0:
            # FFPIN0 is the input's level, where FLVL0 says that a high one is a fault ("FSTS0").
            value = value & ~(1 << 24) | self.has_fault() << 24
        elif address == PWM2.MCTRL:
            value = value & ~0xF | sum(1 << number for number in range(4) if self.waits_for_reload(number))
        elif any(address == PWM2.base + SUBMODULE * number for number in self.runs):
            value = value & ~0xFFFF | self.count(self.submodule(address))
        elif address == LPUART6.STAT:
            # TDRE and TC; RDRF while something waits.
            value = 1 << 23 | 1 << 22 | bool(self.received) << 21
        elif address == LPUART6.DATA:
            value = self.received.pop(0) if self.received else 1 << 12
        elif address == LPSPI4.PARAM:
            value = 0x0404
        elif address == LPSPI4.FSR:
            value = len(self.answers) * self.finishes << 16
        elif address == LPSPI4.RSR:
            value = 0 if self.answers and self.finishes else 2
        elif address == LPSPI4.RDR:
            value = self.answers.pop(0) if self.answers else 0
        else:
            for port, block in GPIO.items():
                if address == block.PSR:
                    value = sum(self.pad_status(port, pin) << pin for pin in range(32))
        return value

    def alias(self, address: int, value: int, mask: int) -> tuple[int, int, int]:
        """SET, CLR and TOG of the analog registers."""
        if any(start <= address < end for start, end in SET_CLEAR_TOGGLE) and address & 0xC:
            base = address & ~0xF
            old = self.word(base)
            return base, {4: old | value, 8: old & ~value, 0xC: old ^ value}[address & 0xC], 0xFFFF_FFFF
        return address, value, mask

    def write(self, address: int, value: int) -> int:
        """Writes, and says what the register holds then."""
        for port in GPIO.values():
            if address in (port.DR_SET, port.DR_CLEAR, port.DR_TOGGLE):
                old = self.word(port.DR)
                new = {port.DR_SET: old | value, port.DR_CLEAR: old & ~value, port.DR_TOGGLE: old ^ value}
                self.keep(port.DR, new[address])
                return value
        if WDOG3.base <= address < WDOG3.base + 0x10:
            return self.write_watchdog(address, value)
        if ADC1.base <= address < ADC1.base + 0x60:
            return self.write_converter(address, value)
        if address in (SRC.SRSR, PIT.TFLG0):
            # Flags are cleared by writing 1.
            value = self.word(address) & ~value
        elif address in (SNVS.LPGPR0, SNVS.LPGPR1):
            self.always_on[address] = value
        elif address in (block.CR for block in GPT):
            # SWR is over at once.
            value &= ~(1 << 15)
        elif address == USB1.USBCMD:
            # So is RST.
            value &= ~2
        elif address in (USB1.ENDPTPRIME, USB1.ENDPTFLUSH):
            value = 0
        elif address == PWM2.MCTRL:
            value = self.write_load(value)
        elif self.is_buffered(address) and self.waits_for_reload(self.submodule(address)):
            # "VALx cannot be written while LDOK is set": nothing happens.
            self.ignored += 1
            return self.word(address)
        elif address == LPUART6.FIFO:
            # The flushes are over at once; TXOF and RXUF are cleared by writing 1.
            value &= ~(1 << 14 | 1 << 15 | 1 << 16 | 1 << 17)
        elif address == LPUART6.DATA:
            self.sent.append(value & 0xFF)
        elif address == LPSPI4.TDR:
            # As many bits as the transmit command says; it is over at once.
            assert self.word(LPSPI4.TCR) & 0xFFF == 15, "a sensor takes 16 bits"
            self.answers.append(self.exchange(value & 0xFFFF))
        return self.keep(address, value)

    def has_fault(self) -> bool:
        """Whether fault 0 of PWM2, output 49 of the crossbar ("XBARA1_SEL24"), is its input 9, that one the pad EMC_07, and
        at the level of a fault."""
        is_wired = self.word(XBAR1.SEL24) >> 8 & 0x7F == 9 and not self.is_lost(XBAR1.base)
        is_input = self.word(IOMUXC + EMC_07) & 0xF == 3 and not self.word(XBAR1_IN09) & 1
        is_input &= not self.word(GPR.GPR6) >> 25 & 1
        return bool(is_wired and is_input and self.fault_level() == self.word(PWM2.FCTRL0) >> 12 & 1)

    def ends_widths(self) -> bool:
        """A fault ends them, and they come back by FAUTO and FFULL alone; every output listens to it after reset ("Fault
        disable mapping")."""
        comes_back = self.word(PWM2.FCTRL0) >> 8 & 1 and self.word(PWM2.FCTRL0) >> 20 & 1
        self.was_fault |= self.has_fault()
        self.was_fault &= not comes_back or self.has_fault()
        return self.was_fault

    def is_counting(self) -> bool:
        """It runs freely, of the undivided bus's clock ("GPT_CR": EN, CLKSRC 1, FRR)."""
        control = self.word(GPT[0].CR)
        return bool(control & 1) and control >> 6 & 7 == 1 and bool(control >> 9 & 1) and not self.word(GPT[0].PR)

    def counts_at_a_halt(self) -> bool:
        """Whether it goes on while a debugger halts the core ("GPT_CR": DBGEN)."""
        return bool(self.word(GPT[0].CR) >> 2 & 1)

    def counter_clock(self) -> float:
        return self.bus_clock()

    def submodule(self, address: int) -> int:
        return (address - PWM2.base) // SUBMODULE

    def is_buffered(self, address: int) -> bool:
        """Whether a register is one that LDOK loads."""
        return 0 <= self.submodule(address) < 4 and (address - PWM2.base) % SUBMODULE in BUFFERED

    def write_load(self, value: int) -> int:
        """LDOK goes up when it is written as 1, and down by CLDOK or once its values are loaded ("MCTRL")."""
        for number in range(4):
            if value >> 8 + number & 1:
                self.runs.setdefault(number, self.machine.cycles)
            else:
                self.runs.pop(number, None)
            if value >> 4 + number & 1:
                self.waits.pop(number, None)
            elif value >> number & 1 and not self.waits_for_reload(number):
                self.waits[number] = self.machine.cycles
        return value & ~0xFF

    def period(self, number: int) -> int:
        """Of a submodule, which counts from 0 to VAL1, in the core's cycles."""
        base = PWM2.base + SUBMODULE * number
        return (self.word(base + 0xC) >> 16) + 1 << (self.word(base + 4) >> 20 & 7) << TO_PWM // 2

    def count(self, number: int) -> int:
        """Where its counter is."""
        since = (self.machine.cycles - self.runs[number]) % self.period(number)
        return since * ((self.word(PWM2.base + SUBMODULE * number + 0xC) >> 16) + 1) // self.period(number)

    def waits_for_reload(self, number: int) -> bool:
        """Whether LDOK is up: until the counter comes round, if it runs."""
        since, began = self.waits.get(number), self.runs.get(number)
        if since is None or began is None:
            return since is not None
        rounds = [(when - began) // self.period(number) for when in (max(since, began), self.machine.cycles)]
        if rounds[0] < rounds[1]:
            del self.waits[number]
        return number in self.waits

    def write_watchdog(self, address: int, value: int) -> int:
        """It is opened for a moment, if updates are allowed, and takes one configuration ("RTWDOG, configuring")."""
        status = self.word(WDOG3.CS)
        is_open = self.open_until is not None and self.machine.cycles <= self.open_until
        if address == WDOG3.CNT:
            if value == UNLOCK and status >> UPDATE & 1:
                self.open_until = self.machine.cycles + OPEN
                self.keep(WDOG3.CS, status & ~(1 << RCS) | 1 << ULK)
            return value
        if not is_open:
            return self.word(address)
        if address == WDOG3.CS:
            self.open_until = None
            value = value & ~(1 << ULK) | 1 << RCS
        return self.keep(address, value)

    def write_converter(self, address: int, value: int) -> int:
        """Whatever is written while it calibrates ends that, without a result ("Calibration function")."""
        if self.calibrated_at is not None:
            self.calibrate()
        if self.calibrated_at is not None:
            self.calibrated_at = None
            self.keep(ADC1.GS, self.word(ADC1.GS) | 2)
            value &= ~(1 << 7) if address == ADC1.GC else 0xFFFF_FFFF
        elif address == ADC1.GC and value >> 7 & 1:
            self.calibrated_at, self.is_calibrated = self.machine.cycles + CALIBRATION, False
        elif address == ADC1.GS:
            # CALF is cleared by writing 1.
            value = self.word(address) & ~value
        return self.keep(address, value)

    def calibrate(self) -> None:
        """CAL goes down when it is done."""
        if self.calibrated_at is not None and self.machine.cycles >= self.calibrated_at:
            self.calibrated_at, self.is_calibrated = None, True
            self.keep(ADC1.GC, self.word(ADC1.GC) & ~(1 << 7))

    def core_clock(self) -> float:
        """The core's clock, Hz ("CCM clock tree"): PLL1, which makes half of `DIV_SELECT` crystals, divided twice."""
        bus, multiplexer = self.word(CCM.CBCDR), self.word(CCM.CBCMR)
        assert not bus >> 25 & 1 and multiplexer >> 18 & 3 == 3, "of the divided PLL1"
        pll = CRYSTAL * (self.word(ANALOG.PLL_ARM) & 0x7F) / 2
        return pll / ((self.word(CCM.CACRR) & 7) + 1) / ((bus >> 10 & 7) + 1)

    def bus_clock(self) -> float:
        """IPG, Hz."""
        return self.core_clock() / ((self.word(CCM.CBCDR) >> 8 & 3) + 1)

    def timer_clock(self) -> float:
        """PERCLK, Hz, which the periodic timer counts."""
        choice = self.word(CCM.CSCMR1)
        return (CRYSTAL if choice >> 6 & 1 else self.bus_clock()) / ((choice & 0x3F) + 1)

    def tick_rate(self) -> float:
        """The timer counts down from LDVAL to 0."""
        return self.timer_clock() / (self.word(PIT.LDVAL0) + 1)

    def baud(self) -> float:
        """Of the crystal, divided; `OSR + 1` samples a bit ("LPUART baud rate generation")."""
        choice, baud = self.word(CCM.CSCDR1), self.word(LPUART6.BAUD)
        samples = (baud >> 24 & 0x1F) + 1
        assert choice >> 6 & 1, "of the crystal"
        # With 4 to 7 samples both edges have to be used.
        assert samples > 7 or baud >> 17 & 1
        return CRYSTAL / ((choice & 0x3F) + 1) / samples / (baud & 0x1FFF)

    def sensor_clock(self) -> float:
        """The clock of the sensors' bus, Hz ("LPSPI_CCR", "LPSPI_TCR")."""
        choice = self.word(CCM.CBCMR)
        assert choice >> 4 & 3 == 2, "of PLL2"
        clock = SYSTEM_PLL / ((choice >> 26 & 7) + 1)
        return clock / (1 << (self.word(LPSPI4.TCR) >> 27 & 7)) / ((self.word(LPSPI4.CCR) & 0xFF) + 2)
