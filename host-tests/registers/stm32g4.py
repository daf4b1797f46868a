"""What the registers of an STM32G474 answer: our reading of its reference manual, RM0440. No silicon was asked.

A register remembers what was written, if its peripheral has a clock. What answers otherwise is here, with the section
of the manual that says so; a register's own is named like the register.
"""

from __future__ import annotations

import unicorn
from unicorn import arm_const

from chip import Block, Chip
from core import Stuck

RCC = Block(
    "RCC", 0x4002_1000, CR=0, CFGR=8, PLLCFGR=0xC, AHB1ENR=0x48, AHB2ENR=0x4C, APB1ENR1=0x58, APB2ENR=0x60, CCIPR=0x88,
    CSR=0x94,
)  # fmt: skip
FLASH = Block("FLASH", 0x4002_2000, ACR=0, KEYR=8, SR=0x10, CR=0x14, ECCR=0x18, OPTR=0x20)
# The second bank, a page of it; what opens FLASH_CR, and its bits; a status that says busy ("FLASH_SR").
BANK_2, BANK_SIZE, PAGE = 0x0804_0000, 0x4_0000, 0x800
KEYS = [0x4567_0123, 0xCDEF_89AB]
PG, PER, PNB, BKER, STRT, LOCK, BSY = 1, 1 << 1, 3, 1 << 11, 1 << 16, 1 << 31, 1 << 16
# Seconds that a page takes to be erased, and a double word to be written, at most (STM32G474 data sheet, "Flash memory
# characteristics": 24.5 ms, 0.09 ms).
ERASING, WRITING = 0.025, 0.000_09
# Bits of ECCR: a word beyond mending, of the second bank.
ECCD, BK_ECC = 1 << 31, 1 << 21
# Bits of the option bytes: two banks; start in the second; parity of SRAM is not checked; Stop mode resets nothing, and
# the watchdog goes on in it.
DBANK, BFB2, SRAM_PE, NRST_STOP, IWDG_STOP = 1 << 22, 1 << 20, 1 << 24, 1 << 12, 1 << 17
DELIVERED = 0xFFEF_F8AA
PWR = Block("PWR", 0x4000_7000, CR1=0, CR2=4, CR3=8, SR2=0x14, CR5=0x80)
GPIO = {
    port: Block(
        f"GPIO{port}", 0x4800_0000 + 0x400 * number,
        MODER=0, OTYPER=4, PUPDR=0xC, IDR=0x10, ODR=0x14, BSRR=0x18, AFRL=0x20, AFRH=0x24, BRR=0x28,
    )
    for number, port in enumerate("ABCDEFG")
}  # fmt: skip
TIM1, TIM2, TIM3, TIM4, TIM5, TIM7 = (
    Block(
        f"TIM{number}", base, CR1=0, SMCR=8, DIER=0xC, SR=0x10, CCMR1=0x18, CCMR2=0x1C, CCER=0x20, CNT=0x24, PSC=0x28, ARR=0x2C,
        EGR=0x14, CCR1=0x34, CCR2=0x38, CCR3=0x3C, CCR4=0x40, BDTR=0x44,
    )
    for number, base in ((1, 0x4001_2C00), (2, 0x4000_0000), (3, 0x4000_0400), (4, 0x4000_0800), (5, 0x4000_0C00),
                         (7, 0x4000_1400))
)  # fmt: skip
TIMERS = (TIM1, TIM2, TIM3, TIM4, TIM5, TIM7)
# The registers that catch a count, each with its timer, and their flags in SR.
CAUGHT = {TIM2.CCR3: TIM2, TIM3.CCR3: TIM3, TIM4.CCR4: TIM4}
CATCHES = {TIM2.CCR3: 1 << 3, TIM3.CCR3: 1 << 3, TIM4.CCR4: 1 << 4}
LPTIM1 = Block("LPTIM1", 0x4000_7C00, CR=0x10, ARR=0x18, CNT=0x1C)
SYSCFG = Block("SYSCFG", 0x4001_0000, CFGR2=0x1C)
# What SYSCFG connects to the break of TIM1 ("SYSCFG_CFGR2": CLL, SPL, PVDL, ECCL); bits of its BDTR.
LOCKUP, PARITY, SUPPLY, DAMAGE = 0, 1, 2, 3
OSSI, BKE, BKP, MOE = 10, 12, 13, 15
USART2 = Block("USART2", 0x4000_4400, CR1=0, BRR=0xC, ISR=0x1C, RDR=0x24, TDR=0x28)
SPI1 = Block("SPI1", 0x4001_3000, CR1=0, CR2=4, SR=8, DR=0xC)
DBGMCU = Block("DBGMCU", 0xE004_2000, APB1FZR1=8, APB2FZR=0x10)
IWDG = Block("IWDG", 0x4000_3000, KR=0, PR=4, RLR=8, SR=0xC, WINR=0x10)
ADC1, ADC2 = (
    Block(name, base, ISR=0, CR=8, CFGR=0xC, SMPR2=0x18, SQR1=0x30, DR=0x40, JSQR=0x4C, JDR1=0x80, JDR2=0x84, CCR=0x308 - at)
    for name, base, at in (("ADC1", 0x5000_0000, 0), ("ADC2", 0x5000_0100, 0x100))
)
# Hz; what starts the watchdog, opens its registers and feeds it ("IWDG key register").
HSI, LSI, STARTS, OPENS, FEEDS = 16e6, 32_000, 0xCCCC, 0x5555, 0xAAAA
# Bits of a converter's orders ("ADC control register").
ADEN, ADDIS, ADSTART, JADSTART, ADCAL, ADVREGEN, JAUTO = 0, 1, 2, 3, 31, 28, 25

