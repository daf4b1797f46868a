#!/usr/bin/env python3
"""Device files whose joints are on other channels than those of their numbers, from `swapped.toml`: `wirings.py FOLDER`
writes one for the image for a host of each board, with a wiring of its own, beside where the image goes."""

from __future__ import annotations

import itertools
import re
import sys
from pathlib import Path

CHANNELS = list(itertools.permutations(range(3)))
# Of each image by default.
NUMBERS = {"stm32g4_host": 4, "pico2_host": 3, "teensy41_host": 5}


def channels(number: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Of the joints' encoders and motors: each permutation of either comes once, and never the same of both."""
    return CHANNELS[number], CHANNELS[number - 1]


def write(name: str, folder: Path, number: int | None = None) -> Path:
    """Writes the device file of an image with this wiring, or with its own."""
    # An encoder's line comes before its motor's.
    given = (channel for joint in zip(*channels(NUMBERS[name] if number is None else number)) for channel in joint)
    text = Path(__file__).with_name("swapped.toml").read_text()
    if not name.startswith("stm32g4"):
        text = text.replace("counts = 2000.0", "counts = 16384.0")
    if name.startswith("pico2"):
        # Without back-EMF's share a duty is a torque: tests tell by it which motor pulls.
        bridge = "bridge = { supply = 24.0, resistance = 0.711, back_emf_share = 0.0 }"
        text = text.replace("[joint.motor]\n", f"[joint.motor]\n{bridge}\n")
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{name}.toml"
    file.write_text(re.sub(r"^channel = \d$", lambda _: f"channel = {next(given)}", text, flags=re.MULTILINE))
    return file


if __name__ == "__main__":
    for image in NUMBERS:
        write(image, Path(sys.argv[1]))
