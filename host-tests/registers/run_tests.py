#!/usr/bin/env python3
"""Runs the images of the boards on the bench among modelled registers: `run_tests.py [IMAGE]...`.

What runs their instructions (Unicorn) goes into a virtual environment in target/registers, which is said; nothing else
on the machine is touched. The images are built first, unless PALPATE_IMAGES names a folder that has them; the tool is
the one in PALPATE_TOOL, or cargo builds it.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import wirings

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
# Made anew where it is not complete, with all that lies in it: images are not to.
ENVIRONMENT = ROOT / "target/registers/environment"
UNICORN = "unicorn>=2.1.4,<2.2"
# What builds an image of the loop; with more words, that for a host.
# Where the tests of a joint and of a touch expect it.
LOOP = ("--body", "capped_box", "--at", "-50,-50,-60", "build", "--release")
HOST = (*LOOP, "--features", "host")
# The highest rate of each board, Hz.
FASTEST = {"stm32g4": "20000", "pico2": "20000", "teensy41": "40000"}
# Each image's board, its file among what is built, and what builds it.
IMAGES = {
    "stm32g4": ("stm32g4", "stm32g4", LOOP),
    "knob": ("stm32g4", "knob", LOOP),
    "pico2": ("pico2", "pico2", LOOP),
    "teensy41": ("teensy41", "teensy41", LOOP),
    **{f"{board}_fast": (board, board, ("--rate", rate, *LOOP)) for board, rate in FASTEST.items()},
    **{f"{board}_host": (board, board, HOST) for board in ("stm32g4", "pico2", "teensy41")},
    **{f"{board}_accept": (board, f"{board}-accept", ("accept",)) for board in ("stm32g4", "pico2", "teensy41")},
}

# Those that run only where they are named.
LONG = {"pico2_fast", "teensy41_fast"}


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def run(*command: str | Path, **options) -> None:
    subprocess.run([str(word) for word in command], check=True, **options)


def python() -> Path:
    """The Python of a virtual environment that has Unicorn."""
    found = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin") / "python"
    if not (ENVIRONMENT / "complete").exists():
        say(f"setting up the virtual environment {ENVIRONMENT.relative_to(ROOT)}: {UNICORN}")
        run(sys.executable, "-m", "venv", "--clear", ENVIRONMENT)
        run(found, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:", UNICORN)
        (ENVIRONMENT / "complete").touch()
    return found


def build(names: list[str], folder: Path, wiring: int | None = None) -> None:
    """Builds these images into a folder, those for a host from a device file with this wiring or their own; of each the
    newest, for there is more than one way to a compiler."""
    tool = [ROOT / os.environ["PALPATE_TOOL"]] if "PALPATE_TOOL" in os.environ else ["cargo", "palpate"]
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        board, file_name, words = IMAGES[name]
        if name in wirings.NUMBERS:
            words = ("--device", str(wirings.write(name, folder, wiring)), *words)
        run(*tool, "firmware", "--board", board, *words, cwd=ROOT)
        made = TARGET.glob(f"firmware/*/thumb*/release/{file_name}")
        shutil.copy(max(made, key=lambda file: file.stat().st_mtime), folder / name)


def main() -> int:
    names = sys.argv[1:] or [name for name in IMAGES if name not in LONG]
    if not set(names) <= set(IMAGES):
        say(f"the images are {', '.join(IMAGES)}")
        return 2
    if sys.version_info < (3, 11):
        say(f"the tests of the boards need Python 3.11, and {sys.executable} is {sys.version.split()[0]}")
        return 2
    if importlib.util.find_spec("ensurepip") is None:
        say(f"{sys.executable} makes no virtual environments: install python3-venv, or another Python")
        return 2
    with_unicorn = python()
    if "PALPATE_IMAGES" in os.environ:
        images = ROOT / os.environ["PALPATE_IMAGES"]
    else:
        images = ENVIRONMENT / "images"
        build(names, images)
    tests = subprocess.run(
        [with_unicorn, "-m", "unittest", *(f"test_{name}" for name in names)],
        cwd=FOLDER,
        env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1", PALPATE_IMAGES=str(images)),
    )
    return tests.returncode


if __name__ == "__main__":
    try:
        sys.exit(main())
    except subprocess.CalledProcessError as error:
        say(f"{Path(error.cmd[0]).name} ended with {error.returncode}")
        sys.exit(1)