# The bit of RCC_CSR for each reason; the pin's own is always up.
REASONS = {"power": 27, "software": 28, "watchdog": 29, "window": 30}
# Which bit gives which peripheral its clock ("RCC peripheral clock enable registers").
CLOCKS = {
    FLASH.base: (RCC.AHB1ENR, 8),
    PWR.base: (RCC.APB1ENR1, 28),
    TIM1.base: (RCC.APB2ENR, 11),
    SYSCFG.base: (RCC.APB2ENR, 0),
    SPI1.base: (RCC.APB2ENR, 12),
    TIM2.base: (RCC.APB1ENR1, 0),
    TIM3.base: (RCC.APB1ENR1, 1),
    TIM4.base: (RCC.APB1ENR1, 2),
    TIM5.base: (RCC.APB1ENR1, 3),
    TIM7.base: (RCC.APB1ENR1, 5),
    USART2.base: (RCC.APB1ENR1, 17),
    LPTIM1.base: (RCC.APB1ENR1, 31),
    ADC1.base: (RCC.AHB2ENR, 13),
    **{port.base: (RCC.AHB2ENR, number) for number, port in enumerate(GPIO.values())},
}


def peripheral(address: int) -> int:
    """The base of the peripheral that a register belongs to."""
    return ADC1.base if ADC1.base <= address < ADC1.base + 0x400 else address & ~0x3FF


