"""What comes back: arrays by name, a row a query, a tick, a start or a pose."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Closest(NamedTuple):
    """Closest points, a row a query.

    patch : (n,) uint32 -- index of the model's patch, see `Body.patches`.
    parameters : (n, 2) float64 -- (u, v) on that patch, 0 to 1.
    point : (n, 3) float64 -- the point, m, in the frame of the model. Along the surface it was up to 8e-4 sizes off
        on golden probes, where the distance hardly changes: four ticks of a `Body.tracker` at rest leave 2e-7
        on convex patches.
    gap : (n,) float64 -- the distance, m; negative inside a closed body, unless it was asked for without a sign.
    face : (n,) uint32 -- index of the body's face; a patch may be several.
    on_face : (n, 2) float32 -- (u, v) on the face, as the firmware has them.
    evaluations : (n,) uint32 -- evaluations of patches spent; `steps`, as the command's column, is the same.
    complete : (n,) bool -- whether every candidate was searched to its end; with modes, and the query is not `far`.
    far : (n,) bool -- whether the query lies beyond the tables: it takes the list of the nearest cell, which is not
        proved to hold the closest point from there, even if `complete`. `Body.bake` with a larger `margin` reaches it.
    clamped : (n,) bool -- whether a q was beyond its budget, and was set to it.
    error_bound : (n,) float64 -- how much nearer another point of the stored single-precision tables may be, m, proved;
        NaN unless asked for. The surface of your double-precision numbers may be some 1e-7 sizes nearer, and more
        where weights are uneven.
    """

    patch: NDArray[np.uint32]
    parameters: NDArray[np.float64]
    point: NDArray[np.float64]
    gap: NDArray[np.float64]
    face: NDArray[np.uint32]
    on_face: NDArray[np.float32]
    evaluations: NDArray[np.uint32]
    complete: NDArray[np.bool_]
    far: NDArray[np.bool_]
    clamped: NDArray[np.bool_]
    error_bound: NDArray[np.float64]

    @property
    def steps(self) -> NDArray[np.uint32]:
        """`evaluations`, by the name of the column of ``palpate closest``."""
        return self.evaluations


class Ticks(NamedTuple):
    """What a tracker knew after each tick, a row a tick.

    point : (n, 3) float64 -- the witness point, m, in the frame of the model.
    normal : (n, 3) float32 -- unit vector out of the body there.
    gap : (n,) float32 -- signed gap along it, m; negative inside. NaN in the first ticks, until it is
        `located` and has a normal.
    parameters : (n, 2) float32 -- (u, v) on a face, (t, 0) on an edge.
    feature : (n,) uint16 -- index of a face, of an edge plus 0x4000, of a vertex plus 0x8000.
    contact : (n,) uint8 -- 0 behind the surface, 1 in front of it, 2 touching.
    located : (n,) bool -- whether it was known where the closest point is.
    evaluations : (n,) uint8 -- evaluations of patches spent in the tick.
    """

    point: NDArray[np.float64]
    normal: NDArray[np.float32]
    gap: NDArray[np.float32]
    parameters: NDArray[np.float32]
    feature: NDArray[np.uint16]
    contact: NDArray[np.uint8]
    located: NDArray[np.bool_]
    evaluations: NDArray[np.uint8]


class Curved(NamedTuple):
    """Points of a face with their derivatives, a row each, in the frame of the model.

    point : (n, 3) float64 -- f, m.
    u, v : (n, 3) float64 -- f_u and f_v, m per unit of parameter.
    uu, uv, vv : (n, 3) float64 -- f_uu, f_uv and f_vv, m per unit of parameter squared.
    """

    point: NDArray[np.float64]
    u: NDArray[np.float64]
    v: NDArray[np.float64]
    uu: NDArray[np.float64]
    uv: NDArray[np.float64]
    vv: NDArray[np.float64]


class Settled(NamedTuple):
    """Where a control law ends on one face, a row a start.

    parameters : (n, 2) float32 -- (u, v) at the end.
    steps : (n,) uint32 -- steps up to the last that moved it in single precision, of every law alike; `most` where the
        last bits never rest, usual in single precision: compare laws by `arrived`.
    rests : (n,) bool -- whether its last eight steps did not move it in single precision, which takes eight. A method in
        double precision also rests where it has no step to take: at a minimum, or where Newton's matrix is singular.
    arrived : (n,) float64 -- steps until the point is within the tolerance of the face's closest point (found in double
        precision) and stays there to the end, of every law alike; NaN where it never is, or left the face.
    evaluations : (n,) float64 -- evaluations of the face until then: one a step; those of the projected laws evaluate
        again for each length tried.
    """

    parameters: NDArray[np.float32]
    steps: NDArray[np.uint32]
    rests: NDArray[np.bool_]
    arrived: NDArray[np.float64]
    evaluations: NDArray[np.float64]


class Apart(NamedTuple):
    """The closest pair of two faces, a row a pose.

    first : (n, 3) float64 -- on the first face, in the first model's frame, m.
    second : (n, 3) float64 -- on the second face, in the second model's frame, m.
    distance : (n,) float32 -- how far apart they are, m.
    """

    first: NDArray[np.float64]
    second: NDArray[np.float64]
    distance: NDArray[np.float32]


class ToolPairs(NamedTuple):
    """The closest pair of a body and a tool, a row a pose.

    distance : (n,) float32 -- of body and core, less the tool's radius, m.
    on_body : (n, 3) float64 -- on the body, in its model's frame, m.
    on_core : (n, 3) float64 -- on the tool's core, in the tool's frame, m.
    evaluations : (n,) uint32 -- evaluations of patches spent.
    status : (n,) str -- "converged" (cold) or "tracking"; "inside": body and core intersect: between smooth convex
        bodies the core's distance is minus the depth, otherwise the depth is at least minus it; "behind": the points
        rest on the far side of a convex body; "step-limit": stopped short.
    """

    distance: NDArray[np.float32]
    on_body: NDArray[np.float64]
    on_core: NDArray[np.float64]
    evaluations: NDArray[np.uint32]
    status: NDArray[np.str_]


class Dials(NamedTuple):
    """A knob's dial, a row a report: 100 a second.

    tick : (n,) uint32 -- the servo tick.
    angle : (n,) float64 -- by which the parts of the feel are set, rad.
    rate : (n,) float32 -- rad/s.
    torque : (n,) float32 -- of the feel, N·m, before soft start and limits.
    feel : (n,) uint8 -- the active feel: an index of the knob's table, or the one after it for yours.
    detent : (n,) int32 -- number of the nearest detent: a change is a detent that was passed.
    end : (n,) int8 -- -1 below the end stops, 1 above them, 0 between.
    kept : (n,) uint8 -- the stored feel at the last reset: 0 none, 1 used, 2 damaged or beyond the motor.
    turns : (n,) int32 -- whole turns that `angle` and `detent` do not count: ``tau * turns + angle`` never jumps.
    """

    tick: NDArray[np.uint32]
    angle: NDArray[np.float64]
    rate: NDArray[np.float32]
    torque: NDArray[np.float32]
    feel: NDArray[np.uint8]
    detent: NDArray[np.int32]
    end: NDArray[np.int8]
    kept: NDArray[np.uint8]
    turns: NDArray[np.int32]


class Turned(NamedTuple):
    """A simulated knob, a row a servo tick.

    angle : (n,) float64 -- by the encoder, as springs and end stops count it, rad.
    rate : (n,) float64 -- as the loop estimates it, rad/s.
    torque : (n,) float64 -- of the feel, N·m, before soft start and limits.
    shaft_angle : (n,) float64 -- of the simulated shaft, rad: `angle` without the encoder's error.
    shaft_torque : (n,) float64 -- of motor and cogging on the shaft, N·m.
    """

    angle: NDArray[np.float64]
    rate: NDArray[np.float64]
    torque: NDArray[np.float64]
    shaft_angle: NDArray[np.float64]
    shaft_torque: NDArray[np.float64]


class Run(NamedTuple):
    """A simulated run, a row a tick; rows of three joints or of three coordinates.

    state_hash : hash over every bit of the loop's state in every tick, as `palpate sim` and `palpate demo` print it.
    time : (n,) float64 -- s.
    counts : (n, 3) int32 -- encoder counts.
    duties : (n, 3) int16 -- motor duties, full scale 32767 either way.
    hand : (n, 3) float64 -- where the simulated probe really was, in the device's frame, m.
    probe : (n, 3) float32 -- where the loop took it to be, in the frame of the tables, m.
    parameters : (n, 2) float32 -- of the witness point, as in `Ticks`.
    force : (n, 3) float32 -- on the probe, N.
    gap : (n,) float32 -- signed gap, m.
    contact : (n,) uint32 -- as in `Ticks`.
    feature : (n,) uint32 -- as in `Ticks`.
    phase : (n,) uint32 -- 0 reset, 1 calibrate, 2 armed, 3 running, 4 fault.
    fault : (n,) uint32 -- what stopped the loop, 0 for nothing.
    q : (n, M) float32 -- q of each mode, m; M is 0 for a body without modes.
    digest : (n,) uint32 -- hash over every bit of the loop's state.
    """

    state_hash: str
    time: NDArray[np.float64]
    counts: NDArray[np.int32]
    duties: NDArray[np.int16]
    hand: NDArray[np.float64]
    probe: NDArray[np.float32]
    parameters: NDArray[np.float32]
    force: NDArray[np.float32]
    gap: NDArray[np.float32]
    contact: NDArray[np.uint32]
    feature: NDArray[np.uint32]
    phase: NDArray[np.uint32]
    fault: NDArray[np.uint32]
    q: NDArray[np.float32]
    digest: NDArray[np.uint32]


class Records(NamedTuple):
    """Telemetry, a row a record.

    tick : (n,) uint32 -- the tick that it records.
    number : (n,) uint32 -- which record it is, counted from 0: a gap is records that were lost on the line.
    phase : (n,) uint32 -- as in `Run`.
    fault : (n,) uint32 -- as in `Run`.
    feature : (n,) uint32 -- as in `Ticks`.
    contact : (n,) uint32 -- as in `Ticks`.
    overruns : (n,) uint32 -- ticks that overran so far.
    gap : (n,) float32 -- signed gap, m.
    probe : (n, 3) float32 -- the probe in the frame of the tables, m.
    force : (n, 3) float32 -- on the probe, N.
    duties : (n, 3) int16 -- motor duties, full scale 32767 either way.
    damaged : damaged frames since the port was opened.
    """

    tick: NDArray[np.uint32]
    number: NDArray[np.uint32]
    phase: NDArray[np.uint32]
    fault: NDArray[np.uint32]
    feature: NDArray[np.uint32]
    contact: NDArray[np.uint32]
    overruns: NDArray[np.uint32]
    gap: NDArray[np.float32]
    probe: NDArray[np.float32]
    force: NDArray[np.float32]
    duties: NDArray[np.int16]
    damaged: int
