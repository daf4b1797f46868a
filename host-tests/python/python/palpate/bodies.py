"""Bodies, and what follows their closest points."""

from __future__ import annotations

import sys
import warnings
from os import PathLike
from typing import Any, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from .results import Apart, Closest, Curved, Settled, Ticks, ToolPairs
from .rows import row, rows
from .surfaces import is_surface, patch_of


def _within(what: str, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
    # Numbers that are none are refused behind this, by their own words.
    outside = ((parameters < 0.0) | (parameters > 1.0)).any(axis=1)
    if outside.any():
        raise _native.ArrayError(f"{what}[{int(outside.argmax())}] lies outside of the face: give 0 to 1")
    return parameters


class Body:
    """A body of patches, with the tables that the firmware has. Its memory is kept until the process ends."""

    __slots__ = ("_native",)

    def __init__(self, native: _native.Body):
        """Bodies come from `Body.bake` and `Body.load`."""
        self._native = native

    @staticmethod
    def bake(
        model: str | PathLike[str] | Sequence[Any] | Any,
        *,
        tolerance: float = 1e-5,
        unit: str = "m",
        modes: str | PathLike[str] | None = None,
        margin: float = 0.0,
        progress: bool = True,
    ) -> Body:
        """Bakes a body, its certificates and Voronoi regions proved on the way. From the second second on, `progress`
        prints how far it is to ``sys.stderr``, in one line, where that is a terminal.

        `model` is a path: a model file (``.toml``), a CAD part (``.step``, ``.stp``, made into patches within
        `tolerance`, m), a baked body (``.palp``), or the bare name of a model that ships. Or it is a list of patches,
        each a dictionary as in a model file: ``degree`` (two integers) and ``points`` (rows along u of rows along v of
        3 or 4 numbers, in `unit`: "m", "cm" or "mm"), and by choice ``name``, ``knots_u``, ``knots_v``, ``flip``. A
        surface of geomdl or splinepy is a patch as well, alone or in the list.

        With `modes`, the path of a modes file as of ``palpate closest --modes``, the body deforms: `closest` then takes
        `q`, and `simulate` moves its modes. `evaluate`, `settle` and `save` are of the body at rest.

        `margin`, 0 to 30 sizes of the body as of ``palpate bake --margin``, is how far its locator reaches beyond the
        bounding box; 0 leaves it to the tool: 0.5, or 1 for a single patch. `closest` marks points beyond it
        `far`: their answers may be wrong. ``palpate closest`` widens the locator of a model by itself.

        Raises ModelError for what is no body and for a fault of its modes, FileError for a spoiled ``.palp``,
        SettingsError for another margin, or one for a ``.palp``, FileNotFoundError and its like for a path that cannot
        be read; each names the culprit. Warns of each of its `flaws` near which signs and forces are wrong; open edges, as of a
        sheet, are none of these. Ctrl-C ends a bake.

        >>> import palpate
        >>> square = {"degree": [1, 1], "points": [[[0, 0, 0], [0, 4, 0]], [[6, 0, 0], [6, 4, 0]]]}
        >>> palpate.Body.bake([square], unit="cm").closest([0.03, 0.02, 0.01]).gap.round(9)
        array([0.01])
        """
        if is_surface(model):
            model = [model]
        if isinstance(model, (list, tuple)):
            model = [patch_of(patch) if is_surface(patch) else _plain(patch) for patch in model]
        told: list[int] = []
        # A log would get all of it as one long line.
        is_shown = progress and sys.stderr is not None and sys.stderr.isatty()

        def tell(done: int, of: int) -> None:
            told.append(done)
            print(f"\rbaking: {done} of {of} cells of space".ljust(60), end="", file=sys.stderr, flush=True)

        try:
            body = Body(_native.Body.bake(model, tolerance, unit, modes, margin, tell if is_shown else None))
        finally:
            if told:
                print(file=sys.stderr)
        for flaw, is_wrong in body._native.flaws:
            if is_wrong:
                warnings.warn(f"{body.name or 'model'}: {flaw}", stacklevel=2)
        return body

    @staticmethod
    def load(path: str | PathLike[str]) -> Body:
        """Reads a body's file (``.palp``), with everything in it checked.

        Raises FileError for one that is spoiled or none, FileNotFoundError and its like for one that cannot be read.
        """
        return Body(_native.Body.load(path))

    def save(self, path: str | PathLike[str]) -> None:
        """Writes the body's file (``.palp``), byte by byte the one that ``palpate bake`` writes."""
        self._native.save(path)

    def closest(
        self, points: ArrayLike, q: ArrayLike | None = None, *, signed: bool = True, bounded: bool = False
    ) -> Closest:
        """The closest points of `points`, (n, 3), m, each from a standing start.

        A body with modes takes `q` of each of its M modes, m: (M,) for all points, or (n, M); a q beyond `budget` is
        set to it, and `clamped` is true. The answers are those of ``palpate closest --modes``.

        ``signed=False`` leaves out on which side of a closed body a point is, which takes most of the time of a body at
        rest. ``bounded=True`` proves an `error_bound` of each point of a body at rest, against its single-precision
        tables, in up to 20,000 evaluations of patches a point. Raises ArrayError for another shape, or a number that
        is not finite.
        """
        places = rows("points", points, 3)
        return Closest(*self._native.closest(places, self._amplitudes(q, len(places)), signed, bounded))

    def _amplitudes(self, q: ArrayLike | None, count: int) -> NDArray[np.float64]:
        """`q` of every point, (count, M)."""
        modes = self.modes
        if q is None and modes:
            raise _native.ArrayError(f"q is missing: give q of each of the {modes} modes, m; zeros to stay at rest")
        if q is None:
            return np.empty((count, 0))
        if not modes:
            raise _native.ArrayError("q has no mode: leave it out, or bake the body with modes=")
        given = rows("q", q, modes, f": give q of each of the {modes} modes, m")
        if len(given) == 1:
            return np.repeat(given, count, axis=0)
        if len(given) != count:
            raise _native.ArrayError(f"q has {len(given)} rows, and points {count}: give one for all, or one a point")
        return given

    def evaluate(self, face: int, parameters: ArrayLike) -> Curved:
        """Points of a face at `parameters`, (n, 2), 0 to 1, with their first and second derivatives.

        Raises IndexError where there is no such face, ArrayError as `closest` does, and beyond the face.
        """
        return Curved(*self._native.evaluate(self._face(face), _within("parameters", rows("parameters", parameters, 2))))

    def settle(
        self,
        face: int,
        probe: ArrayLike,
        starts: ArrayLike,
        *,
        law: str = "second-order",
        most: int = 1000,
        tolerance: float = 1e-4,
    ) -> Settled:
        """Where a control law ends on one face for a `probe`, (3,), m, from each of `starts`, (n, 2), 0 to 1.

        `law` is "second-order", the firmware's, or "certified", the paper's at the certified gain. To compare with, in
        double precision and on covariant errors: "newton" (ends as NaN where it leaves the face), "saturated-newton",
        "projected-newton" and "projected-gradient". In our Figure 7 "newton" arrives from 53 % of the starts, the paper's
        own, on measure numbers, from 21 %: the notebook computes it. It takes at most `most` steps, all of them where
        single precision never rests. Compare laws by `arrived`: the steps until the witness point is within `tolerance`
        of the face's closest point, in sizes of the body, and stays; the default is that of the paper's Figure 7.

        On rational patches with unequal weights the bounds of both laws are wider: "certified" may take hundreds of
        times the steps, "second-order" twenty times. Give a larger `most` there.

        Raises IndexError where there is no such face, SettingsError for another law, for a number of steps out of
        range, and for a tolerance that is not above 0.
        """
        place = row("probe", probe, 3)
        if not 0 <= most < 2**32:
            raise _native.SettingsError(f"most is {most}: give 0 to 4294967295 steps")
        at = _within("starts", rows("starts", starts, 2))
        return Settled(*self._native.settle(self._face(face), place, at, law, most, tolerance))

    def _face(self, face: int) -> int:
        if not 0 <= face < self.faces:
            raise IndexError(f"there is no face {face}; there are {self.faces}")
        return face

    def tracker(self, *, law: str = "second-order", start: tuple[int, float, float] | None = None) -> Tracker:
        """A tracker that knows nothing yet, or whose witness point lies at `start`: a face and (u, v) on it.

        Raises SettingsError for a body with modes, IndexError where there is no such face, ArrayError beyond it.
        """
        if start is not None:
            [(u, v)] = _within("start", rows("start", start[1:], 2)).tolist()
            start = self._face(start[0]), u, v
        return Tracker(self._native.tracker(law, start))

    def pair(self, other: Body, face: int = 0, other_face: int = 0) -> Pair:
        """The closest pair of a face of this body and one of another; both begin in the middle of their faces.

        Raises SettingsError for a body with modes, IndexError where there is no such face.
        """
        return Pair(self._native.pair(other._native, self._face(face), other._face(other_face)))

    def tool(self, core: float | Sequence[float] | Body = 0.0, radius: float = 0.0) -> ToolTracker:
        """The closest pairs of this body and a tool: a convex core, and the radius of a ball around it, m.

        `core`: 0 for a point; half the length of a segment along the tool's z, m; half the sides of a box, (3,), m; or a
        convex Body. Raises SettingsError for a length that is none, a core that is not convex, a body with modes.
        """
        if isinstance(core, Body):
            return ToolTracker(self._native.tool((0.0, 0.0, 0.0), core._native, radius))
        x, y, z = row("core", (0.0, 0.0, core) if isinstance(core, (int, float)) else core, 3)
        return ToolTracker(self._native.tool((x, y, z), None, radius))

    @property
    def name(self) -> str:
        """The name of the model."""
        return self._native.name

    @property
    def patches(self) -> list[str]:
        """What the model's patches are called."""
        return self._native.patches

    @property
    def flaws(self) -> list[str]:
        """What ``palpate check`` finds: patches that cut each other and pieces within others, near which signs and forces are
        wrong and of which `bake` warns; and open edges, as of a sheet, of which it does not."""
        return [flaw for flaw, _ in self._native.flaws]

    @property
    def faces(self) -> int:
        """How many faces the body has."""
        return self._native.faces

    @property
    def edges(self) -> int:
        """How many edges."""
        return self._native.edges

    @property
    def vertices(self) -> int:
        """How many vertices."""
        return self._native.vertices

    @property
    def size(self) -> float:
        """The largest side of its bounding box, m."""
        return self._native.size

    @property
    def centre(self) -> tuple[float, float, float]:
        """Where the origin of its tables lies in the model, m."""
        return self._native.centre

    @property
    def modes(self) -> int:
        """How many modes it deforms by; 0 for a body that does not."""
        return self._native.modes

    @property
    def budget(self) -> float:
        """The maximum of abs(q) of each mode, m; 0 without modes."""
        return self._native.budget

    @property
    def is_closed(self) -> bool:
        """Whether it has an inside."""
        return self._native.is_closed

    @property
    def is_convex(self) -> bool:
        """Whether a probe outside has no nearest point but the closest one."""
        return self._native.is_convex

    def __repr__(self) -> str:
        return repr(self._native)


class Tracker:
    """The closest point of a body, followed from tick to tick as the firmware follows it."""

    __slots__ = ("_native",)

    def __init__(self, native: _native.Tracker):
        """Trackers come from `Body.tracker`."""
        self._native = native

    def step(self, points: ArrayLike) -> Ticks:
        """One servo tick a row of `points`, (n, 3), m. It goes on where the last call ended."""
        return Ticks(*self._native.step(rows("points", points, 3)))


class Pair:
    """The closest pair of two faces that do not intersect."""

    __slots__ = ("_native",)

    def __init__(self, native: _native.Pair):
        """Pairs come from `Body.pair`."""
        self._native = native

    def step(self, origins: ArrayLike, axes: ArrayLike | None = None, *, steps: int = 1) -> Apart:
        """`steps` steps at each pose of the second model in the frame of the first; it goes on where it was.

        `origins`, (n, 3), m, is where its origin lies; `axes`, (n, 3, 3), its x, y and z axis a row each, orthonormal
        and right-handed, or None where they are parallel. Raises ArrayError for others.
        """
        places = rows("origins", origins, 3)
        count = len(places)
        if axes is None:
            axes = np.broadcast_to(np.eye(3), (count, 3, 3))
        turned = np.asarray(axes, dtype=np.float64)
        if turned.shape != (count, 3, 3):
            raise _native.ArrayError(f"axes is of shape {turned.shape}, and must be ({count}, 3, 3)")
        return Apart(*self._native.step(places, turned.reshape(count, 9), steps))


class ToolTracker:
    """The closest pairs of a body and a tool, as `palpate pair` writes them."""

    __slots__ = ("_native",)

    def __init__(self, native: _native.ToolTracker):
        """Trackers of tools come from `Body.tool`."""
        self._native = native

    def locate(self, origins: ArrayLike, quaternions: ArrayLike) -> ToolPairs:
        """Cold, each pose by itself: `origins`, (n, 3), m, and `quaternions`, (n, 4), w first, of unit length.

        They take the tool's frame to the body's model. Raises ArrayError for others.
        """
        return _tool_pairs(self._native.locate, origins, quaternions)

    def step(self, origins: ArrayLike, quaternions: ArrayLike) -> ToolPairs:
        """One tick a pose; it goes on where the last call ended. The first pose, and one after a jump, is cold."""
        return _tool_pairs(self._native.step, origins, quaternions)


def _tool_pairs(query: Any, origins: ArrayLike, quaternions: ArrayLike) -> ToolPairs:
    places = rows("origins", origins, 3)
    turns = rows("quaternions", quaternions, 4)
    if len(places) != len(turns):
        raise _native.ArrayError(f"origins has {len(places)} rows, and quaternions {len(turns)}")
    distance, on_body, on_core, evaluations, status = query(places, turns)
    return ToolPairs(distance, on_body, on_core, evaluations, np.array(status, dtype=np.str_))


def _plain(patch: Any) -> Any:
    """A patch whose arrays are lists."""
    if not isinstance(patch, Mapping):
        return patch
    return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in patch.items()}
