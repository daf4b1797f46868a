//! `palpate firmware`: cargo for the boards.

use super::felt::Felt;
use super::output::write_whole;
use super::suits::{homing_instead, suits};
use super::{bake, long_calls, options};
use crate::commission::RATE;
use crate::firmware::{self, AnyBoard, BenchBoard, Board, Kind, Place, Progress, SetUpError, Toolchain, choose_body};
use crate::models::ModelFile;
use crate::{devices, repository};
use anyhow::{Context, bail, ensure};
use clap::Args;
use glam::DVec3;
use palpate::math::Vec3;
use palpate::servo::Settings;
use palpate_sim::devices::{HomingEntry, OwnDevice, own_device, settings_source, source};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Runs cargo in a board's folder with a compiler for its target, installed if missing.
///
/// `palpate firmware build --release` builds the images as `demo` and `test` do. The board's own cargo settings apply,
/// such as its runner: `palpate firmware --board stm32g4 run --release` flashes it. `accept` instead of a cargo command
/// builds the image for `palpate accept`, which cannot drive a motor, and prints its path.
#[derive(Args, Debug)]
#[command(trailing_var_arg = true)]
pub struct Arguments {
    /// Board
    #[arg(long, value_enum, default_value_t)]
    board: AnyBoard,
    /// Body: a model file, or the name of a shipped one; it is baked, and its tables go to the fastest memory they fit
    #[arg(long, value_name = "MODEL")]
    body: Option<PathBuf>,
    /// Device: your own file (my.toml), or the name of a shipped one
    #[arg(long, value_name = "DEVICE")]
    device: Option<PathBuf>,
    /// Origin of the body in the workspace: x,y,z in mm from its centre; default: the body is centred, as in `sim`
    #[arg(long, value_name = "X,Y,Z", value_parser = options::millimetres, allow_hyphen_values = true, requires = "body")]
    at: Option<DVec3>,
    /// Servo rate, Hz: a whole number from 3000 up to 20000, or 40000 on teensy41; default: 4000
    #[arg(long, value_name = "HZ")]
    rate: Option<u32>,
    /// Cargo command, such as `build --release` or `clippy`; or `accept`, for the image of `palpate accept`
    #[arg(required = true, allow_hyphen_values = true)]
    cargo: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    arguments.check_rate_and_place()?;
    arguments.check_programs()?;
    let progress = Progress::new();
    let device = arguments.device.as_deref().map(|device| constants(arguments.board, device, arguments.rate));
    let device = device.transpose()?;
    let chosen = match &arguments.body {
        None => None,
        Some(model) => Some(chosen(arguments.board, arguments.kind(), model, arguments.at)?),
    };
    if let Some(Chosen { place: None, says, .. }) = &chosen {
        eprintln!("{says}");
        return Ok(ExitCode::from(2));
    }
    if let (Some(model), Some(chosen), AnyBoard::Bench(_)) = (&arguments.body, &chosen, arguments.board) {
        reaches(arguments.device.as_deref(), model, chosen.origin)?;
    }
    let toolchain = Toolchain::set_up(arguments.board.target(), &progress)?;
    let mut command = command(&toolchain, arguments, &progress)?;
    if let Some(Chosen { file, place: Some(place), origin, .. }) = &chosen {
        choose_body(&mut command, Some((file, *place)))?;
        command.env("PALPATE_ORIGIN", origin.to_array().map(|metres| format!("{metres:?}")).join(","));
    }
    if let Some((variable, file)) = device {
        command.env(variable, file);
    }
    if let Some(rate) = arguments.rate {
        command.env("PALPATE_RATE", rate.to_string());
    }
    command.current_dir(arguments.board.folder()?);
    // A flasher shows its progress on a terminal.
    let status = if arguments.cargo[0] == "run" { command.status() } else { long_calls::build(&mut command) };
    let status = status.with_context(|| format!("{command:?}"))?;
    if !status.success() {
        return Ok(ExitCode::FAILURE);
    }
    if let Some(chosen) = &chosen {
        println!("{}", chosen.says);
    }
    if arguments.accepts() {
        println!("{}", accepted(&toolchain, arguments.board)?.display());
        return Ok(ExitCode::SUCCESS);
    }
    let is_built = arguments.cargo.iter().any(|argument| argument == "build" || argument == "run");
    let is_release = arguments.cargo.iter().any(|argument| argument == "--release");
    if let (AnyBoard::Bench(board), true) = (arguments.board, is_built && is_release) {
        let program = arguments.after("--bin").next().unwrap_or(board.name());
        let image = toolchain.target_folder()?.join(board.target()).join("release").join(program);
        if !image.exists() {
            return Ok(ExitCode::SUCCESS);
        }
        print!("{}", firmware::report(board, arguments.kind(), &image)?);
        println!("image: {}\nto flash it: {}", image.display(), board.flashing(&image));
        if let Some(device) = &arguments.device {
            let own = devices::own(device)?;
            println!("{}", inside(&own, arguments.rate));
            let (rate, max_force) =
                (arguments.rate.unwrap_or(4_000) as f32, own.preset.recommended().settings.max_force_n);
            if let Some(warning) = options::weak_pulses(own_device(&own, ""), rate, max_force) {
                println!("warning: polarity check: {warning}");
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

impl Arguments {
    /// Whether the image for `palpate accept` is asked for.
    fn accepts(&self) -> bool {
        self.cargo == ["accept"]
    }

    /// Refuses a rate and a place that the board's build would refuse.
    fn check_rate_and_place(&self) -> anyhow::Result<()> {
        let AnyBoard::Bench(board) = self.board else {
            ensure!(
                self.at.is_none() && self.rate.is_none(),
                "--at and --rate apply to the boards for the bench; an emulated board takes those of `demo`"
            );
            return Ok(());
        };
        let rates = board.rates_hz();
        ensure!(
            self.rate.is_none_or(|rate| rates.contains(&rate)),
            "--rate {}: {} takes {} to {} Hz",
            self.rate.unwrap_or_default(),
            board.name(),
            rates.start(),
            rates.end()
        );
        Ok(())
    }

    /// Whether it is an emulated board whose core does not run all programs.
    fn has_few_programs(&self) -> bool {
        matches!(self.board, AnyBoard::Emulated(board) if !Board::CORTEX_F.contains(&board))
    }

    /// Refuses a program that the board's core cannot run.
    fn check_programs(&self) -> anyhow::Result<()> {
        let joined = self.cargo.iter().filter_map(|argument| argument.strip_prefix("--bin="));
        let named = self.after("--bin").chain(joined).chain(self.accepts().then_some("accept"));
        let all =
            self.cargo.iter().map(String::as_str).filter(|argument| ["--bins", "--all-targets"].contains(argument));
        let named: Vec<&str> = named.collect();
        let is_elsewhere = matches!(self.board, AnyBoard::Bench(board) if board != BenchBoard::Stm32g4);
        ensure!(
            !(is_elsewhere && named.contains(&"knob")),
            "knob: {} has none; the knob is built for stm32g4 only",
            self.board.name()
        );
        let mut missing = named.into_iter().filter(|name| Board::ON_CORTEX_F.contains(name)).chain(all);
        if let Some(missing) = missing.next().filter(|_| self.has_few_programs()) {
            bail!(
                "{missing}: on {} there are {} without a feature; the others need the interrupts of m4, m7 or m33",
                self.board.name(),
                Board::ON_ANY_CORE.join(", ")
            );
        }
        Ok(())
    }

    /// The programs to name to cargo, which without a target would build all.
    fn programs(&self) -> impl Iterator<Item = &'static str> {
        let chooses = |argument: &String| {
            ["--bin", "--lib", "--example", "--test", "--bench"].iter().any(|flag| argument.starts_with(flag))
        };
        let builds = matches!(self.cargo[0].as_str(), "build" | "check" | "clippy");
        let are_named = self.has_few_programs() && builds && !self.cargo.iter().any(chooses);
        Board::ON_ANY_CORE.into_iter().filter(move |_| are_named).flat_map(|program| ["--bin", program])
    }

    /// The arguments of cargo that follow a flag, each time.
    fn after(&self, flag: &str) -> impl Iterator<Item = &str> {
        self.cargo
            .iter()
            .zip(self.cargo.iter().skip(1))
            .filter(move |(of, _)| *of == flag)
            .map(|(_, what)| what.as_str())
    }

    /// Which image of a board for the bench is built.
    fn kind(&self) -> Kind {
        let joined = self.cargo.iter().filter_map(|argument| argument.strip_prefix("--features="));
        let mut features = self.after("--features").chain(joined);
        let is_hosted = features.any(|features| features.split([',', ' ']).any(|feature| feature == "host"));
        if is_hosted { Kind::Hosted } else { Kind::Alone }
    }
}

/// Where the image for `palpate accept` lies, once it is built. That of a board for the bench is taken out of the place
/// of its other image: nobody is to flash the one for the other.
fn accepted(toolchain: &Toolchain, board: AnyBoard) -> anyhow::Result<PathBuf> {
    let folder = toolchain.target_folder()?.join(board.target()).join("release");
    let AnyBoard::Bench(board) = board else { return Ok(folder.join("accept")) };
    let (built, image) = (folder.join(board.name()), folder.join(format!("{}-accept", board.name())));
    fs::rename(&built, &image).with_context(|| built.display().to_string())?;
    print!("{}", firmware::report(board, Kind::Accepted, &image)?);
    println!("to flash it: {}", board.flashing(&image));
    Ok(image)
}

/// A body that was chosen for a board.
struct Chosen {
    /// Its baked source.
    file: PathBuf,
    /// Where its tables lie; `None` if they do not fit.
    place: Option<Place>,
    /// The origin of its frame in the workspace, metres.
    origin: Vec3,
    /// That in words.
    says: String,
}

/// Bakes a model for a board.
fn chosen(board: AnyBoard, kind: Kind, model: &Path, at: Option<DVec3>) -> anyhow::Result<Chosen> {
    let name = model.file_stem().map_or_else(|| "body".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let out_file = format!("{name}.rs");
    let baked = bake::baked(model, &out_file)?;
    let file = written("bodies", &out_file, &baked.source)?;
    let (place, lies) = match board {
        // Emulated boards have 4 MB of flash, and no memory that is faster.
        AnyBoard::Emulated(_) => (Some(Place::Fast), "in flash".to_owned()),
        AnyBoard::Bench(board) => (board.place(kind, baked.bytes), board.says(kind, baked.bytes)),
    };
    let origin = at.map_or(-baked.middle, |at| (at + baked.centre).as_vec3());
    // Without negative zeros.
    let [x, y, z] = (origin.as_dvec3() * 1e3 + DVec3::ZERO).to_array();
    let lies = match board {
        AnyBoard::Emulated(_) => lies,
        AnyBoard::Bench(_) => {
            format!("{lies}\norigin of the body: {x:.1}, {y:.1}, {z:.1} mm from the centre of the workspace")
        }
    };
    Ok(Chosen {
        file,
        place,
        origin,
        says: format!("{}{name} on {}: {} bytes of tables {lies}", baked.remarks, board.name(), baked.bytes),
    })
}

/// Refuses a body that the device, or the boards' own arm, does not reach at its origin, metres, as `sim` does.
fn reaches(device: Option<&Path>, model: &Path, origin: Vec3) -> anyhow::Result<()> {
    let name = device.unwrap_or(Path::new("woodenhaptics-2016"));
    let device = devices::own_device(&devices::own(name)?, &name.to_string_lossy());
    let file = ModelFile::read(model)?;
    let loaded = file.model()?;
    let places = Felt::read(&loaded, &file, model, None, None)?.places();
    let at = |u, v| {
        let (point, normal) = places(u, v);
        ((point + origin.as_dvec3()).to_array(), normal.to_array())
    };
    options::path_over(device, (at, origin.as_dvec3() - loaded.centre), 5.0, 2).map(drop)
}

/// The constants of a device for a board's build, and the variable that names their file.
fn constants(board: AnyBoard, device: &Path, rate: Option<u32>) -> anyhow::Result<(&'static str, PathBuf)> {
    let own = devices::own(device)?;
    let (variable, source) = match board {
        AnyBoard::Emulated(_) => {
            ensure!(
                own.file.homing != HomingEntry::Index,
                "{}: homing = \"index\": emulated boards have no index marks: {}",
                device.display(),
                homing_instead("homing = \"pose\"", &own.file)
            );
            ("PALPATE_SETTINGS", settings_source(&own, RATE))
        }
        AnyBoard::Bench(board) => {
            suits(board, &own.file, rate.unwrap_or(4_000)).with_context(|| device.display().to_string())?;
            ("PALPATE_DEVICE", source(&own, &device.to_string_lossy()))
        }
    };
    let file = written("devices", &format!("{}.rs", own.file.name), &source)?;
    Ok((variable, file))
}

/// The device in an image, in words: as the boards take it.
fn inside(own: &OwnDevice, rate: Option<u32>) -> String {
    let Settings { stiffness_n_per_m, damping_n_s_per_m, max_force_n, .. } = own.preset.recommended().settings;
    let stages = if own.file.joint.iter().any(|joint| joint.motor.bridge.is_some()) { "bridges" } else { "amplifiers" };
    format!(
        "device: {}, {stages}; smooth, {stiffness_n_per_m} N/m, {damping_n_s_per_m} N·s/m, {max_force_n} N at most, {} Hz, all protection",
        own.file.name,
        rate.unwrap_or(4_000)
    )
}

/// A file for a board's build. As it was, cargo has nothing to do.
fn written(folder: &str, name: &str, source: &str) -> anyhow::Result<PathBuf> {
    let folder = repository::root()?.join("target/firmware").join(folder);
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let file = folder.join(name);
    if fs::read_to_string(&file).ok().as_deref() != Some(source) {
        write_whole(&file, source.as_bytes())?;
    }
    Ok(file)
}

fn command(toolchain: &Toolchain, arguments: &Arguments, progress: &Progress) -> Result<Command, SetUpError> {
    let (mut command, rest) = match &arguments.cargo[..] {
        [first, rest @ ..] if first == "clippy" => (toolchain.clippy(progress)?, rest),
        all => (toolchain.cargo(), all),
    };
    let rest: Vec<&str> = match arguments.board {
        _ if !arguments.accepts() => rest.iter().map(String::as_str).collect(),
        AnyBoard::Emulated(_) => vec!["build", "--release", "--bin", "accept"],
        AnyBoard::Bench(_) => vec!["build", "--release", "--features", "accept"],
    };
    if let Some(config) = arguments.board.cargo_config()? {
        command.arg("--config").arg(config);
    }
    // The linter's first argument is no command.
    let at = usize::from(arguments.cargo[0] != "clippy").min(rest.len());
    command.args(&rest[..at]).args(arguments.programs()).args(&rest[at..]);
    // After `--` come the linter's arguments, not cargo's: the folder is named by the environment.
    command.env("CARGO_TARGET_DIR", toolchain.target_folder()?);
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::BenchBoard;

    fn with(board: Board, cargo: &str) -> Arguments {
        let cargo = cargo.split(' ').map(str::to_owned).collect();
        Arguments { board: AnyBoard::Emulated(board), body: None, device: None, at: None, rate: None, cargo }
    }

    #[test]
    fn a_core_builds_the_programs_that_it_runs() {
        let folder = Board::folder().expect("the repository");
        let manifest: toml::Table =
            fs::read_to_string(folder.join("Cargo.toml")).expect("a manifest").parse().expect("one of cargo");
        let programs = manifest["bin"].as_array().expect("its programs");
        for program in programs {
            let name = program["name"].as_str().expect("a name");
            let source = fs::read_to_string(folder.join(format!("programs/{name}.rs"))).expect("its source");
            let needs_cortex = source.contains("cortex_m");
            assert_eq!(Board::ON_CORTEX_F.contains(&name), needs_cortex, "{name}");
            let is_plain = !needs_cortex && program.get("required-features").is_none();
            assert_eq!(Board::ON_ANY_CORE.contains(&name), is_plain, "{name}");
        }
        for board in Board::ALL {
            let has_all = Board::CORTEX_F.contains(&board);
            let named = with(board, "build --release").programs().count();
            assert_eq!(named, if has_all { 0 } else { 10 });
            assert_eq!(with(board, "build --release --bin uart").programs().count(), 0);
            for refused in ["build --release --bin stack", "build --bin=bench", "build --bins", "accept"] {
                assert_eq!(with(board, refused).check_programs().is_ok(), has_all, "{refused}");
            }
            assert!(with(board, "build --bin budget").check_programs().is_ok());
        }
    }

    #[test]
    fn a_rate_is_refused_where_the_boards_build_would_refuse_it() {
        for board in BenchBoard::ALL {
            let build = board.folder().expect("the repository").join("build.rs");
            let build = fs::read_to_string(build).expect("its build script");
            let (least, most) = (board.rates_hz().start().to_owned(), board.rates_hz().end().to_owned());
            let call = format!("palpate_board_build::rate({}_000);", most / 1_000);
            assert!(build.contains(&call), "{}: {call}", board.name());
            let takes = |rate| {
                let arguments = Arguments {
                    board: AnyBoard::Bench(board),
                    body: None,
                    device: None,
                    at: None,
                    rate: Some(rate),
                    cargo: vec!["build".to_owned()],
                };
                arguments.check_rate_and_place().map_err(|error| error.to_string())
            };
            assert_eq!([takes(least), takes(most)], [Ok(()), Ok(())]);
            for rate in [0, 1_000, least - 1, most + 1] {
                let says = format!("--rate {rate}: {} takes 3000 to {most} Hz", board.name());
                assert_eq!(takes(rate), Err(says));
            }
        }
        let build = repository::root().expect("the repository").join("boards/build/src/lib.rs");
        assert!(fs::read_to_string(build).expect("the builds").contains("(3_000..=highest_hz).contains(rate)"));
    }

    #[test]
    fn a_body_out_of_the_arms_reach_is_refused_as_sim_refuses_it() {
        let model = Path::new("capped_box");
        let reaches_at = |at: Vec3| reaches(None, model, at).map_err(|error| error.to_string());
        let reaches = |x, z| reaches_at(Vec3::new(x, 0.0, z));
        assert_eq!(reaches(0.0, 0.0), Ok(()));
        let centre = ModelFile::read(model).and_then(|file| Ok(file.model()?.centre)).expect("it ships");
        let nearest = |error: &str| -> Vec3 {
            let (_, place) = error.split_once("the nearest place towards the centre is --at ").expect("a place");
            let (place, _) = place.split_once(';').expect("its end");
            (options::millimetres(place).expect("three numbers") + centre).as_vec3()
        };
        let error = reaches(0.4, 0.0).unwrap_err();
        assert!(error.contains("of the surface itself it holds 0 %"), "{error}");
        let at = nearest(&error);
        assert_eq!(reaches_at(at), Ok(()));
        // A sixteenth of the way back, it is out of reach again.
        assert!(reaches_at(at + Vec3::X * 0.025).is_err());
        // The table is 80 mm under the centre, and the box 25 mm high above its origin.
        assert_eq!(reaches(0.0, -0.09), Ok(()));
        let error = reaches(0.0, -0.2).unwrap_err();
        assert!(error.contains("below the table, 80 mm under the centre"), "{error}");
        assert_eq!(reaches_at(nearest(&error)), Ok(()));
    }
}
