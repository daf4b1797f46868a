"""The wheel's loop on MuJoCo's WoodenHaptics and Falcon, beside palpate's own plants: checks what the
table of `docs/explanation/feel.md` claims and prints it, or writes it to a page.

    python3 compare.py [PAGE]       with MuJoCo and the wheel installed: `.ci/long mujoco` sets that up
"""

import sys
from pathlib import Path

import numpy as np
import palpate
import plants

MARK = "<!-- generated: .ci/long mujoco -->\n\n"
AXES = np.eye(3)
# Half a side of a wall, m; and where nothing is in reach.
HALF, AWAY = 0.1, (0.0, 0.0, -0.6)
PERIOD = 1 / 4000
# The stiffest wall tried, N/m.
MOST = 60e3
# A hand that damps nothing: a tremble is the loop's and the device's.
LIGHT = {"stiffness": 100.0, "damping": 0.0}
FIRM = {"stiffness": 1000.0, "damping": 20.0}


def square(axis):
    """A wall through the origin that faces along an axis."""
    along, across = AXES[(axis + 1) % 3] * HALF, AXES[(axis + 2) % 3] * HALF
    points = [[side * along + other * across for other in (-1, 1)] for side in (-1, 1)]
    return palpate.Body.bake([{"degree": [1, 1], "points": np.array(points)}])


WALLS = [square(axis) for axis in range(3)]


class Case:
    """A device with both of its plants."""

    def __init__(self, name, make, radius):
        self.device, self.make, self.radius = palpate.Device(name), make, radius
        self.random = np.random.default_rng(1)

    def plant(self, outside, place):
        return self.make(self.device, np.array(place, float)) if outside else palpate.Plant(self.device, place)

    def loop(self, body, **settings):
        return palpate.Loop(self.device.name, body, **{"stiffness": 500.0, "max_force": 5.0} | settings)

    def places(self, count):
        """Places in a ball about the middle of the workspace."""
        ways = self.random.normal(size=(count, 3))
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        return ways * self.radius * self.random.uniform(size=(count, 1)) ** (1 / 3)


def play(loop, plant, path, seconds, grip=LIGHT, look=lambda time: None):
    """A hand's path over seconds, enable held."""
    for tick in range(round(seconds / PERIOD)):
        time = tick * PERIOD
        duties = loop.tick(plant.counts)
        aim, after = path(time), path(time + PERIOD)
        look(time)
        plant.advance(duties, aim, (after - aim) / PERIOD, **grip)
        if loop.fault:
            break


def kinematics(case, outside):
    """Worst errors of position, m, and of the Jacobian, relative, at 1,000 poses."""
    places, errors = case.places(1000), []
    angles = case.device.angles(places)
    found, jacobians = case.device.pose(angles)
    if not outside:
        # The own plant's inverse against the loop's forward map; its Jacobian by central differences.
        step = 1e-6
        ways = [case.device.angles(places + sign * step * axis) for axis in AXES for sign in (1, -1)]
        inverse = np.stack([(ways[2 * i] - ways[2 * i + 1]) / (2 * step) for i in range(3)], axis=-1)
        errors = [np.abs(jacobian @ back - np.eye(3)).max() for jacobian, back in zip(jacobians, inverse)]
        return np.abs(found - places).max(), max(errors)
    plant = case.plant(True, [0, 0, 0])
    apart, relative = [], []
    for place, angle, position, jacobian in zip(places, angles, found, jacobians):
        plant = case.plant(True, place) if len(apart) % 1000 == 0 else plant
        guess = plant.data.qpos.copy()
        if plant.data.ne:
            plant.close(angle, guess)
        else:
            plant.close(angle)
        apart.append(np.linalg.norm(plant.position - position))
        relative.append(np.linalg.norm(plant.jacobian() - jacobian) / np.linalg.norm(jacobian))
    return max(apart), max(relative)


