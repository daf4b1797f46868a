"""Surfaces of the real geomdl and splinepy, and Newton's method, against those packages' own points."""

import geomdl.BSpline
import geomdl.NURBS
import geomdl.utilities
import numpy as np
import palpate
import pytest
import splinepy

U, V = 4, 3
# No symmetry that would forgive swapped rows, parameters or weights.
PLACES = np.array([[[0.03 * i, 0.02 * j, 0.004 * (i * i - j) + 0.002 * i * j] for j in range(V)] for i in range(U)])
WEIGHTS = np.array([[1.0 + 0.3 * i + 0.1 * j * j for j in range(V)] for i in range(U)])
KNOTS_U, KNOTS_V = [0, 0, 0, 0.3, 1, 1, 1], [0, 0, 0, 1, 1, 1]
BASELINES = ["newton", "saturated-newton", "projected-newton", "projected-gradient"]
AT = np.random.default_rng(3).uniform(size=(50, 2))


def of_geomdl(rational):
    surface = geomdl.NURBS.Surface() if rational else geomdl.BSpline.Surface()
    surface.degree_u, surface.degree_v = 2, 2
    if rational:
        weighted = np.concatenate([PLACES * WEIGHTS[..., None], WEIGHTS[..., None]], axis=-1)
        surface.ctrlpts_size_u, surface.ctrlpts_size_v = U, V
        surface.ctrlptsw = weighted.reshape(-1, 4).tolist()
    else:
        surface.ctrlpts_size_u, surface.ctrlpts_size_v = U, V
        surface.ctrlpts = PLACES.reshape(-1, 3).tolist()
    surface.knotvector_u, surface.knotvector_v = KNOTS_U, KNOTS_V
    return surface, lambda at: np.array([surface.evaluate_single(tuple(row)) for row in at])


def of_splinepy(rational):
    # The first parameter runs fastest.
    places, weights = PLACES.swapaxes(0, 1).reshape(-1, 3), WEIGHTS.T.reshape(-1, 1)
    spline = (
        splinepy.NURBS([2, 2], [KNOTS_U, KNOTS_V], places, weights)
        if rational
        else splinepy.BSpline([2, 2], [KNOTS_U, KNOTS_V], places)
    )
    return spline, spline.evaluate


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("make", [of_geomdl, of_splinepy])
def test_a_surface_is_the_one_that_its_package_evaluates(make, rational):
    surface, points = make(rational)
    body = palpate.Body.bake(surface)
    # A knot line cuts no face.
    assert body.faces == 1
    wanted = np.asarray(points(AT))
    # Single precision of places up to 0.1 m.
    assert np.abs(body.evaluate(0, AT).point - wanted).max() < 5e-8


def test_a_bezier_surface_of_splinepy_has_no_knots():
    bezier = splinepy.Bezier([2, 1], PLACES[:3, :2].swapaxes(0, 1).reshape(-1, 3))
    assert "knots_u" not in palpate.patch_of(bezier)
    point = palpate.Body.bake([bezier]).evaluate(0, AT).point
    assert np.abs(point - bezier.evaluate(AT)).max() < 5e-8


def test_what_is_no_surface_in_three_dimensions_is_refused():
    line = splinepy.Bezier([1], [[0.0, 0, 0], [1, 0, 0]])
    flat = splinepy.Bezier([1, 1], [[0.0, 0], [1, 0], [0, 1], [1, 1]])
    for thing, says in ((line, "1 parameters"), (flat, "2 dimensions"), (3.0, "float")):
        with pytest.raises(palpate.ModelError, match=says):
            palpate.patch_of(thing)
    trimmed = of_geomdl(False)[0]
    curve = geomdl.BSpline.Curve()
    curve.degree, curve.ctrlpts, curve.knotvector = 1, [[0.2, 0.2], [0.8, 0.8]], [0, 0, 1, 1]
    trimmed.trims = [curve]
    with pytest.raises(palpate.ModelError, match="trimmed"):
        palpate.patch_of(trimmed)


