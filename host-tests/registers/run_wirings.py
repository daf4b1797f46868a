#!/usr/bin/env python3
"""Builds the Nucleo's image for a host from a device file of each permutation of motors and of encoders, and runs its
tests of the wiring: `run_wirings.py [NUMBER]...`, of 0 to 5; all without."""

from __future__ import annotations

import os
import subprocess
import sys

import wirings
from run_tests import ENVIRONMENT, FOLDER, build, python, say

IMAGE = "stm32g4_host"
TESTS = ("test_count_at_a_joints_channel_moves_that_joint", "test_force_comes_once_every_joint_was_seen_to_follow_its_own_motor")


def main() -> int:
    with_unicorn, failed = python(), []
    for number in map(int, sys.argv[1:] or range(len(wirings.CHANNELS))):
        folder = ENVIRONMENT / f"wirings/{number}"
        build([IMAGE], folder, number)
        tests = subprocess.run(
            [with_unicorn, "-m", "unittest", *(f"test_stm32g4_host.Stm32g4WithHost.{test}" for test in TESTS)],
            cwd=FOLDER,
            env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1", PALPATE_IMAGES=str(folder)),
        )
        encoders, motors = wirings.channels(number)
        say(f"encoders {encoders}, motors {motors}: {'drives other joints' if tests.returncode else 'drives the right joints'}")
        failed += [number] * bool(tests.returncode)
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
