"""Surfaces of geomdl and splinepy as patches of a model. Neither is imported: they are known by their attributes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._native import ModelError


def is_surface(thing: Any) -> bool:
    """Whether it is a surface of geomdl or a spline of splinepy."""
    return _is_geomdl(thing) or _is_splinepy(thing)


def patch_of(surface: Any, *, name: str | None = None, flip: bool = False) -> dict[str, Any]:
    """A surface of geomdl (BSpline, NURBS) or splinepy (Bezier to NURBS) as a patch for `Body.bake`.

    `name` names it in messages; `flip` turns its outward normal round. Raises ModelError for a curve, a volume, a
    surface that does not lie in three dimensions, a trimmed one, and for any other object.
    """
    counts: tuple[int, ...]
    degree: tuple[int, ...]
    knots: Any
    weights: Any
    if _is_geomdl(surface):
        if surface.trims:
            raise ModelError("the surface is trimmed: give the whole surface, or import a STEP file")
        counts = int(surface.ctrlpts_size_u), int(surface.ctrlpts_size_v)
        if not surface.ctrlpts:
            raise ModelError("the surface has no control points")
        degree = int(surface.degree_u), int(surface.degree_v)
        # The second parameter runs fastest.
        places = np.array(surface.ctrlpts, dtype=float).reshape(*counts, -1)
        weights = np.array(surface.weights, dtype=float).reshape(counts) if surface.rational else None
        knots = surface.knotvector_u, surface.knotvector_v
    elif _is_splinepy(surface):
        if surface.para_dim != 2:
            raise ModelError(f"a spline over {surface.para_dim} parameters is no surface: give one over 2")
        counts = tuple(int(count) for count in surface.control_mesh_resolutions)
        degree = tuple(int(degree) for degree in surface.degrees)
        # The first parameter runs fastest.
        places = np.array(surface.control_points, dtype=float).reshape(*counts[::-1], -1).swapaxes(0, 1)
        weights = np.array(surface.weights, dtype=float).reshape(counts[::-1]).T if surface.is_rational else None
        knots = surface.knot_vectors if surface.has_knot_vectors else None
    else:
        raise ModelError(f"{type(surface).__name__} is neither a surface of geomdl nor a spline of splinepy")
    if places.shape[-1] != 3:
        raise ModelError(f"the surface lies in {places.shape[-1]} dimensions: give one in 3")
    if weights is not None:
        places = np.concatenate([places, weights[..., None]], axis=-1)
    patch: dict[str, Any] = {"degree": list(degree), "points": places.tolist(), "flip": flip}
    if knots is not None:
        patch["knots_u"], patch["knots_v"] = ([float(knot) for knot in along] for along in knots)
    if name is not None:
        patch["name"] = name
    return patch


def _is_geomdl(thing: Any) -> bool:
    return hasattr(thing, "ctrlpts_size_u") and hasattr(thing, "knotvector_u")


def _is_splinepy(thing: Any) -> bool:
    return hasattr(thing, "para_dim") and hasattr(thing, "control_points")
