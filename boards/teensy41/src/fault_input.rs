//! The fault input of the set-points' timer: pin 33, by the crossbar, ends the widths without the program (i.MX RT1060
//! reference manual, "Fault protection"; "XBAR1", output 49). They come back by themselves once it is over.

use imxrt_ral::{ccm, iomuxc, iomuxc_gpr, modify_reg, pwm, read_reg, write_reg, xbara1};
use teensy4_bsp::hal::iomuxc::{Config, Hysteresis, PullKeeper, alternate, configure};
use teensy4_bsp::pins::common::P33;

/// The pin as an input of the crossbar, and which of them.
const ALTERNATE: u32 = 3;
const INPUT: u16 = 9;
/// Fault 0, of four.
const FAULT: u16 = 1;

/// Connects the pin, which is pulled down: without a wire it does nothing. A high level ends the widths, at once and after
/// five samples of 0.2 µs for as long as it lasts. Call it once the outputs run.
pub fn start(mut pin: P33) {
    let pull = Config::zero().set_hysteresis(Hysteresis::Enabled).set_pull_keeper(Some(PullKeeper::Pulldown100k));
    configure(&mut pin, pull);
    alternate(&mut pin, ALTERNATE);
    // SAFETY: set-up alone runs; nobody else uses what is written here.
    let (clocks, pads, choices, crossbar, timer) = unsafe {
        (
            ccm::CCM::instance(),
            iomuxc::IOMUXC::instance(),
            iomuxc_gpr::IOMUXC_GPR::instance(),
            xbara1::XBARA1::instance(),
            pwm::PWM2::instance(),
        )
    };
    modify_reg!(ccm, clocks, CCGR2, CG11: 0b11);
    write_reg!(iomuxc, pads, XBAR1_IN09_SELECT_INPUT, 0);
    modify_reg!(iomuxc_gpr, choices, GPR6, IOMUXC_XBAR_DIR_SEL_9: 0);
    modify_reg!(xbara1, crossbar, SEL24, SEL49: INPUT);
    write_reg!(pwm, timer, FFILT0, FILT_PER: 30, FILT_CNT: 2);
    modify_reg!(pwm, timer, FCTRL0, FAUTO: FAULT);
    // Without it a fault that is over goes on; with the flags of all four cleared.
    write_reg!(pwm, timer, FSTS0, FFULL: FAULT, FFLAG: 0xf);
}

/// Whether the input ends the widths now.
pub fn is_active() -> bool {
    // SAFETY: read alone.
    let timer = unsafe { pwm::PWM2::instance() };
    read_reg!(pwm, timer, FSTS0, FFPIN) & FAULT != 0
}
