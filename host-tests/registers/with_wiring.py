"""An image built from a device file whose joints are not on the channels of their numbers, which lies beside it: a count
on the channel that the file gives a joint moves that joint, and its torque comes out at the channel that the file says.

What is expected comes of the file and the arm's geometry, by none of the project's code.
"""

from __future__ import annotations

import math
import os
import tomllib
from pathlib import Path

import telemetry
from bench import A_WHILE, Bench
from machine import Machine

# Whatever the channels.
ARM = tomllib.loads(Path(__file__).with_name("swapped.toml").read_text())["mechanism"]
# rad a tick: 8 rad/s at 4 kHz, well below what is taken for a jump.
SLOW = 0.002
# s.
TICK = 1 / 4_000
# Over the dome of the capped box, in the body's frame, m.
ABOVE = (0.03, 0.02, 0.06)


def reached(angles: list[float]) -> list[float]:
    """The probe of a turntable with two links, m: the first link's angle is from the vertical, the second's down from
    the horizontal (docs/howto/your-device.md); in the frame of the boards' body, whose origin their settings give."""
    turned, first, second = angles
    out = ARM["first_link"] * math.sin(first) + ARM["second_link"] * math.cos(second)
    up = ARM["base_height"] + ARM["first_link"] * math.cos(first) - ARM["second_link"] * math.sin(second)
    place = out * math.cos(turned), out * math.sin(turned), up
    return [p - c - o for p, c, o in zip(place, ARM["workspace_centre"], (-0.05, -0.05, -0.06))]


def angles_at(place: tuple[float, float, float], near: list[float]) -> list[float]:
    """Joint angles with the probe there, by Newton's method."""
    angles = list(near)
    for _ in range(50):
        now, step = reached(angles), 1e-6
        columns = [[(b - a) / step for a, b in zip(now, reached(nudged(angles, j, step)))] for j in range(3)]
        angles = [a + d for a, d in zip(angles, solved(columns, [t - n for t, n in zip(place, now)]))]
    return angles


def nudged(angles: list[float], joint: int, by: float) -> list[float]:
    return [a + by * (j == joint) for j, a in enumerate(angles)]


def cross(a: list[float], b: list[float]) -> list[float]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a: list[float], b: list[float]) -> float:
    return sum(x * y for x, y in zip(a, b))


def solved(columns: list[list[float]], wanted: list[float]) -> list[float]:
    """Cramer's rule."""
    a, b, c = columns
    whole = dot(a, cross(b, c))
    return [dot(wanted, cross(b, c)) / whole, dot(a, cross(wanted, c)) / whole, dot(a, cross(b, wanted)) / whole]


class WithWiring(Bench):
    """Wiring."""

    @classmethod
    def load(cls) -> None:
        super().load()
        cls.joints = tomllib.loads((Path(os.environ["PALPATE_IMAGES"]) / f"{cls.NAME}.toml").read_text())["joint"]

    def turn(self, machine: Machine, angles: list[float]) -> None:
        """Puts the joints there: the counts at the channels of their encoders, from those of the pose, where all are
        zero."""
        for joint, angle in zip(self.joints, angles):
            encoder = joint["encoder"]
            counts = round((angle - encoder.get("zero", 0.0)) / math.tau * encoder["counts"] * encoder["ratio"])
            machine.chip.turn_encoder(encoder["channel"], counts)

    def go(self, machine: Machine, start: list[float], end: list[float]) -> None:
        ticks = math.ceil(max(abs(b - a) for a, b in zip(start, end)) / SLOW)
        for tick in range(1, ticks + 1):
            self.turn(machine, [a + (b - a) * tick / ticks for a, b in zip(start, end)])
            machine.ticks(1)

    def pose(self) -> list[float]:
        return [joint["encoder"].get("zero", 0.0) for joint in self.joints]

    def test_count_at_a_joints_channel_moves_that_joint(self) -> None:
        pose = self.pose()
        for joint in range(3):
            with self.subTest(joint):
                machine = self.once_homed()
                turned = nudged(pose, joint, 0.1)
                self.go(machine, pose, turned)
                machine.ticks(A_WHILE)
                # To a count and a half of the joint's on half a metre of links.
                for got, wanted in zip(self.last(machine).probe, reached(turned)):
                    self.assertAlmostEqual(got, wanted, delta=2e-4)

    def overdrive(self, number: int) -> float:
        """The current at all of a bridge's supply, in those of a full torque; 1 of an amplifier."""
        motor = self.joints[number]["motor"]
        bridge = motor.get("bridge")
        return bridge["supply"] / bridge["resistance"] / motor["current_at_full"] if bridge else 1.0

    def test_force_comes_once_every_joint_was_seen_to_follow_its_own_motor(self) -> None:
        machine = self.once_homed()
        at = angles_at(ABOVE, [0.0, 0.3, 0.9])
        self.go(machine, self.pose(), at)
        machine.chip.press(enable=True)
        machine.ticks(A_WHILE)
        self.assertEqual(self.last(machine).phase, telemetry.RUNNING)
        depth = 0.0
        while self.last(machine).gap > -0.002 and depth < 0.05:
            depth += 0.001
            below = angles_at((ABOVE[0], ABOVE[1], ABOVE[2] - depth), at)
            self.go(machine, at, below)
            at = below
            # A record comes every 20 ticks.
            machine.ticks(25)
        self.assertLess(self.last(machine).gap, -0.002, "it is in the wall")
        # The motor on the file's channel moves the joint, whose encoder is on the file's channel; a soft grip holds it.
        # The loop withholds force until it saw each joint follow the pulse of its own motor: then more than one motor
        # is driven at a time.
        rest, rates = list(at), [0.0] * 3
        for _ in range(2_400):
            duties = machine.chip.duties()
            if sum(abs(duty) * self.overdrive(number) > 0.01 for number, duty in enumerate(duties)) > 1:
                break
            for number, joint in enumerate(self.joints):
                motor = joint["motor"]
                current = motor["current_at_full"] * self.overdrive(number)
                full = motor["torque_constant"] * current * motor["ratio"]
                pushed = duties[motor["channel"]] * full / joint["inertia"]
                rates[number] += (pushed - 400 * (at[number] - rest[number]) - 20 * rates[number]) * TICK
                at[number] += rates[number] * TICK
            self.turn(machine, at)
            machine.ticks(1)
        else:
            self.fail("no force comes: the pulse of a motor moves another joint")
        self.assertEqual(self.last(machine).phase, telemetry.RUNNING)
