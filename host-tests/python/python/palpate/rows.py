"""Whatever numpy takes for an array, as rows of double precision."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import ArrayError


def rows(what: str, array: ArrayLike, width: int, why: str = "", form: str = "") -> NDArray[np.float64]:
    """An array of (n, `width`); one row may come without its brackets.

    Raises ArrayError, with the name `what`, for anything else, and `form` and `why` for another shape.
    """
    try:
        given = np.asarray(array, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ArrayError(f"{what} is no array of real numbers: {error}") from None
    if np.iscomplexobj(array):
        raise ArrayError(f"{what} is no array of real numbers: it is complex")
    if given.shape == (width,):
        return given.reshape(1, width)
    if given.ndim != 2 or given.shape[1] != width:
        raise ArrayError(f"{what} is of shape {given.shape}, and must be {form or f'(n, {width})'}{why}")
    return given


def row(what: str, array: ArrayLike, width: int) -> tuple[float, ...]:
    """One row of so many numbers. Raises ArrayError, with the name `what`, for anything else."""
    given = rows(what, array, width, form=f"({width},)")
    if len(given) != 1:
        raise ArrayError(f"{what} is of shape {given.shape}, and must be ({width},)")
    return tuple(given[0].tolist())