class Stm32g4(Chip):
    """The chip. What is around it answers `level_outside`, `reading`, `count` and `exchange`."""

    CORE = arm_const.UC_CPU_ARM_CORTEX_M4
    MEMORY = ((0x0800_0000, 0x8_0000), (0x1000_0000, 0x8000), (0x2000_0000, 0x2_0000))
    REGISTERS = ((0x4000_0000, 0x3_0000), (0x4200_0000, 0x60_0000), (0x4800_0000, 0x2000), (0x5000_0000, 0x10_0000))
    VECTORS = 0x0800_0000
    # The share of its reference that a good converter does not measure.
    IMPLAUSIBLE = 0.8
    # 32 bits of a timer's clock, which is the core's.
    COUNTER = TIM5.CNT
    RESET = {
        RCC.CR: 0x500,
        RCC.CFGR: 0x5,
        RCC.PLLCFGR: 0x1000,
        RCC.AHB1ENR: 0x100,
        RCC.APB1ENR1: 0x400,
        FLASH.ACR: 0x4_0600,
        FLASH.CR: 0xC000_0000,
        # As the chip is delivered, but of one bank: parity is not checked.
        FLASH.OPTR: DELIVERED & ~DBANK,
        PWR.CR1: 0x200,
        PWR.CR3: 0x8000,
        PWR.CR5: 0x100,
        SPI1.CR2: 0x700,
        IWDG.RLR: 0xFFF,
        IWDG.WINR: 0xFFF,
        ADC1.CR: 0x2000_0000,
        ADC2.CR: 0x2000_0000,
        **{port.MODER: 0xFFFF_FFFF for port in GPIO.values()},
        GPIO["A"].MODER: 0xABFF_FFFF,
        GPIO["B"].MODER: 0xFFFF_FEBF,
        GPIO["A"].PUPDR: 0x6400_0000,
        GPIO["B"].PUPDR: 0x100,
        **{timer.ARR: 0xFFFF for timer in TIMERS},
        TIM2.ARR: 0xFFFF_FFFF,
        TIM5.ARR: 0xFFFF_FFFF,
    }

    def reset(self, machine, **reasons: bool) -> None:
        """Every reset pulls the pin too ("System reset"); power-on raises the flag of a brown-out ("RCC_CSR")."""
        self.machine, self.stands_since = machine, None
        self.keep(RCC.CSR, 1 << 26 | sum(1 << REASONS[reason] for reason, is_so in reasons.items() if is_so))
        self.received, self.sent, self.answers = bytearray(), bytearray(), bytearray()
        # What the converter measures of its own reference, 1.212 V of 3.3 V; whether conversions end.
        self.reference, self.converts = round(1.212 / 3.3 * 4_095), True
        # The slow oscillator, as a share of what it should make; whether the sensor's bus ends its frames.
        self.slow, self.finishes = 1.0, True
        # What has failed of what SYSCFG connects to the break.
        self.failures = 0
        # The keys that came, until when flash is busy (cycles), and the first word of a double word.
        self.keys, self.busy_until, self.half = [], 0, None
        # Whether the break works, and pins that something outside holds high.
        self.ends_widths, self.shorted = True, set()

    def is_lost(self, address: int) -> bool:
        """A peripheral without its clock takes nothing and gives nothing ("Peripheral clock enable registers")."""
        gate = CLOCKS.get(peripheral(address))
        return gate is not None and not self.word(gate[0]) >> gate[1] & 1

    def alias(self, address: int, value: int, mask: int) -> tuple[int, int, int]:
        """A word of the bit band is a bit of the peripherals (ARM DDI 0439, "Bit-banding")."""
        if not 0x4200_0000 <= address < 0x4400_0000:
            return address, value, mask
        offset, bit = divmod((address - 0x4200_0000) // 4, 32)
        return 0x4000_0000 + 4 * offset, (value & 1) << bit, 1 << bit

    def read(self, address: int) -> int:
        value = self.word(address)
        if address == RCC.CR:
            # HSIRDY, HSERDY and PLLRDY follow HSION, HSEON and PLLON.
            for on in (8, 16, 24):
                ready = {8: 10, 16: 17, 24: 25}[on]
                value = value & ~(1 << ready) | (value >> on & 1) << ready
        elif address == RCC.CFGR:
            # SWS follows SW.
            value = value & ~0xC | (value & 3) << 2
        elif address == ADC1.DR:
            # Reading it takes EOC down.
            self.keep(ADC1.ISR, self.word(ADC1.ISR) & ~4)
            value = self.reading()
        elif address == RCC.CSR:
            # LSIRDY follows LSION.
            value = value & ~2 | (value & 1) << 1
        elif address == LPTIM1.CNT:
            value = self.slow_count()
        elif address == ADC1.JDR1:
            value = self.reference
        elif address == USART2.ISR:
            # TXE and TC; RXNE while something waits; TEACK and REACK.
            value = 0xC0 | bool(self.received) << 5 | 0b11 << 21
        elif address == USART2.RDR and self.received:
            value = self.received.pop(0)
        elif address == SPI1.SR:
            # TXE; RXNE while an answer waits; how many wait, two bits. It is never busy: a byte goes at once.
            value = 2 | (self.finishes and bool(self.answers)) | min(len(self.answers), 3) << 9
        elif address == SPI1.DR:
            value = int.from_bytes(bytes(self.take_answer() for _ in range(self.machine.width)), "little")
        elif address == FLASH.SR:
            value = value & ~BSY | self.is_writing() * BSY
        elif address in (IWDG.SR, PWR.SR2):
            # What was written has been taken; the voltage is there.
            value = 0
        elif address in (TIM2.CNT, TIM3.CNT, TIM4.CNT):
            value = self.count(address)
        elif address in CAUGHT:
            # Reading what was caught takes its flag down ("TIMx status register").
            self.keep(CAUGHT[address].SR, self.word(CAUGHT[address].SR) & ~CATCHES[address])
        else:
            for port, block in GPIO.items():
                if address == block.IDR:
                    value = sum(self.level(port, pin) << pin for pin in range(16))
        return value

    def write(self, address: int, value: int) -> int:
        """Writes, and says what the register holds then."""
        for port in GPIO.values():
            if address in (port.BSRR, port.BRR):
                # Setting wins over clearing.
                sets, clears = (value & 0xFFFF, value >> 16) if address == port.BSRR else (0, value)
                self.keep(port.ODR, self.word(port.ODR) & ~clears | sets)
                return value
        if address in (timer.SR for timer in TIMERS):
            # Flags are cleared by writing 0.
            value &= self.word(address)
        elif address == TIM1.EGR and value >> 7 & 1 and self.ends_widths:
            # "BG: a break event is generated. MOE bit is cleared and BIF flag is set".
            self.keep(TIM1.BDTR, self.word(TIM1.BDTR) & ~(1 << MOE))
            self.keep(TIM1.SR, self.word(TIM1.SR) | 1 << 7)
            value = 0
        elif address == TIM1.BDTR and self.breaks(value):
            # "MOE: cleared by hardware as soon as one of the break inputs is active".
            value &= ~(1 << MOE)
        elif address in (timer.ARR for timer in TIMERS if timer not in (TIM2, TIM5)):
            # 16 bits, and four of a fraction that is not used.
            value &= 0xF_FFFF
        elif address in (ADC1.CR, ADC2.CR):
            # Writing 0 takes back no order, and each is carried out at once: ADDIS ends ADEN, ADSTART brings EOC and
            # EOS, with JAUTO JEOC and JEOS too, as JADSTART does, ADSTP and ADCAL are over. ADRDY follows ADEN.
            converter = ADC1 if address == ADC1.CR else ADC2
            is_on = not value >> ADDIS & 1 and (value | self.word(address)) & 1
            starts = value >> ADSTART & 1, value >> JADSTART & 1 or value >> ADSTART & self.word(converter.CFGR) >> JAUTO & 1
            comes = sum(bits for bits, start in zip((0b1100, 0b110_0000), starts) if start and self.converts)
            self.keep(converter.ISR, self.word(converter.ISR) & ~1 | is_on | comes)
            value = value & 0x7FFF_FFC0 | is_on
        elif address in (ADC1.ISR, ADC2.ISR):
            # Flags are cleared by writing 1.
            value = self.word(address) & ~value
        elif address in (IWDG.PR, IWDG.RLR, IWDG.WINR) and self.word(IWDG.KR) & 0xFFFF != OPENS:
            # Any key but that one closes its registers ("Register access protection").
            value = self.word(address)
        elif address == RCC.CR and self.word(RCC.CFGR) & 3 == 3:
            # PLLON stays while the PLL is the system clock.
            value |= 1 << 24
        elif address == RCC.CSR and value & 1 << 23:
            # RMVF clears the reasons.
            value &= ~(0x1FF << 23)
        elif address == FLASH.KEYR:
            self.keys.append(value)
            if self.keys[-2:] == KEYS:
                self.keep(FLASH.CR, self.word(FLASH.CR) & ~LOCK)
        elif address == FLASH.SR:
            # Flags are cleared by writing 1.
            value = self.word(address) & ~value
        elif address == FLASH.CR:
            value = self.order_flash(value)
        elif address == USART2.TDR:
            self.sent.append(value & 0xFF)
        elif address == SPI1.DR:
            # Of two bytes at once the lower goes first ("Data packing").
            assert self.word(SPI1.CR2) >> 8 & 0xF == 7 and self.word(SPI1.CR1) >> 6 & 1, "it runs, with 8 bits"
            for at in range(self.machine.width):
                self.answers.append(self.exchange(value >> 8 * at & 0xFF))
        return self.keep(address, value)

    def is_writing(self) -> bool:
        """Whether the second bank is being erased or written."""
        return self.machine.cycles < self.busy_until

    def order_flash(self, value: int) -> int:
        """A write to FLASH_CR ("Flash main memory erase sequences"): an erase of a page of the second bank, or none."""
        if self.word(FLASH.CR) & LOCK or self.is_writing():
            return self.word(FLASH.CR)
        if value & STRT:
            if value & (PER | BKER) != PER | BKER:
                raise Stuck("an erase of what is no page of the second bank")
            self.machine.unicorn.mem_write(BANK_2 + (value >> PNB & 0x7F) * PAGE, b"\xff" * PAGE)
            self.busy_until = self.machine.cycles + int(ERASING * self.RATE * self.PERIOD)
        return value & ~STRT

    def watch_flash(self) -> None:
        """From now on the second bank is written as the manual wants it ("Flash main memory programming sequences"), and
        read only while it is not busy: until then whatever reads it would wait."""
        for kind, does in ((unicorn.UC_HOOK_MEM_WRITE, self.write_flash), (unicorn.UC_HOOK_MEM_READ, self.read_flash)):
            self.machine.unicorn.hook_add(kind, does, begin=BANK_2, end=BANK_2 + BANK_SIZE - 1)

    def read_flash(self, _uc, _kind, address: int, _size: int, _value: int, _data) -> None:
        if self.is_writing():
            self.machine.stick(f"{address:#x} is read while its bank is busy")

    def write_flash(self, _uc, _kind, address: int, size: int, value: int, _data) -> None:
        """A double word, which was erased, in two writes one after the other."""
        follows = self.half is not None and address == self.half + 4
        is_first = self.half is None and not address & 7
        is_erased = self.machine.memory(address, 4) == b"\xff" * 4
        is_open = self.word(FLASH.CR) & (PG | LOCK) == PG and not self.is_writing()
        if size != 4 or not (is_first or follows) or not is_erased or not is_open:
            self.machine.stick(f"{address:#x} is written in a way that flash does not take")
        self.half = address if is_first else None
        if follows:
            self.busy_until = self.machine.cycles + int(WRITING * self.RATE * self.PERIOD)

    def is_counting(self) -> bool:
        """It runs, and is not divided."""
        return bool(self.word(TIM5.CR1) & 1) and not self.word(TIM5.PSC)

    def counts_at_a_halt(self) -> bool:
        """Whether it goes on while a debugger halts the core ("DBGMCU APB1 freeze register 1")."""
        return not self.word(DBGMCU.APB1FZR1) >> 3 & 1

    def slow_count(self) -> int:
        """LPTIM1 counts LSI, if it is chosen, on and started ("RCC_CCIPR", "LPTIM_CR"), while the core's time goes by."""
        runs = self.word(RCC.CCIPR) >> 18 & 3 == 1 and self.word(RCC.CSR) & 1 and self.word(LPTIM1.CR) & 5 == 5
        return int(self.machine.cycles * LSI * self.slow / (self.RATE * self.PERIOD)) & 0xFFFF if runs else 0

    def breaks(self, control: int) -> bool:
        """Whether the break of TIM1 is active: PB12 (AF6) at the level of BKP, or what SYSCFG connects."""
        is_wired = self.mode("B", 12) == 2 and self.word(GPIO["B"].AFRH) >> 16 & 0xF == 6
        at_pin = is_wired and self.level("B", 12) == control >> BKP & 1
        return bool(control >> BKE & 1 and (at_pin or self.word(SYSCFG.CFGR2) & self.failures))

    def fail(self, *failures: int) -> None:
        """These fail, or the break input changed: the hardware alone answers."""
        self.failures = sum(1 << failure for failure in failures)
        if self.breaks(self.word(TIM1.BDTR)):
            self.keep(TIM1.BDTR, self.word(TIM1.BDTR) & ~(1 << MOE))

    def take_answer(self) -> int:
        """What came over SPI, in its order."""
        return self.answers.pop(0) if self.answers else 0

    def mode(self, port: str, pin: int) -> int:
        """0 input, 1 output, 2 alternate function, 3 analog."""
        return self.word(GPIO[port].MODER) >> 2 * pin & 3

    def level(self, port: str, pin: int) -> int:
        """What is on a pin: its own output, the level from outside, or its pull."""
        if (port, pin) in self.shorted:
            return 1
        if self.mode(port, pin) == 1:
            return self.word(GPIO[port].ODR) >> pin & 1
        outside = self.level_outside(port, pin)
        return outside if outside is not None else self.word(GPIO[port].PUPDR) >> 2 * pin & 3 == 1

    def core_clock(self, before: int | None = None) -> float:
        """HCLK, Hz ("PLL", "RCC_PLLCFGR", "RCC_CFGR"), as set before an entry of the log, or now."""
        before = len(self.machine.log.entries) if before is None else before
        configuration, pll, switches = (self.machine.log.value(at, before) for at in (RCC.CFGR, RCC.PLLCFGR, RCC.CR))
        system = HSI
        if configuration & 3 == 3:
            assert switches >> 24 & 1 and pll >> 24 & 1 and pll & 3 == 2, "the PLL runs, of HSI, and gives R"
            system = HSI / ((pll >> 4 & 0xF) + 1) * (pll >> 8 & 0x7F) / (2 * (pll >> 25 & 3) + 2)
        divider = configuration >> 4 & 0xF
        return system / (1 if divider < 8 else (2, 4, 8, 16, 64, 128, 256, 512)[divider - 8])

    def timer_clock(self) -> float:
        """Of both buses, which are not divided, and so of their timers ("Clock tree")."""
        assert self.word(RCC.CFGR) >> 8 & 0x3F == 0
        return self.core_clock()
