"""What the tests share: bodies, and the plain loop in Rust that answers are held to."""

import os
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import palpate

FOLDER = Path(__file__).resolve().parent.parent
ROOT = FOLDER.parent.parent


class Loop(NamedTuple):
    """What the plain loop says: its seconds, and a row a point, in the bits of single precision."""

    seconds: float
    face: np.ndarray
    parameters: np.ndarray
    point: np.ndarray


@pytest.fixture(scope="session")
def capped_box():
    return palpate.Body.load(ROOT / "boards/bodies/capped_box.palp")


@pytest.fixture(scope="session")
def plain_loop(tmp_path_factory):
    """Closest points by the library alone."""
    program = os.environ.get("PALPATE_PLAIN_LOOP")
    assert program, "PALPATE_PLAIN_LOOP names no program: cargo palpate test --python builds it"

    def run(body, points):
        folder = tmp_path_factory.mktemp("loop")
        body.save(folder / "body.palp")
        np.asarray(points, dtype="<f8").tofile(folder / "points")
        command = [program, folder / "body.palp", folder / "points", folder / "out"]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        words = np.fromfile(folder / "out", dtype="<u4").reshape(-1, 6)
        single = words[:, 1:].copy().view(np.float32)
        return Loop(float(done.stdout), words[:, 0], single[:, :2], single[:, 2:])

    return run


def around(body, count, seed=1):
    """Points in a box of two sizes each way around a body's middle, by a grid on its faces."""
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 9)] * 2), -1).reshape(-1, 2)
    points = np.concatenate([body.evaluate(face, grid).point for face in range(body.faces)])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return middle + np.random.default_rng(seed).uniform(-1.0, 1.0, (count, 3)) * body.size


def same_bits(ours, theirs):
    """Both of one kind and shape, and alike in every bit."""
    ours, theirs = np.ascontiguousarray(ours), np.ascontiguousarray(theirs)
    assert (ours.dtype, ours.shape) == (theirs.dtype, theirs.shape)
    np.testing.assert_array_equal(ours.view(np.uint8), theirs.view(np.uint8))
