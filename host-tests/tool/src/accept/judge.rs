//! The expected figures.

use super::{Check, ExpectedLine, Found};
use palpate::servo::ResetReason;
use palpate::wire::acceptance::{Counted, Failure, Line, Ticks, panel};
use palpate_bench::OptionBytes;

/// Maximum deviation of a period, as a fraction of it. The servo's interrupt waits only for the running instruction and
/// for cache misses: 5 µs of 250 are generous.
const JITTER: f64 = 0.02;
/// How far the mean rate may be off, by the device's own clock, from which its timer runs too: a count of a period.
const RATE: f64 = 1e-4;
/// How far the device's clock may be from the host's: 1 % of a chip's own oscillator, and as much for the host's line.
const CLOCK: f64 = 0.02;
/// Maximum length of a tick, as a fraction of its period: the rest is for cases that the script does not contain.
const TICK: f64 = 0.75;
/// Bad sensor frames: at most one in this number of ticks.
const TICKS_PER_BAD_FRAME: f64 = 10_000.0;
/// The loop bridges this number in a row; the next one would be its fault.
const BRIDGED: u32 = palpate::servo::FrameBridge::<1>::DEFAULT_IN_A_ROW;

/// The facts about a device beyond its own answers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surroundings<'a> {
    /// It is emulated: it has no sensors, and its time is not the host's.
    pub emulated: bool,
    /// It has no sensors yet.
    pub bare: bool,
    /// Of the same script, what an emulated core of the same kind counted.
    pub counted: Option<&'a [Line]>,
}

/// The name of a core, and what the cycles of a tick may be in instructions: less would be a counter that does not
/// count, more is memory that makes the core wait.
const fn core(id: u32) -> Option<(&'static str, [f64; 2])> {
    match (id >> 4) & 0xfff {
        0xc24 => Some(("Cortex-M4", [1.0, 2.0])),
        0xc27 => Some(("Cortex-M7", [0.5, 2.5])),
        0xd21 => Some(("Cortex-M33", [1.0, 2.0])),
        _ => None,
    }
}

/// Judges what was found by what was to be expected.
pub fn judge(found: &Found, expected: &[ExpectedLine], around: &Surroundings<'_>) -> Vec<Check> {
    let mut checks = vec![who(found), reset(found), options(found), table(found), state_hash(found, expected)];
    checks.push(script(found, expected));
    checks.push(cycles(found, expected, around));
    checks.extend(timing(found, around));
    checks.push(sensors(found, around));
    checks.push(line(found));
    checks.extend(found.failures.iter().map(|(failure, reset)| provoked(*failure, *reset)));
    if let Some(reason) = &found.broken_off {
        // A cell of a table has neither lines nor bars.
        let reason = reason.replace(['|', '\n'], " ");
        checks.push(Check::new("to the end", reason, "everything is asked and answered", false));
    }
    checks
}

fn who(found: &Found) -> Check {
    let id = found.identity.core;
    let name = core(id).map_or("a core that is not known", |(name, _)| name);
    Check::new("core", format!("{name} ({id:#010x})"), "a core that palpate is tested on", core(id).is_some())
}

/// A reset reason's word.
fn reset_word(number: u8) -> String {
    let reason = ResetReason::ALL.into_iter().find(|reason| *reason as u8 == number);
    reason.map_or_else(|| format!("number {number}, which is none"), |reason| format!("{reason:?}"))
}

fn reset(found: &Found) -> Check {
    let number = found.identity.reset;
    let reason = ResetReason::ALL.into_iter().find(|reason| *reason as u8 == number);
    let holds = reason.is_some_and(|reason| reason.fault().is_none());
    Check::new("reset reason", reset_word(number), "no watchdog, brown-out, panic or exception", holds)
}

fn options(found: &Found) -> Check {
    let (options, must) = (OptionBytes(found.identity.options), "a watchdog that goes on in Stop mode");
    if options == OptionBytes::default() {
        return Check::not_here("option bytes", "none", must);
    }
    let remedy = options.refused().map(|remedy| format!("; set {remedy}, without it the board drives nothing"));
    let holds = remedy.is_none();
    Check::new("option bytes", format!("{options}{}", remedy.unwrap_or_default()), must, holds)
}

fn table(found: &Found) -> Check {
    let (table, baked) = (found.identity.table, found.identity.baked);
    if baked == 0 {
        return Check::not_here("table CRC", format!("{table:08x}"), "as baked, and these tables carry none");
    }
    let holds = table == baked;
    Check::new("table CRC", format!("{table:08x}"), format!("{baked:08x}, as baked"), holds)
}

/// One number for the whole script: of the last line of each lap.
fn hash(digests: impl Iterator<Item = u32>) -> u32 {
    digests.fold(0, |hash: u32, digest| (hash.rotate_left(5) ^ digest).wrapping_mul(0x0100_0193))
}