def gravity(case):
    """The worst torque that compensation lacks at 40 poses, N·m, and the largest weight, N·m."""
    apart, most = [], 0.0
    for place in case.places(40):
        plant = case.plant(True, place)
        loop = case.loop(WALLS[2], at=AWAY)
        for _ in range(1200):
            duties = loop.tick(plant.counts)
        assert loop.fault == 0 and any(duties), (place, loop.fault, loop.phase)
        apart.append(np.abs(np.array(case.device.torques(duties)) - plant.weight()).max())
        most = max(most, np.abs(plant.weight()).max())
    return max(apart), most


def wall(case, outside, axis):
    """Force over stiffness times depth at rest, with the true depth of the plant."""
    loop, plant = case.loop(WALLS[axis], smooth=False), case.plant(outside, AXES[axis] * 0.004)
    play(loop, plant, lambda time: AXES[axis] * max(0.004 - 0.03 * time, -0.01), 1.5, FIRM)
    return loop.force[axis] / (500.0 * -plant.position[axis])


def stiffest(case, outside, axis, damping):
    """The largest stiffness, N/m, of a wall that does not tremble under a light hand's press of 1 N, to 5 %."""

    # Dry friction alone takes longer.
    rests = 0.6 if damping else 2.0

    def holds(stiffness):
        loop = case.loop(WALLS[axis], stiffness=stiffness, damping=damping, smooth=False, beyond=True, velocity_corner=200.0)
        plant, speeds = case.plant(outside, AXES[axis] * 0.002), []
        look = lambda time: speeds.append(abs(plant.velocity[axis])) if time > rests else None
        play(loop, plant, lambda time: AXES[axis] * max(0.002 - 0.1 * time, -0.01), rests + 0.2, LIGHT, look)
        # A twentieth of the speed of the hand's aim.
        return loop.fault == 0 and max(speeds) < 0.005

    if holds(MOST):
        return np.inf
    # Step by step: a stiffer wall may hold again.
    stiffness = 500.0
    assert holds(stiffness), (case.device.name, axis, damping)
    while holds(1.05 * stiffness):
        stiffness *= 1.05
    return stiffness


def steps(case, outside, path, body, at, seconds):
    """The largest step of the force in a tick, N, after the first contact, rendering as recommended."""
    loop, plant = case.loop(body, at=at), case.plant(outside, path(0.0))
    forces = []
    play(loop, plant, path, seconds, FIRM, lambda time: forces.append(loop.force))
    assert loop.fault == 0 and np.abs(forces).max() > 0.5, (case.device.name, loop.fault, np.abs(forces).max())
    return np.linalg.norm(np.diff(forces, axis=0), axis=1).max()


def energy(case, outside):
    """Work of the hand on the device, J, over ten presses in 5 s: a device that gives energy would make it negative."""
    loop, plant, work = case.loop(WALLS[2]), case.plant(outside, [0, 0, 0.01]), 0.0
    path = lambda time: np.array([0, 0, 0.01 * np.cos(4 * np.pi * time)])
    for tick in range(20_000):
        duties, time = loop.tick(plant.counts), tick * PERIOD
        aim, velocity = path(time), (path(time + PERIOD) - path(time)) / PERIOD
        before = plant.position
        force = FIRM["stiffness"] * (aim - before) + FIRM["damping"] * (velocity - plant.velocity)
        plant.advance(duties, aim, velocity, **FIRM)
        work += force @ (plant.position - before)
    assert loop.fault == 0
    return work


def faults(case, outside):
    """Ticks with torque after a failure in contact: a count that jumps, an enable button that is released."""
    driven = []
    for failure in ("jump", "enable"):
        loop, plant = case.loop(WALLS[2]), case.plant(outside, [0, 0, 0.004])
        play(loop, plant, lambda time: np.array([0, 0, max(0.004 - 0.03 * time, -0.01)]), 1.0, FIRM)
        assert any(loop.tick(plant.counts))
        ticks = 0
        for _ in range(200):
            counts = list(plant.counts)
            counts[1] += 5_000 if failure == "jump" else 0
            duties = loop.tick(counts, failure != "enable")
            ticks += any(duties)
            plant.advance(duties, [0, 0, -0.01], **FIRM)
        driven.append(ticks)
    return driven


