"""Closest points: the bits of the plain loop in Rust, its time, and rows made independently."""

import csv
import threading
import time

import numpy as np
import palpate
import pytest

from conftest import ROOT, around, same_bits


def check_bits(body, points, found, loop):
    same_bits(found.face, loop.face)
    same_bits(found.on_face, loop.parameters)
    # The tables' point in single precision, put into the frame of the model in double precision.
    same_bits(found.point, loop.point.astype(np.float64) + np.array(body.centre))
    # Two ways to sum three squares, and a root.
    np.testing.assert_allclose(np.linalg.norm(found.point - points, axis=1), found.gap, rtol=1e-15)


@pytest.mark.parametrize("name", ["capped_box", "sphere_body", "thin_plate", "table1c", "cylinder"])
def test_answers_are_those_of_the_loop_in_rust_in_every_bit(name, plain_loop):
    body = palpate.Body.bake(name)
    points = around(body, 20_000)
    check_bits(body, points, body.closest(points, signed=False), plain_loop(body, points))


def test_so_are_those_of_a_body_far_from_its_models_origin(plain_loop):
    away = np.array([5.0, -3.0, 0.25])
    bump = np.array([[[x, y, 0.1 * (x == 0.1 == y)] for y in (0, 0.1, 0.2)] for x in (0, 0.1, 0.2)]) + away
    body = palpate.Body.bake([{"degree": [2, 2], "points": bump}])
    assert np.linalg.norm(np.array(body.centre) - away) < 0.3, "its frame is near it"
    points = around(body, 5_000)
    check_bits(body, points, body.closest(points), plain_loop(body, points))


def test_a_million_points_take_hardly_longer_than_in_rust(capped_box, plain_loop):
    points = around(capped_box, 1_000_000)
    here, there = [], []
    # In turns, and the best of each: what else the machine does goes to both.
    for _ in range(3):
        start = time.perf_counter()
        found = capped_box.closest(points, signed=False)
        here.append(time.perf_counter() - start)
        loop = plain_loop(capped_box, points)
        there.append(loop.seconds)
    check_bits(capped_box, points, found, loop)
    ratio = min(here) / min(there)
    print(f"\nclosest of 1,000,000 points: {min(here):.3f} s here, {min(there):.3f} s in Rust, {ratio:.2f} times")
    # 1.2 is the aim; on a machine with other work, single runs were seen apart by a half of themselves.
    assert ratio < 1.8


def test_other_threads_run_meanwhile(capped_box):
    points = around(capped_box, 100_000)
    worker = threading.Thread(target=capped_box.closest, args=(points,))
    worker.start()
    turns = 0
    while worker.is_alive():
        turns += 1
        time.sleep(0.001)
    # With Python's lock held, this thread would have had no turn between the first and the last.
    assert turns > 10


def test_golden_rows_of_the_capped_box_are_met():
    file = ROOT / "../shared/data/capped_box_closest.csv"
    if not file.exists():
        pytest.skip("the golden rows are not beside this checkout")
    rows = list(csv.DictReader(line for line in file.open() if not line.startswith("#")))
    body = palpate.Body.bake("capped_box")
    queries = np.array([[float(row[key]) for key in ("qx", "qy", "qz")] for row in rows]) * 1e-3
    golden = np.array([float(row["dist"]) for row in rows]) * 1e-3
    found = body.closest(queries)
    assert len(rows) > 100 and found.complete.all()
    # A few roundings of single precision, of the body's size.
    assert np.abs(np.abs(found.gap) - np.abs(golden)).max() < 1e-6 * body.size


