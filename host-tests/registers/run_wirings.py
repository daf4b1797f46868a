#!/usr/bin/env python3
"""Builds the Nucleo's image for a host from a device file of each permutation of motors and of encoders, and runs its
tests of the wiring: `run_wirings.py [NUMBER]...`, of 0 to 5; all without."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys

from run_tests import ENVIRONMENT, FOLDER, LOOP, ROOT, build, python, say

CHANNELS = list(itertools.permutations(range(3)))
SWAPPED = FOLDER / "swapped.toml"
TESTS = ("test_count_at_a_joints_channel_moves_that_joint", "test_force_comes_once_every_joint_was_seen_to_follow_its_own_motor")


def device(encoders: tuple[int, ...], motors: tuple[int, ...]) -> str:
    """The device file with these channels of its joints."""
    # An encoder's line comes before its motor's.
    channels = iter(channel for joint in zip(encoders, motors) for channel in joint)
    return re.sub(r"^channel = \d$", lambda _: f"channel = {next(channels)}", SWAPPED.read_text(), flags=re.MULTILINE)


def main() -> int:
    with_unicorn, failed = python(), []
    for number in map(int, sys.argv[1:] or range(len(CHANNELS))):
        # Each permutation of either comes once, and never the same of both.
        encoders, motors = CHANNELS[number], CHANNELS[(number + 2) % len(CHANNELS)]
        folder = ENVIRONMENT / f"wirings/{number}"
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / "device.toml"
        file.write_text(device(encoders, motors))
        build(["stm32g4_host"], folder, ("--device", str(file), *LOOP, "--features", "host"))
        tests = subprocess.run(
            [with_unicorn, "-m", "unittest", *(f"test_stm32g4_host.Stm32g4WithHost.{test}" for test in TESTS)],
            cwd=FOLDER,
            env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1", PALPATE_IMAGES=str(folder), PALPATE_WIRED=str(file)),
        )
        say(f"encoders {encoders}, motors {motors}: {'drives other joints' if tests.returncode else 'drives the right joints'}")
        failed += [number] * bool(tests.returncode)
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