fn state_hash(found: &Found, expected: &[ExpectedLine]) -> Check {
    let last = |index: &usize| expected[*index].is_last;
    let ours = hash((0..expected.len()).filter(last).map(|index| expected[index].tally.digest));
    let theirs = (0..expected.len()).filter(last).filter_map(|index| found.lines.get(index));
    let theirs = hash(theirs.map(|line| line.digest));
    Check::new("state hash", format!("{theirs:08x}"), format!("{ours:08x}, as on the host"), theirs == ours)
}

/// Where the device and the host part.
fn script(found: &Found, expected: &[ExpectedLine]) -> Check {
    let must = "every line of the script as on the host";
    let mut ticks = 0;
    let mut before = 0;
    for (number, line) in expected.iter().enumerate() {
        let lap = line.lap;
        let Some(theirs) = found.lines.get(number) else {
            return Check::new("script", format!("it ended before tick {} of lap {lap}", before + 1), must, false);
        };
        let [ours, theirs] = [key(line), key_of(theirs)];
        if ours != theirs || found.lines[number].number as usize != number {
            let differs = ["ticks", "digest", "modes", "phases", "faults", "ticks in contact"]
                .into_iter()
                .zip(ours.into_iter().zip(theirs))
                .filter(|(_, (ours, theirs))| ours != theirs)
                .map(|(name, (ours, theirs))| format!("{name} {theirs:x} instead of {ours:x}"))
                .collect::<Vec<_>>();
            let between = format!("between ticks {} and {}", before + 1, line.tally.ticks);
            let text = format!("a wrong bit in lap {lap}, {between}: {}", differs.join(", "));
            return Check::new("script", text, must, false);
        }
        before = if line.is_last { 0 } else { line.tally.ticks };
        ticks += if line.is_last { line.tally.ticks } else { 0 };
    }
    let holds = found.lines.len() == expected.len();
    Check::new("script", format!("{ticks} ticks in {} lines agree", found.lines.len()), must, holds)
}

fn key(ExpectedLine { tally, .. }: &ExpectedLine) -> [u32; 6] {
    [tally.ticks, tally.digest, tally.modes, tally.phases, tally.faults, tally.touching]
}

fn key_of(line: &Line) -> [u32; 6] {
    [line.ticks, line.digest, line.modes, line.phases, line.faults, line.touching]
}

/// The longest tick of each lap, and of all.
fn cycles(found: &Found, expected: &[ExpectedLine], around: &Surroundings<'_>) -> Check {
    let name = "longest tick of the script";
    let identity = &found.identity;
    let longest = |lines: &[Line]| lines.iter().map(|line| line.longest).max().unwrap_or(0);
    let theirs = longest(&found.lines);
    if identity.counted == Counted::Instructions {
        let text = format!("{theirs} instructions; the emulator has no cycles (no DWT)");
        return Check::not_here(name, text, "cycles of a core");
    }
    let period = f64::from(identity.clock) / f64::from(identity.rate);
    let (low, high) = core(identity.core).map_or((0.0, f64::INFINITY), |(_, [low, high])| (low, high));
    let is_short = f64::from(theirs) <= TICK * period;
    let Some(counted) = around.counted else {
        let text = format!("{theirs} cycles; nobody counted instructions beside them");
        return Check::new(name, text, format!("at most {:.0} cycles", TICK * period), is_short && theirs > 0);
    };
    // Lap by lap, for a wait state shows in one sooner than in another.
    let ratios: Vec<(&str, f64)> = (expected.iter().zip(&found.lines).zip(counted))
        .filter(|((line, _), counted)| line.is_last && counted.longest > 0)
        .map(|((line, theirs), counted)| (line.lap, f64::from(theirs.longest) / f64::from(counted.longest)))
        .collect();
    let outside = ratios.iter().find(|(_, ratio)| !(low..=high).contains(ratio));
    let (least, most) = ratios.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), (_, r)| (a.min(*r), b.max(*r)));
    let culprit = outside.map(|(lap, _)| format!(", lap {lap} outside")).unwrap_or_default();
    let text = format!(
        "{theirs} cycles for {} instructions; {least:.2} to {most:.2} cycles an instruction{culprit}",
        longest(counted)
    );
    let must = format!("{low} to {high} cycles an instruction, and at most {:.0} cycles", TICK * period);
    Check::new(name, text, must, is_short && outside.is_none() && !ratios.is_empty())
}

