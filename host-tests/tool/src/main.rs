//! The host tool of palpate: `cargo palpate COMMAND`.

use clap::{Parser, Subcommand};
use palpate_tool::commands::{
    accept, bake, budgets, c_library, check, closest, commission, cycles, demo, device, faults, feel, figures,
    firmware, image, import, monitor, page, pair, parts, race, sim, talk, test, wheel, zwidth,
};
use palpate_tool::unread;
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "palpate", version, about = "Feel a CAD surface from a haptic device's own microcontroller")]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Demo(demo::Arguments),
    Accept(accept::Arguments),
    Commission(commission::Arguments),
    Device(device::Arguments),
    Feel(feel::Arguments),
    Test(test::Arguments),
    Wheel(wheel::Arguments),
    Check(check::Arguments),
    Bake(bake::Arguments),
    Budgets(budgets::Arguments),
    CLibrary(c_library::Arguments),
    Cycles(cycles::Arguments),
    Faults(faults::Arguments),
    Closest(closest::Arguments),
    Sim(sim::Arguments),
    Figures(figures::Arguments),
    Firmware(firmware::Arguments),
    Image(image::Arguments),
    Import(import::Arguments),
    Monitor(monitor::Arguments),
    Page(page::Arguments),
    Pair(pair::Arguments),
    Parts(parts::Arguments),
    Talk(talk::Arguments),
    Zwidth(zwidth::Arguments),
    Race(race::Arguments),
    #[command(hide = true)]
    RunTest(test::RunTestArguments),
    View(page::ViewArguments),
}

fn main() -> ExitCode {
    let command = CommandLine::parse().command;
    // Bad input and failures end with 2: 0 and 1 are verdicts (see `check`).
    unread::run(|| run(command)).unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::from(2)
    })
}

fn run(command: Command) -> anyhow::Result<ExitCode> {
    match command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Accept(arguments) => accept::run(&arguments),
        Command::Commission(arguments) => commission::run(&arguments),
        Command::Feel(arguments) => feel::run(&arguments),
        Command::Device(arguments) => device::run(&arguments),
        Command::Test(arguments) => test::run(&arguments),
        Command::Wheel(arguments) => wheel::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Bake(arguments) => bake::run(&arguments),
        Command::Budgets(arguments) => budgets::run(&arguments),
        Command::CLibrary(arguments) => c_library::run(&arguments),
        Command::Cycles(arguments) => cycles::run(&arguments),
        Command::Faults(arguments) => Ok(faults::run(&arguments)),
        Command::Closest(arguments) => closest::run(&arguments),
        Command::Sim(arguments) => sim::run(&arguments),
        Command::Figures(arguments) => figures::run(&arguments),
        Command::Firmware(arguments) => firmware::run(&arguments),
        Command::Image(arguments) => image::run(&arguments),
        Command::Import(arguments) => import::run(&arguments),
        Command::Monitor(arguments) => monitor::run(&arguments),
        Command::Page(arguments) => page::run(&arguments),
        Command::Pair(arguments) => pair::run(&arguments),
        Command::Parts(arguments) => parts::run(&arguments),
        Command::Talk(arguments) => talk::run(&arguments),
        Command::Zwidth(arguments) => zwidth::run(&arguments),
        Command::Race(arguments) => race::run(&arguments),
        Command::RunTest(arguments) => test::run_test(&arguments),
        Command::View(arguments) => page::view(&arguments),
    }
}
