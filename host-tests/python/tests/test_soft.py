"""Bodies with modes: golden rows, the displaced surface by numpy alone, budgets, refusals, modes in the loop."""

import csv
import sys

import numpy as np
import palpate
import pytest

from conftest import ROOT, around, same_bits

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

MODEL = ROOT / "host-tests/models/capped_box.toml"
FOAM = ROOT / "host-tests/soft/capped_box.modes.toml"
GOLDEN = ROOT / "host-tests/truth/golden/deform"
# Some roundings of single precision, of coordinates up to the size.
ROUNDED = 3e-7


@pytest.fixture(scope="module")
def foam():
    return palpate.Body.bake("capped_box", modes=FOAM)


@pytest.mark.parametrize("name", ["capped_box", "rounded_cylinder"])
def test_golden_rows_of_deformed_bodies_are_met(name):
    file = (line for line in (GOLDEN / "cold.csv").open() if not line.startswith("#"))
    golden = [row for row in csv.DictReader(file) if row["body"] == name]
    body = palpate.Body.bake(name, modes=GOLDEN / f"{name}.modes.toml")
    columns = ("xyz", ["q0", "q1", "q2", "q3"])
    points, q = (np.array([[float(row[key]) for key in keys] for row in golden]) for keys in columns)
    distance, inside = (np.array([float(row[key]) for row in golden]) for key in ("distance", "inside"))
    found = body.closest(points, q)
    assert len(golden) > 50 and body.modes == 4 and not found.clamped.any()
    assert found.complete.all() and not found.far.any()
    assert np.abs(np.abs(found.gap) - distance).max() < ROUNDED * body.size
    # On the surface there is no side.
    off = distance > 1e-6 * body.size
    np.testing.assert_array_equal(found.gap[off] < 0, inside[off] == 1)


class Displaced:
    """The capped box displaced by its foam modes: the surface, in double precision and by numpy alone."""

    def __init__(self, q):
        """At one `q`, (M,), m."""
        model = tomllib.loads(MODEL.read_text())
        assert all(patch["degree"] == [3, 3] and "knots_u" not in patch for patch in model["patch"])
        self.points = 1e-3 * np.array([patch["points"] for patch in model["patch"]])
        modes = tomllib.loads(FOAM.read_text())["mode"]
        assert not any("bump" in mode for mode in modes)
        self.parts = [(q, np.array(mode["centre"]), mode["half"], np.array(mode["poly"])) for q, mode in zip(q, modes)]

    def at(self, patch, uv):
        """Points of a patch at (..., 2)."""
        t = np.moveaxis(uv, -1, 0)
        u, v = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], -1)
        rest = np.einsum("...i,...j,ijk->...k", u, v, self.points[patch])
        moved = rest.copy()
        for q, centre, half, poly in self.parts:
            x, y, z = np.moveaxis((rest - centre) / half, -1, 0)
            moved += q * np.stack([np.ones_like(x), x, y, z, x * x, x * y, x * z, y * y, y * z, z * z], -1) @ poly
        return moved

    def distance(self, place, count=49):
        """To its nearest point: every local minimum of a grid, closed in on."""
        axis = np.linspace(0, 1, count)
        grid = np.stack(np.meshgrid(axis, axis, indexing="ij"), -1)
        window = np.stack(np.meshgrid(*[np.linspace(-1, 1, 7)] * 2, indexing="ij"), -1).reshape(-1, 2)
        nearest = np.inf
        for patch in range(len(self.points)):
            far = np.linalg.norm(self.at(patch, grid) - place, axis=-1)
            padded = np.pad(far, 1, constant_values=np.inf)
            around_it = [padded[i : i + count, j : j + count] for i in range(3) for j in range(3)]
            starts = grid[far <= np.min(around_it, axis=0)]
            width = 1.0 / (count - 1)
            # 0.6 to the 45th: a parameter to 1e-12, with room to recentre.
            for _ in range(45):
                tried = np.clip(starts[:, None] + width * window, 0, 1)
                far = np.linalg.norm(self.at(patch, tried) - place, axis=-1)
                starts = tried[np.arange(len(starts)), far.argmin(axis=1)]
                width *= 0.6
            nearest = min(nearest, far.min())
        return nearest

    def turns(self, place, count=49):
        """How often the surface winds around a place: solid angles of its triangles, of 4 pi."""
        axis = np.linspace(0, 1, count)
        corner = np.stack([self.at(patch, np.stack(np.meshgrid(axis, axis, indexing="ij"), -1)) for patch in range(6)])
        a, d, b, c = (corner[:, i : count - 1 + i, j : count - 1 + j] - place for i in (0, 1) for j in (0, 1))
        total = 0.0
        for one, two, three in ((a, b, c), (a, c, d)):
            [x, y, z] = (np.linalg.norm(side, axis=-1) for side in (one, two, three))
            dot = [np.einsum("...k,...k", *pair) for pair in ((one, two), (two, three), (three, one))]
            top = np.einsum("...k,...k", one, np.cross(two, three))
            total += 2 * np.arctan2(top, x * y * z + dot[0] * z + dot[1] * x + dot[2] * y).sum()
        return total / (4 * np.pi)