@pytest.mark.parametrize("law", BASELINES)
def test_the_baselines_end_where_the_surface_is_met_at_a_right_angle(law):
    spline, _ = of_splinepy(True)
    body = palpate.Body.bake(spline)
    at = np.array([[0.45, 0.55]])
    tangents = [np.asarray(spline.derivative(at, order))[0] for order in ([1, 0], [0, 1])]
    normal = np.cross(*tangents)
    probe = spline.evaluate(at)[0] + 0.004 * normal / np.linalg.norm(normal)
    settled = body.settle(0, probe, at + 0.04, law=law, most=5000)
    assert np.abs(settled.parameters - at).max() < 1e-5
    assert settled.rests.all()
    # Quadratic: five steps are as near; linear: not.
    near = np.abs(body.settle(0, probe, at + 0.04, law=law, most=5).parameters - at).max()
    assert (near > 1e-5) == (law == "projected-gradient")
    # As many steps as it takes to the last bit, and not one less: however many more it may take.
    [steps] = settled.steps
    assert body.settle(0, probe, at + 0.04, law=law, most=50).steps == [min(steps, 50)]
    exact = [body.settle(0, probe, at + 0.04, law=law, most=most).parameters for most in (steps - 1, steps)]
    assert (exact[0] != settled.parameters).any() and (exact[1] == settled.parameters).all()
    assert steps < 9 or law == "projected-gradient"


@pytest.mark.parametrize("law", ["second-order", "certified", *BASELINES])
def test_arrived_counts_the_steps_until_the_closest_point_is_near_for_good(law):
    spline, _ = of_splinepy(True)
    body = palpate.Body.bake(spline)
    foot = np.array([[0.45, 0.55]])
    normal = np.cross(*[np.asarray(spline.derivative(foot, order))[0] for order in ([1, 0], [0, 1])])
    probe = spline.evaluate(foot)[0] + 0.004 * normal / np.linalg.norm(normal)
    starts, most, tolerance = np.concatenate([foot, foot + 0.04, foot - 0.1]), 100, 1e-3
    settled = body.settle(0, probe, starts, law=law, most=most, tolerance=tolerance)
    ends = [body.settle(0, probe, starts, law=law, most=steps).parameters for steps in range(most + 1)]
    # By splinepy's points, against the foot that the probe was put out from.
    off = np.array([np.linalg.norm(spline.evaluate(end.astype(float)) - spline.evaluate(foot), axis=1) for end in ends])
    last_far = [np.flatnonzero(column > tolerance * body.size).max(initial=-1) for column in off.T]
    np.testing.assert_array_equal(settled.arrived, np.add(last_far, 1))
    # One a step; at least one more for the length of a projected step.
    a_step = 2 if law.startswith("projected") else 1
    assert (settled.evaluations >= a_step * settled.arrived).all()
    assert a_step == 2 or (settled.evaluations == settled.arrived).all()
    assert settled.arrived[0] == 0 < settled.arrived[1] <= settled.arrived[2] < most
    assert law not in ("second-order", "newton") or settled.arrived.max() < 12
    # With one step fewer than it takes it is never there.
    short = body.settle(0, probe, starts[2:], law=law, most=int(settled.arrived[2]) - 1, tolerance=tolerance)
    assert np.isnan(short.arrived).all()
    with pytest.raises(palpate.SettingsError, match="tolerance is 0"):
        body.settle(0, probe, starts, law=law, tolerance=0)


def test_newton_may_leave_the_face_and_an_unknown_law_is_named():
    body = palpate.Body.bake(of_splinepy(False)[0])
    beyond = np.array([0.2, 0.02, 0.0])
    left = body.settle(0, beyond, [[0.9, 0.5]], law="newton")
    assert np.isnan(left.parameters).all()
    assert not left.rests.any() and np.isnan(left.arrived).all()
    assert body.settle(0, beyond, [[0.9, 0.5]], law="saturated-newton").parameters[0, 0] == 1
    with pytest.raises(palpate.SettingsError, match="steepest.*projected-gradient"):
        body.settle(0, beyond, [[0.9, 0.5]], law="steepest")
