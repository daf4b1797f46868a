#!/usr/bin/env python3
"""Runs the images of the boards on the bench among modelled registers: `run_tests.py [BOARD]...`.

What runs their instructions (Unicorn) goes into a virtual environment in target/registers, which is said; nothing else
on the machine is touched. The images are built first; the tool is the one in PALPATE_TOOL, or cargo builds it.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
ENVIRONMENT = ROOT / "target/registers"
UNICORN = "unicorn>=2.1.4,<2.2"
BOARDS = ("stm32g4", "pico2", "teensy41")


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


def image(board: str) -> Path:
    """The image of a board, built: the newest, for there is more than one way to a compiler."""
    tool = [ROOT / os.environ["PALPATE_TOOL"]] if "PALPATE_TOOL" in os.environ else ["cargo", "palpate"]
    run(*tool, "firmware", "--board", board, "--body", "capped_box", "build", "--release", cwd=ROOT)
    made = list(TARGET.glob(f"firmware/*/thumb*/release/{board}"))
    return max(made, key=lambda file: file.stat().st_mtime)


def main() -> int:
    boards = sys.argv[1:] or BOARDS
    if not set(boards) <= set(BOARDS):
        say(f"the boards are {', '.join(BOARDS)}")
        return 2
    if sys.version_info < (3, 10):
        say(f"the tests of the boards need Python 3.10, and {sys.executable} is {sys.version.split()[0]}")
        return 2
    if importlib.util.find_spec("ensurepip") is None:
        say(f"{sys.executable} makes no virtual environments: install python3-venv, or another Python")
        return 2
    with_unicorn = python()
    images = {f"PALPATE_IMAGE_{board.upper()}": str(image(board)) for board in boards}
    tests = subprocess.run(
        [with_unicorn, "-m", "unittest", *(f"test_{board}" for board in boards)],
        cwd=FOLDER,
        env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1", **images),
    )
    return tests.returncode


if __name__ == "__main__":
    try:
        sys.exit(main())
    except subprocess.CalledProcessError as error:
        say(f"{Path(error.cmd[0]).name} ended with {error.returncode}")
        sys.exit(1)