def test_answers_are_those_of_the_displaced_surface(foam):
    random = np.random.default_rng(8)
    points = around(foam, 40, seed=7)
    q = random.uniform(-foam.budget, foam.budget, (40, 4))
    points[30:] = [0.03, 0.02, 0.01] + random.uniform(-0.009, 0.009, (10, 3))
    found = foam.closest(points, q)
    assert not found.clamped.any() and found.complete[~found.far].all() and not found.far[30:].any()
    size = foam.size
    for index in np.flatnonzero(~found.far):
        surface = Displaced(q[index])
        assert abs(abs(found.gap[index]) - surface.distance(points[index])) < ROUNDED * size, index
        there = surface.at(found.patch[index], found.parameters[index])
        assert np.linalg.norm(there - found.point[index]) < ROUNDED * size, index
        # Triangles of a grid are a surface within micrometres of it.
        if abs(found.gap[index]) > 1e-3 * size:
            assert (abs(surface.turns(points[index])) > 0.5) == (found.gap[index] < 0), index
    assert (found.gap < 0).sum() > 5 and (found.gap > 0).sum() > 20
    same_bits(foam.closest(points, q, signed=False).gap, np.abs(found.gap))


def test_modes_move_the_answers_and_zeros_do_not(foam, capped_box):
    points = around(foam, 200)
    rest, still = capped_box.closest(points), foam.closest(points, np.zeros(4))
    # Where the body is at rest, a second search ends where the first did.
    assert np.abs(still.gap - rest.gap).max() < ROUNDED * foam.size and not still.clamped.any()
    moved = foam.closest(points, np.full(4, 0.5 * foam.budget))
    assert np.abs(moved.gap - rest.gap).max() > 0.01 * foam.size
    assert not rest.clamped.any() and (capped_box.modes, capped_box.budget) == (0, 0)


def test_a_q_beyond_its_budget_is_set_to_it_and_marked(foam):
    assert np.isclose(foam.budget, 0.00214, rtol=1e-6), "the first number of the modes file"
    points = around(foam, 60)
    q = np.random.default_rng(4).uniform(-1.5 * foam.budget, 1.5 * foam.budget, (60, 4))
    q[0], q[1] = foam.budget, -foam.budget
    found, within = foam.closest(points, q), foam.closest(points, np.clip(q, -foam.budget, foam.budget))
    np.testing.assert_array_equal(found.clamped, (np.abs(q) > foam.budget).any(axis=1))
    assert found.clamped.any() and not found.clamped[:2].any() and not within.clamped.any()
    for ours, theirs in zip(found._replace(clamped=within.clamped), within):
        same_bits(ours, theirs)


def test_one_row_of_q_is_for_all_points(foam):
    points, q = around(foam, 20), np.array([1e-3, -5e-4, 2e-4, 1e-4])
    whole = foam.closest(points, np.tile(q, (20, 1)))
    for same in (q, q.tolist(), q[None]):
        for ours, theirs in zip(foam.closest(points, same), whole):
            same_bits(ours, theirs)
    assert foam.closest(np.zeros((0, 3)), np.zeros((0, 4))).point.shape == (0, 3)


@pytest.mark.parametrize(
    ("q", "says"),
    [
        ([[0, 0, 0, 0], [0, np.nan, 0, 0]], r"q\[1\]: q1 is NaN: give a finite number of metres"),
        ([0, 0, 0, np.inf], r"q\[0\]: q3 is inf: give a finite"),
        ([0, 0, 1e10, 0], r"q\[0\]: q2 is beyond 1e9: give metres"),
        ([0, 0, 0], r"q is of shape \(3,\), and must be \(n, 4\): give q of each of the 4 modes, m"),
        (np.zeros((2, 5)), r"q is of shape \(2, 5\), and must be \(n, 4\): give q of each of the 4 modes, m"),
        (np.zeros((3, 4)), "q has 3 rows, and points 2: give one for all, or one a point"),
        (None, "q is missing: give q of each of the 4 modes, m"),
        (["a", "b", "c", "d"], "q is no array of real numbers"),
    ],
)
def test_a_bad_q_is_refused_by_name(foam, q, says):
    with pytest.raises(palpate.ArrayError, match=says):
        foam.closest(np.zeros((2, 3)), q)


def test_a_body_without_modes_takes_no_q(capped_box):
    with pytest.raises(palpate.ArrayError, match="q has no mode: leave it out, or bake the body with modes="):
        capped_box.closest([0, 0, 0], [0.0])