/// Rate, periods, duration of the device's own ticks.
fn timing(found: &Found, around: &Surroundings<'_>) -> Vec<Check> {
    let identity = &found.identity;
    let (clock, rate) = (f64::from(identity.clock), f64::from(identity.rate));
    let period = clock / rate;
    let microseconds = |counts: f64| counts / clock * 1e6;
    let [Some(first), Some(last)] = [found.ticks.first(), found.ticks.last()] else {
        return vec![Check::new("rate", "no ticks".to_owned(), format!("{rate} Hz"), false)];
    };
    // The first frame tells of what was before.
    let after = &found.ticks[1..];
    let counts: f64 = found.ticks.windows(2).map(|pair| f64::from(pair[1].began.wrapping_sub(pair[0].began))).sum();
    let ticks = f64::from(last.ticks.wrapping_sub(first.ticks));
    let mean = if counts > 0.0 { ticks * clock / counts } else { 0.0 };
    let seconds = counts / clock;

    let mut checks = vec![Check::new(
        "rate",
        format!("{mean:.3} Hz over {seconds:.1} s"),
        format!("{rate} Hz within {:.2} %", RATE * 100.0),
        (mean / rate - 1.0).abs() <= RATE,
    )];
    let by_host = seconds / found.seconds;
    let must = format!("the host's within {:.0} %", CLOCK * 100.0);
    checks.push(if around.emulated {
        Check::not_here("clock", "emulated time is not the host's", must)
    } else {
        // A frame may wait a tenth of a second for the next.
        let off = (by_host - 1.0).abs();
        Check::new("clock", format!("{:+.2} %", (by_host - 1.0) * 100.0), must, off <= CLOCK + 0.1 / found.seconds)
    });
    let of = |figure: fn(&Ticks) -> u32| after.iter().map(figure).map(f64::from);
    let shortest = of(|ticks| ticks.shortest).fold(f64::INFINITY, f64::min);
    let longest = of(|ticks| ticks.longest).fold(0.0, f64::max);
    let late = after.iter().filter(|ticks| f64::from(ticks.longest) > (1.0 + JITTER) * period).count();
    let among =
        if late > 0 { format!("; a late tick in {late} of {} tenths of a second", after.len()) } else { String::new() };
    checks.push(Check::new(
        "jitter",
        format!("periods of {:.2} to {:.2} µs{among}", microseconds(shortest), microseconds(longest)),
        format!("{:.2} µs within {:.0} %", microseconds(period), JITTER * 100.0),
        shortest >= (1.0 - JITTER) * period && longest <= (1.0 + JITTER) * period,
    ));
    let took = of(|ticks| ticks.took).fold(0.0, f64::max);
    checks.push(Check::new(
        "own tick",
        format!("{:.2} µs at most, without the drives", microseconds(took)),
        format!("at most {:.2} µs", microseconds(TICK * period)),
        took > 0.0 && took <= TICK * period,
    ));
    let overruns = last.overruns.wrapping_sub(first.overruns);
    checks.push(Check::new("overruns", overruns.to_string(), "0", overruns == 0));
    checks
}

fn sensors(found: &Found, around: &Surroundings<'_>) -> Check {
    let name = "sensors";
    let must = format!("at most one bad frame in {TICKS_PER_BAD_FRAME} ticks, {BRIDGED} in a row");
    let [Some(first), Some(last)] = [found.ticks.first(), found.ticks.last()] else {
        return Check::new(name, "no ticks".to_owned(), must, false);
    };
    if around.emulated {
        return Check::not_here(name, "the emulated board has none", must);
    }
    let ticks = last.ticks.wrapping_sub(first.ticks);
    let [absent, damaged, jumped, magnet, frozen] =
        [0, 1, 2, 3, 4].map(|kind| last.bad[kind].wrapping_sub(first.bad[kind]));
    let bad = absent + damaged + jumped + magnet + frozen;
    let supply = if last.supply > 0 { format!("{:.1} V", f64::from(last.supply) / 1e3) } else { "none".to_owned() };
    let gain = last.gains.iter().max().filter(|gain| **gain > 0);
    let gain = gain.map(|gain| format!("magnet gain {gain} of 255 at most, ")).unwrap_or_default();
    let is = |bit: u8, word: &str, other: &str| if last.panel & bit != 0 { word.to_owned() } else { other.to_owned() };
    let text = format!(
        "of {ticks} frames {absent} did not come, {damaged} came damaged, {jumped} jumped, {magnet} with a bad magnet, {frozen} frozen, {} in a row; {gain}{}, {}, {}, supply {supply}",
        last.in_a_row,
        is(panel::ENABLE, "enable pressed", "enable released"),
        is(panel::STOP, "stop pressed", "stop released"),
        is(panel::READY, "ready", "not ready"),
    );
    if around.bare {
        return Check::not_here(name, text, must);
    }
    let holds = f64::from(bad) * TICKS_PER_BAD_FRAME <= f64::from(ticks) && last.in_a_row <= BRIDGED;
    Check::new(name, text, must, holds)
}

fn line(found: &Found) -> Check {
    let missing = found.ticks.windows(2).map(|pair| pair[1].number.wrapping_sub(pair[0].number) - 1).sum::<u32>();
    let text = format!("{missing} frames lost, {} damaged", found.damaged);
    Check::new("line", text, "none: what was lost was not judged", missing == 0 && found.damaged == 0)
}

fn provoked(failure: Failure, reset: u8) -> Check {
    let (name, reason) = match failure {
        Failure::Hang => ("reset after a hang", ResetReason::Watchdog),
        Failure::Panic => ("reset after a panic", ResetReason::Panic),
        Failure::Exception => ("reset after an exception", ResetReason::Exception),
    };
    Check::new(name, reset_word(reset), format!("{reason:?}"), reset == reason as u8)
}