def test_distances_to_a_sphere_are_its_closed_form():
    body = palpate.Body.bake("sphere_body")
    low, high = (body.closest(10.0 * body.size * np.eye(3) * sign).point.diagonal() for sign in (-1, 1))
    middle, radius = 0.5 * (low + high), 0.5 * (high - low).mean()
    points = middle + np.random.default_rng(5).normal(size=(2000, 3)) * radius
    points = points[~body.closest(points).far]
    exact = np.linalg.norm(points - middle, axis=1) - radius
    found = body.closest(points)
    assert body.is_closed and (exact < 0).sum() > 100 and (exact > 0).sum() > 100
    # A few roundings of single precision, of the radius: the sphere's rational patches are exact.
    assert np.abs(found.gap - exact).max() < 1e-6 * radius
    unsigned = body.closest(points, signed=False)
    same_bits(unsigned.gap, np.abs(found.gap))


def test_no_point_is_nearer_than_the_bound_of_the_error_says():
    # Between two humps, where the search of a list may end on the farther one; heavy on one of them.
    i, j = np.meshgrid(np.arange(5), np.arange(5), indexing="ij")
    grid = 1e-3 * np.stack([20.0 * i, 20.0 * j, 12.0 * np.sin(1.7 * i) * np.cos(1.4 * j)], -1)
    weights = np.ones((5, 5, 1))
    weights[2, 3] = 2.5
    knots = [0, 0, 0, 0, 0.5, 1, 1, 1, 1]
    patch = {"degree": [3, 3], "knots_u": knots, "knots_v": knots, "points": np.concatenate([grid, weights], -1)}
    body = palpate.Body.bake([patch])
    # One that once ended 0.85 um too far, on the side of a valley that is nearly an arc around it.
    flat = [0.05452363317957871, 0.08783200007430436, 0.019509199654855987]
    points = np.concatenate([[flat], np.random.default_rng(3).uniform(-0.01, 0.09, (20, 3))])
    found = body.closest(points, bounded=True)
    steps = np.linspace(0, 1, 301)
    sampled = body.evaluate(0, np.stack(np.meshgrid(steps, steps), -1).reshape(-1, 2)).point
    nearest = np.array([np.linalg.norm(sampled - point, axis=1).min() for point in points])
    assert found.complete.all() and body.faces == 1
    assert (np.abs(found.gap) - found.error_bound <= nearest + 1e-7 * body.size).all()
    # The search skips an evaluation that is proved to bring no more, and the proof ends a ten-millionth from the truth.
    assert (found.error_bound < 2.5e-6 * body.size).all() and (found.error_bound >= 0).all()
    assert np.isnan(body.closest(points).error_bound).all()


def test_the_bound_of_the_error_is_of_the_tables_in_single_precision():
    i, j = np.meshgrid(np.arange(4), np.arange(4), indexing="ij")
    flat = np.stack([i / 30, j / 30, 0.0 * i], -1)
    random, violations = np.random.default_rng(7), []
    for _ in range(4):
        net = flat + random.uniform(-0.01, 0.01, flat.shape) + random.uniform(-0.1, 0.1, 3)
        body = palpate.Body.bake([{"degree": [3, 3], "points": net}])
        ends = net.reshape(-1, 3)
        points = random.uniform(ends.min(axis=0) - 0.03, ends.max(axis=0) + 0.03, (500, 3))
        found = body.closest(points, bounded=True)
        # Gauss-Newton in double precision on the Bezier patch itself.
        at, nearest = found.parameters, np.full(len(points), np.inf)
        for _ in range(30):
            bases = [np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], -1) for t in at.T]
            slopes = [np.stack([-3 * (1 - t) ** 2, 3 * (1 - t) * (1 - 3 * t), 3 * t * (2 - 3 * t), 3 * t**2], -1) for t in at.T]
            pairs = [bases, [slopes[0], bases[1]], [bases[0], slopes[1]]]
            place, along_u, along_v = (np.einsum("ni,nj,ijk->nk", *pair, net) for pair in pairs)
            nearest = np.minimum(nearest, np.linalg.norm(points - place, axis=1))
            along = np.stack([along_u, along_v], -1)
            across = along.swapaxes(1, 2)
            step = np.linalg.solve(across @ along, across @ (points - place)[..., None])
            at = np.clip(at + step[..., 0], 0, 1)
        violations.append((np.abs(found.gap) - found.error_bound - nearest).max() / body.size)
    print(f"\nthe model's own surface is nearer than the bound says by {max(violations):.0e} sizes at most")
    assert 0 < max(violations) < 2**-24