def changed(key, entry):
    """The foam's modes file with the first entry of a key changed; without it, where the entry is empty."""
    lines = FOAM.read_text().splitlines()
    index = next(index for index, line in enumerate(lines) if line.startswith(f"{key} = "))
    lines[index] = f"{key} = {entry}" if entry else ""
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("budget = 0.01", r"0 modes: a body has 1 to 8; add a \[\[mode\]\]"),
        ("budget = 0.01\n" + "[[mode]]\npoly = []\n" * 9, "9 modes: a body has 1 to 8"),
        ("", "missing field `budget`"),
        (changed("budget", "-1.0"), "the file: budget is -1: must be above 0"),
        (changed("budget", "1e300"), "mode \"mode 0\": budget, poly, half and radius give a displacement that is too large"),
        (changed("mass", "0.0"), "mode \"mode 0\": mass is 0: must be above 0"),
        (changed("poly", ""), "mode \"mode 0\": no poly: give 10 vectors"),
        (changed("poly", "[[1.0, 0.0, 0.0]]"), "mode \"mode 0\": poly has 1 entries: 10"),
        (changed("half", "nan"), "mode \"mode 0\": half is NaN: must be above 0 and finite"),
        (b"\xff", "is not text in UTF-8"),
    ],
)
def test_a_bad_modes_file_is_refused_by_name(tmp_path, capped_box, text, says):
    file = tmp_path / "bad.modes.toml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    capped_box.save(tmp_path / "part.palp")
    with pytest.raises(palpate.ModelError, match=f"(?s)bad.modes.toml: .*{says}"):
        palpate.Body.bake(tmp_path / "part.palp", modes=file)


def test_modes_are_refused_where_they_are_of_no_use(foam, tmp_path):
    with pytest.raises(FileNotFoundError, match="none.toml"):
        palpate.Body.bake("capped_box", modes=tmp_path / "none.toml")
    for ask in (foam.tracker, lambda: foam.pair(foam)):
        with pytest.raises(palpate.SettingsError, match="bodies without modes: bake this one without modes="):
            ask()
    # A patch in two faces: its tables have the surface of the first alone.
    points = [[[x, y, x % 2] for y in (0, 1)] for x in (0, 1, 2)]
    roof = palpate.Body.bake([{"degree": [1, 1], "points": points, "knots_u": [0, 0, 0.5, 1, 1]}])
    assert (roof.faces, len(roof.patches)) == (2, 1)
    roof.save(tmp_path / "cut.palp")
    with pytest.raises(palpate.ModelError, match="a divided patch .*: bake the model's own file"):
        palpate.Body.bake(tmp_path / "cut.palp", modes=FOAM)


def test_in_the_loop_the_modes_give_way_and_ring_on(foam, capped_box):
    run = palpate.simulate("woodenhaptics-2016", foam, seconds=2.0)
    rigid = palpate.simulate("woodenhaptics-2016", capped_box, seconds=2.0)
    assert run.q.shape == (8000, 4) and rigid.q.shape == (8000, 0) and not run.fault.any()
    touching = run.contact == 2
    first = touching.argmax()
    assert touching.any() and not run.q[:first].any() and np.abs(run.q).max() > 1e-4
    same_bits(run.counts[:first], rigid.counts[:first])
    assert run.state_hash != rigid.state_hash
    # Without a force each mode rings: the closed form of a damped oscillator, from the numbers of the modes file.
    free = np.flatnonzero(~touching[:-2] & ~touching[1:-1] & ~touching[2:])
    free = free[free > first]
    assert len(free) > 100
    for mode, own in enumerate(tomllib.loads(FOAM.read_text())["mode"]):
        q = run.q[:, mode].astype(np.float64)
        angle, ratio = 2 * np.pi * own["frequency"] / 4000.0, own["damping"]
        decay, turn = np.exp(-ratio * angle), np.sqrt(1 - ratio**2) * angle
        expected = 2 * decay * np.cos(turn) * q[free + 1] - decay**2 * q[free]
        # Single precision, of the largest q.
        assert np.abs(q[free + 2] - expected).max() < 1e-6 * np.abs(q).max(), mode


def test_a_mode_that_does_not_say_how_it_moves_is_refused_by_the_loop(tmp_path):
    file = tmp_path / "still.modes.toml"
    file.write_text(changed("frequency", ""))
    body = palpate.Body.bake("capped_box", modes=file)
    assert body.closest([0, 0, 0.1], np.zeros(4)).gap.shape == (1,), "it needs no motion"
    with pytest.raises(palpate.ModelError, match="still.modes.toml: mode \"mode 0\": no frequency"):
        palpate.simulate("woodenhaptics-2016", body)
