#!/usr/bin/env python3
"""Builds the wheel, installs it in a fresh virtual environment and runs its tests there: `palpate test --python`. With
`--wheel FOLDER` it builds the wheel alone, for `palpate wheel`.

What is missing (maturin, pytest, what the notebooks need) goes into virtual environments in target/python, and is said;
nothing else on the machine is touched. Other arguments go to pytest.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent.parent
# Wheels and virtual environments.
TARGET = ROOT / "target/python"
# As the file pyproject.toml asks for it.
MATURIN = "maturin>=1.16,<2"


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def run(*command: str | Path, **options) -> None:
    subprocess.run([str(word) for word in command], check=True, **options)


def environment(name: str, *packages: str, anew: bool = False) -> Path:
    """The folder of programs of a virtual environment with these packages."""
    place = TARGET / name
    if anew and place.exists():
        shutil.rmtree(place)
    programs = place / ("Scripts" if os.name == "nt" else "bin")
    if not (place / "complete").exists():
        say(f"setting up the virtual environment {place.relative_to(ROOT)}: {', '.join(packages)}")
        run(sys.executable, "-m", "venv", "--clear", place)
        run(programs / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages)
        (place / "complete").touch()
    return programs


def wheel(builder: Path) -> Path:
    """The wheel, built."""
    wheels = TARGET / "wheels"
    if wheels.exists():
        shutil.rmtree(wheels)
    # At a terminal cargo shows its own bar.
    quiet = [] if sys.stderr.isatty() else ["--quiet"]
    command = [
        builder / "maturin", "build", *quiet, "--profile", "apart", "--locked", "--interpreter", sys.executable,
        "--manifest-path", FOLDER / "Cargo.toml", "--target-dir", ROOT / "target", "--out", wheels,
    ]  # fmt: skip
    began = time.monotonic()
    with subprocess.Popen(command) as build:
        while build.poll() is None:
            try:
                build.wait(30)
            except subprocess.TimeoutExpired:
                if quiet:
                    say(f"building the wheel: {time.monotonic() - began:.0f} s so far")
    if build.returncode:
        raise subprocess.CalledProcessError(build.returncode, command)
    [made] = wheels.glob("*.whl")
    return made


def plain_loop() -> Path:
    """The loop in Rust that answers are held to, built. Beside the wheel's package, for the features that it was built with."""
    run(
        os.environ.get("CARGO", "cargo"), "build", "--quiet", "--profile", "apart", "--locked",
        "--package", "palpate-race", "--package", "palpate-python", "--example", "plain_loop",
        "--manifest-path", ROOT / "Cargo.toml", "--target-dir", ROOT / "target",
    )  # fmt: skip
    return ROOT / "target/apart/examples/plain_loop"


def main() -> int:
    if sys.version_info < (3, 10):
        say(f"the wheel needs Python 3.10, and {sys.executable} is {sys.version.split()[0]}")
        return 2
    if importlib.util.find_spec("ensurepip") is None:
        say(f"{sys.executable} makes no virtual environments: install python3-venv, or another Python")
        return 2
    builder = environment("builder", MATURIN)
    say("building the wheel; the first time takes up to ten minutes")
    made = wheel(builder)
    if sys.argv[1:2] == ["--wheel"]:
        to = Path(sys.argv[2])
        to.mkdir(parents=True, exist_ok=True)
        made = Path(shutil.copy2(made, to)) if to.resolve() != made.parent else made
        print(f"{made}: {made.stat().st_size:,} bytes\ninstall it: python3 -m pip install {made}")
        return 0
    say(f"{made.name}: {made.stat().st_size:,} bytes")
    loop = plain_loop()
    fresh = environment("fresh", f"{made}[test]", anew=True)
    # In another folder than the sources: what is imported is the wheel.
    pytest = [fresh / "python", "-m", "pytest", "-q", "-rs", "-s", "-p", "no:cacheprovider"]
    tests = subprocess.run(
        [*pytest, FOLDER / "tests", *sys.argv[1:]],
        cwd=TARGET,
        env=dict(os.environ, PALPATE_PLAIN_LOOP=str(loop), MPLBACKEND="agg", PYTHONDONTWRITEBYTECODE="1"),
    )
    return tests.returncode


if __name__ == "__main__":
    try:
        sys.exit(main())
    except subprocess.CalledProcessError as error:
        say(f"{Path(error.cmd[0]).name} ended with {error.returncode}")
        sys.exit(1)