def test_queries_beyond_the_tables_are_marked(capped_box):
    found = capped_box.closest([[0.03, 0.02, 0.05], [50.0, 50.0, 50.0]])
    assert found.far.tolist() == [False, True]
    assert found.steps is found.evaluations


def test_a_margin_reaches_what_is_far_without_it():
    part = ROOT / "host-tests/cad/tests/parts/s12.step"
    rows = list(csv.DictReader(part.with_suffix(".csv").open()))
    queries, exact = (1e-3 * np.array([[float(row[key]) for key in keys] for row in rows]) for keys in (("qx", "qy", "qz"), ["dist"]))
    found = {margin: palpate.Body.bake(part, margin=margin).closest(queries) for margin in (0.0, 2.2)}
    off = {margin: np.abs(np.abs(found[margin].gap) - exact[:, 0]) for margin in found}
    far = found[0.0].far
    print(f"\ns12: {far.sum()} of {len(rows)} points far, off by {1e3 * off[0.0][far].max():.4f} mm at most, the others by "
          f"{1e3 * off[0.0][~far].max():.4f} mm; with a margin of 2.2 all by {1e3 * off[2.2].max():.4f} mm")  # fmt: skip
    assert far.sum() == 20 and found[0.0].complete[far].all() and not found[2.2].far.any()
    # By how much the import deviates from the part, by its report.
    assert max(off[0.0][~far].max(), off[2.2].max()) < 4.93e-6 < off[0.0][far].max()


@pytest.mark.parametrize("margin", [-0.1, 30.1, np.nan])
def test_a_margin_out_of_range_is_refused(margin):
    with pytest.raises(palpate.SettingsError, match="give 0 to 30, in sizes of the body"):
        palpate.Body.bake("table1c", margin=margin)
    with pytest.raises(palpate.SettingsError, match="a .palp file has its locator already"):
        palpate.Body.bake(ROOT / "boards/bodies/capped_box.palp", margin=1.0)


@pytest.mark.parametrize(
    ("points", "says"),
    [
        (np.zeros((3, 2)), r"points is of shape \(3, 2\), and must be \(n, 3\)"),
        (np.zeros((2, 3, 3)), r"points is of shape \(2, 3, 3\)"),
        (1.0, r"points is of shape \(\)"),
        ([[0, 0, 0], [0, 0, np.nan]], r"points\[1\] is not finite"),
        ([[0, -np.inf, 0]], r"points\[0\] is not finite"),
        ([[0, 0, 0], [1e10, 0, 0]], r"points\[1\] is beyond 1e9"),
        ([["a", "b", "c"]], "points is no array of real numbers"),
        ([[0, 0], [0, 0, 0]], "points is no array of real numbers"),
        ([[1j, 0, 0]], "points is no array of real numbers"),
        (None, "points is no array of real numbers|points is of shape"),
    ],
)
def test_bad_points_are_refused_by_name(capped_box, points, says):
    for ask in (capped_box.closest, capped_box.tracker().step):
        with pytest.raises(palpate.ArrayError, match=says):
            ask(points)


def test_arrays_of_every_kind_are_taken_for_what_they_hold(capped_box):
    points = np.round(around(capped_box, 50) * 1e3)
    plain = capped_box.closest(points)
    strided = np.zeros((100, 6))
    strided[::2, ::2] = points
    for same in (points.tolist(), points.astype(np.int64), points.astype(">f8"), np.asfortranarray(points),
                 strided[::2, ::2]):  # fmt: skip
        for ours, theirs in zip(capped_box.closest(same), plain):
            same_bits(ours, theirs)
    same_bits(capped_box.closest(points[0]).point, plain.point[:1])
    assert capped_box.closest(np.zeros((0, 3))).point.shape == (0, 3)
