"""Bodies: baked from every kind of model, saved, loaded, refused."""

import re
import signal
import sys
import threading
import time
import warnings

import numpy as np
import palpate
import pytest

from conftest import ROOT, around, same_bits

SQUARE = {"name": "square", "degree": [1, 1], "points": [[[0, 0, 0], [0, 40, 0]], [[60, 0, 0], [60, 40, 0]]]}
NOT_FINITE = [[[0, 0, np.nan], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]


def test_patches_make_a_body():
    body = palpate.Body.bake([SQUARE], unit="mm")
    assert (body.patches, body.faces, body.edges, body.vertices) == (["square"], 1, 4, 4)
    assert not body.is_closed and "1 faces" in repr(body)
    found = body.closest([[0.03, 0.02, 0.01], [0.09, 0.08, 0.0]])
    # Over the middle, and beyond the corner (60 mm, 40 mm) by 30 mm and 40 mm.
    np.testing.assert_allclose(found.point, [[0.03, 0.02, 0.0], [0.06, 0.04, 0.0]], atol=1e-8)
    np.testing.assert_allclose(found.gap, [0.01, 0.05], atol=1e-8)


def test_numpy_points_make_the_same_body(tmp_path):
    array = dict(SQUARE, points=np.array(SQUARE["points"], dtype=float))
    for index, patch in enumerate((SQUARE, array)):
        palpate.Body.bake([patch], unit="mm").save(tmp_path / f"{index}.palp")
    assert (tmp_path / "0.palp").read_bytes() == (tmp_path / "1.palp").read_bytes()


def test_weights_knots_names_and_flips_are_those_of_the_model_file(tmp_path):
    # A quarter of a cylinder with the radius 1, exact as a rational patch; two spans along it.
    half = np.sqrt(0.5)
    rim = [[1, 0, 1], [1, 1, half], [0, 1, 1]]
    points = [[[x, y, z, w] for x, y, w in rim] for z in (0.0, 0.5, 1.0)]
    patch = {"name": "quarter", "degree": [1, 2], "points": points, "knots_u": [0, 0, 0.5, 1, 1], "flip": True}
    body = palpate.Body.bake([patch])
    text = f"""
        unit = "m"
        [[patch]]
        name = "quarter"
        degree = [1, 2]
        points = {[[list(map(float, point)) for point in row] for row in points]}
        knots_u = [0.0, 0.0, 0.5, 1.0, 1.0]
        flip = true
    """
    (tmp_path / "model.toml").write_text(text)
    other = palpate.Body.bake(tmp_path / "model.toml")
    points = around(body, 500)
    for ours, theirs in zip(body.closest(points), other.closest(points)):
        same_bits(ours, theirs)
    inside = np.hypot(*body.closest([[0.3, 0.4, 0.5]]).point[0, :2])
    assert abs(inside - 1.0) < 1e-6, "rounding: on the cylinder"


def test_a_saved_body_is_the_one_that_the_command_bakes(tmp_path):
    palpate.Body.bake("capped_box").save(tmp_path / "part.palp")
    assert (tmp_path / "part.palp").read_bytes() == (ROOT / "boards/bodies/capped_box.palp").read_bytes()
    assert palpate.Body.load(tmp_path / "part.palp").faces == 6


def test_a_part_from_cad_is_baked():
    body = palpate.Body.bake(ROOT / "host-tests/cad/tests/parts/box.step", tolerance=1e-5)
    assert body.is_closed and body.faces >= 6 and len(body.patches) >= 6
    points = around(body, 500)
    # A box by its corners: the distance to it has a closed form outside.
    ends = [[0, 0], [0, 1], [1, 0], [1, 1]]
    corners = np.concatenate([body.evaluate(face, ends).point for face in range(body.faces)])
    beyond = np.maximum(np.maximum(corners.min(axis=0) - points, points - corners.max(axis=0)), 0)
    exact = np.linalg.norm(beyond, axis=1)
    gap = body.closest(points).gap
    assert ((gap < 0) == (exact == 0)).all()
    np.testing.assert_allclose(gap[exact > 0], exact[exact > 0], atol=1e-6 * body.size)


@pytest.mark.parametrize(
    ("model", "says"),
    [
        ([], "no patch"),
        ([{"degree": [1, 1]}], r"patches\[0\]: it has no points"),
        ([SQUARE, dict(SQUARE, colour="red")], r"patches\[1\]: there is no key \"colour\""),
        ([dict(SQUARE, points=NOT_FINITE)], r"patches\[0\]: points\[\d\]\[\d\]: NaN is not finite"),
        ([dict(SQUARE, points="far")], r"patches\[0\]: its points are not rows of rows"),
        ([dict(SQUARE, degree=[9, 1])], "patches: patch \"square\""),
        ([dict(SQUARE, degree=[-1, 1])], r"patches\[0\]: its degree"),
        ([dict(SQUARE, flip=3)], r"patches\[0\]: its flip"),
        ([dict(SQUARE, knots_u=["a"])], r"patches\[0\]: its knots_u"),
        ([dict(SQUARE, name=3)], r"patches\[0\]: its name"),
        ([{3: 4}], r"patches\[0\]: a key is not a string"),
        ([SQUARE, 3], "a model is a path, or a list of patches"),
        (3, "a model is a path, or a list of patches"),
        (None, "a model is a path, or a list of patches"),
    ],
)
def test_what_is_no_model_is_refused_by_name(model, says):
    with pytest.raises(palpate.ModelError, match=says):
        palpate.Body.bake(model)


def test_units_and_tolerances_are_checked():
    with pytest.raises(palpate.ModelError, match="unit \"inch\" is unknown"):
        palpate.Body.bake([SQUARE], unit="inch")
    part = ROOT / "host-tests/cad/tests/parts/box.step"
    for tolerance in (0.0, -1.0, np.nan, 1e9):
        with pytest.raises(palpate.ModelError, match="a tolerance of .* m is not between"):
            palpate.Body.bake(part, tolerance=tolerance)


def test_files_that_are_no_models_are_refused_by_name(tmp_path):
    spoiled = {"text.toml": b"degree = [", "bytes.toml": b"\xff\xfe", "part.step": b"ISO-10303-21;\nHEADER;"}
    for name, data in spoiled.items():
        (tmp_path / name).write_bytes(data)
        with pytest.raises(palpate.ModelError, match=name):
            palpate.Body.bake(tmp_path / name)


def test_a_path_that_cannot_be_read_or_written_is_the_systems_own_error(tmp_path, capped_box):
    for ask in (palpate.Body.bake, palpate.Body.load):
        for name in ("no_such_model.toml", "none.palp", "none.step"):
            with pytest.raises(FileNotFoundError, match=name) as caught:
                ask(tmp_path / name)
            assert caught.value.filename == str(tmp_path / name)
        with pytest.raises(IsADirectoryError):
            ask(tmp_path)
    with pytest.raises(FileNotFoundError, match="no_such_folder"):
        capped_box.save(tmp_path / "no_such_folder/part.palp")


def test_every_spoiled_file_is_refused(tmp_path):
    good = (ROOT / "boards/bodies/capped_box.palp").read_bytes()
    file = tmp_path / "part.palp"
    random = np.random.default_rng(3)
    spoiled = [b"", b"palp", good[:-4], good[: len(good) // 2], good + b"\0\0\0\0", good[1:], good[::-1]]
    for _ in range(500):
        data = bytearray(good)
        data[random.integers(len(good))] ^= 1 << random.integers(8)
        spoiled.append(bytes(data))
    for data in spoiled:
        file.write_bytes(data)
        for ask in (palpate.Body.load, palpate.Body.bake):
            with pytest.raises(palpate.FileError, match="part.palp: "):
                ask(file)


def test_derivatives_are_those_of_finite_differences(capped_box):
    at, h = np.array([[0.4, 0.6]]), 1e-2
    here = capped_box.evaluate(0, at)
    corner = [capped_box.evaluate(0, at + h * np.array(side)).point for side in ([1, 1], [1, -1], [-1, 1], [-1, -1])]
    mixed = (corner[0] - corner[1] - corner[2] + corner[3]) / (4 * h * h)
    scale = capped_box.size
    # Single precision over h squared, 6e-8 * 1e4, of the size; and terms of the fourth order beside it.
    np.testing.assert_allclose(here.uv, mixed, atol=2e-3 * scale)
    for axis, (first, second) in enumerate([("u", "uu"), ("v", "vv")]):
        step = np.eye(2)[axis] * h
        low, high = capped_box.evaluate(0, at - step).point, capped_box.evaluate(0, at + step).point
        np.testing.assert_allclose(getattr(here, first), (high - low) / (2 * h), atol=1e-3 * scale)
        np.testing.assert_allclose(getattr(here, second), (high - 2 * here.point + low) / h**2, atol=2e-3 * scale)
    with pytest.raises(IndexError, match="there is no face 99; there are 6"):
        capped_box.evaluate(99, at)
    with pytest.raises(palpate.ArrayError, match=r"parameters\[0\] is not finite"):
        capped_box.evaluate(0, [[0.5, np.nan]])


def test_the_patch_of_the_page_is_a_quarter_of_a_cylinder():
    page = (ROOT / "docs/howto/python.md").read_text()
    [code] = [code for code in re.findall(r"```python\n(.*?)```", page, re.S) if "quarter" in code]
    names = {"palpate": palpate}
    exec(code, names)
    assert abs(names["gap"][0] - (np.hypot(0.03, 0.03) - 0.02)) < 1e-8


def test_a_long_bake_says_at_a_terminal_how_far_it_is_unless_it_is_to_be_silent(capsys, monkeypatch):
    sphere = ROOT / "host-tests/cad/tests/parts/s06.step"
    # Redirected, as into a log.
    palpate.Body.bake(sphere)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    palpate.Body.bake(sphere, progress=False)
    assert capsys.readouterr().err == ""
    palpate.Body.bake(sphere)
    said = capsys.readouterr().err
    steps = [tuple(map(int, step)) for step in re.findall(r"\rbaking: (\d+) of (\d+) cells of space", said)]
    assert steps and said.endswith("\n") and said.count("\n") == 1, repr(said)
    assert all(0 < done <= of for done, of in steps)


def box(low, high):
    """The six faces of a box, each with its normal outwards."""
    (a, b, c), (d, e, f) = low, high
    corners = lambda *points: [list(points[:2]), list(points[2:])]
    return [
        {"degree": [1, 1], "points": corners(*face), "flip": True}
        for face in (
            ([a, b, c], [a, b, f], [a, e, c], [a, e, f]),
            ([d, b, c], [d, e, c], [d, b, f], [d, e, f]),
            ([a, b, c], [d, b, c], [a, b, f], [d, b, f]),
            ([a, e, c], [a, e, f], [d, e, c], [d, e, f]),
            ([a, b, c], [a, e, c], [d, b, c], [d, e, c]),
            ([a, b, f], [d, b, f], [a, e, f], [d, e, f]),
        )
    ]


def test_boxes_that_cut_each_other_are_named_as_a_flaw():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert palpate.Body.bake(box((0, 0, 0), (0.01, 0.01, 0.01))).flaws == []
        # Without its lid it is open, and may be meant so.
        (flaw,) = palpate.Body.bake(box((0, 0, 0), (0.01, 0.01, 0.01))[:5]).flaws
        assert "open" in flaw
    cut = box((0, 0, 0), (0.01, 0.01, 0.01)) + box((0.005, 0.004, 0.003), (0.015, 0.014, 0.013))
    with pytest.warns(UserWarning, match="cut each other"):
        body = palpate.Body.bake(cut)
    assert any("cut each other" in flaw for flaw in body.flaws)


def test_an_interrupt_ends_a_bake():
    # A whole bake of the teapot takes 7 s of processor time, which does not depend on the machine's load: neither is it
    # over when the signal comes, nor does what is left of it run to its end.
    interrupt = threading.Timer(0.2, signal.raise_signal, [signal.SIGINT])
    begun = time.process_time()
    interrupt.start()
    with pytest.raises(KeyboardInterrupt):
        palpate.Body.bake("teapot")
    assert time.process_time() - begun < 1.5
    busy = True
    while busy:
        before = time.process_time()
        time.sleep(0.5)
        busy = time.process_time() - before > 0.05
    assert time.process_time() - begun < 3.5


def test_a_face_or_a_count_of_steps_out_of_range_is_named():
    body = palpate.Body.bake([SQUARE])
    for face in (-1, 1):
        with pytest.raises(IndexError, match=f"there is no face {face}; there are 1"):
            body.evaluate(face, [[0.5, 0.5]])
        with pytest.raises(IndexError, match=f"there is no face {face}; there are 1"):
            body.pair(body, face=face)
        with pytest.raises(IndexError, match=f"there is no face {face}; there are 1"):
            body.tracker(start=(face, 0.5, 0.5))
    with pytest.raises(palpate.ArrayError, match=r"parameters\[1\] lies outside of the face"):
        body.evaluate(0, [[0.5, 0.5], [2, -1]])
    with pytest.raises(palpate.SettingsError, match="most is -1"):
        body.settle(0, (0, 0, 1), [[0.5, 0.5]], most=-1)
    with pytest.raises(palpate.ArrayError, match=r"core is of shape \(2,\), and must be \(3,\)"):
        body.tool([0.01, 0.01])