def table():
    """The table, with its claims checked."""
    cases = [Case("woodenhaptics-2016", plants.wooden_haptics, 0.06), Case("falcon", plants.falcon, 0.035)]
    rows = []

    def row(what, form, figures, holds, why):
        assert holds(figures), (what, figures)
        rows.append([what, *(form(figure) for figure in figures), why])

    def both(figure):
        return [figure(case, outside) for case in cases for outside in (True, False)]

    def alike(figures, within):
        """Each pair of plants, to a share."""
        return all(a == b or abs(a / b - 1) < within for a, b in (figures[:2], figures[2:]))

    small = "{:.0e}".format
    found = both(kinematics)
    row("position, 1,000 poses, m", small, [place for place, _ in found], lambda all: max(all) < 2e-7, "rounding of `f32`")
    row("Jacobian, relative", small, [share for _, share in found], lambda all: max(all) < 2e-6, "the own one is by differences")
    weights = [text for case in cases for text in (gravity(case), None)]
    row(
        "gravity compensation, N·m of",
        lambda of: "–" if of is None else f"{of[0]:.0e} of {of[1]:.2f}",
        weights,
        # A step of the duty and the soft start's end.
        lambda all: max(of[0] for of in all if of) < 1e-4,
        "steps of the duty",
    )
    for axis in (2, 0, 1):
        ratios = both(lambda case, outside: wall(case, outside, axis))
        # 3 to 10 mm of depth, by counts of 23 to 146 µm.
        near = lambda all: all_near(all, 0.01)
        row(f"wall along {'xyz'[axis]}, force over k·depth", "{:.3f}".format, ratios, near, "depth is by counts")
    limit = lambda stiffness: f"{stiffness:,.0f}" if stiffness < np.inf else f"over {MOST:,.0f}"
    for damping in (0.0, 2.0, 8.0):
        for axis in (2, 0, 1):
            limits = both(lambda case, outside: stiffest(case, outside, axis, damping))
            # Five steps of the search.
            why = "integrators; the Falcon's friction holds any wall"
            row(f"stiffest wall along {'xyz'[axis]}, B = {damping:g}, N/m", limit, limits, lambda all: alike(all, 0.25), why)
    step = lambda newtons: f"{1e3 * newtons:.0f}"
    tap = lambda time: np.array([0, 0, max(0.012 - 0.3 * time, -0.012)])
    over = lambda time: np.array([min(0.3 * max(time - 0.5, 0.0), 0.04), 0, max(0.008 - 0.04 * time, -0.008)])
    taps = both(lambda case, outside: steps(case, outside, tap, WALLS[2], (0, 0, 0), 0.3))
    edges = both(lambda case, outside: steps(case, outside, over, WALLS[2], (-HALF + 0.01, 0, 0), 0.8))
    # What the ease allows in a tick.
    row("largest step, tap at 0.3 m/s, mN", step, taps, lambda all: max(all) < 0.0501, "the speed after the hit")
    row("the same, off an edge", step, edges, lambda all: max(all) < 0.0501, "none: the ease limits it")
    row("work of the hand, 10 presses, mJ", step, both(energy), lambda all: min(all) > 0 and alike(all, 0.1), "friction")
    lost = both(faults)
    row("ticks with torque after a jump, a release", lambda of: f"{of[0]}, {of[1]}", lost, lambda all: not np.any(all), "none")
    head = ["", "WoodenHaptics: MuJoCo", "own", "Falcon: MuJoCo", "own", "difference by"]
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(cells) + " |\n" for cells in lines)


def all_near(ratios, within):
    return max(abs(ratio - 1) for ratio in ratios) < within


def main():
    made = table()
    print(made)
    if len(sys.argv) > 1:
        page = Path(sys.argv[1])
        before, rest = page.read_text().split(MARK)
        page.write_text(f"{before}{MARK}{made}\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}")


if __name__ == "__main__":
    main()
