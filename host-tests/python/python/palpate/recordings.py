"""Recordings of runs, as ``palpate demo`` and ``palpate sim --recording`` write them."""

from __future__ import annotations

import json
import tempfile
from base64 import b64decode
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._native import FileError, SettingsError
from .bodies import Body
from .rig import Loop


class Recording(NamedTuple):
    """A recorded run: what the sensors read in each tick, and the loop's settings. It holds no forces: `loop` computes
    them again.

    model, device : names of the model and of the device.
    on : the board or machine of the run.
    rendering : "smooth", "eased" or "plain".
    state_hash : as in `Run`.
    rate_hz, stiffness_n_per_m, damping_n_s_per_m, max_force_n, velocity_corner_hz, soft_start_s : the loop's settings.
    body_origin_m : (3,) float32 -- where the body's tables have their origin, in the device's frame.
    link_timeout_s : silence of the host after which the loop stops.
    time_s : (n,) float64
    counts : (n, 3) int32 -- encoder counts.
    enable : (n,) bool -- whether force is requested.
    device_numbers : (k,) float32 -- the device, and its protection if the run had it, for `Loop`.
    bodies : name and file (``.palp``) of each body.
    is_scene : whether the bodies are those of a scene.

    >>> import palpate
    >>> run = palpate.Recording.load("run.json")           # doctest: +SKIP
    >>> loop = run.loop()                                  # doctest: +SKIP
    >>> for counts, enable in zip(run.counts.tolist(), run.enable.tolist()):       # doctest: +SKIP
    ...     duties = loop.tick(counts, enable)             # loop.force, loop.gap, loop.probe …
    """

    model: str
    device: str
    on: str
    rendering: str
    state_hash: str
    rate_hz: float
    stiffness_n_per_m: float
    damping_n_s_per_m: float
    max_force_n: float
    velocity_corner_hz: float
    soft_start_s: float
    body_origin_m: NDArray[np.float32]
    link_timeout_s: float
    time_s: NDArray[np.float64]
    counts: NDArray[np.int32]
    enable: NDArray[np.bool_]
    device_numbers: NDArray[np.float32]
    bodies: list[tuple[str, bytes]]
    is_scene: bool

    @staticmethod
    def load(path: str | PathLike[str]) -> Recording:
        """Reads a recording (``.json``).

        Raises FileError for a file that is none or is cut short, FileNotFoundError and its like for one that cannot be
        read.
        """
        text = Path(path).read_bytes()
        try:
            return _read(json.loads(text))
        except (KeyError, TypeError, ValueError) as error:
            says = f"missing entry {error}" if isinstance(error, KeyError) else str(error)
            raise FileError(f"{path}: no recording of palpate: {says}") from None

    def body(self, index: int = 0) -> Body:
        """A body that was felt."""
        _, file = self.bodies[index]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "body.palp"
            path.write_bytes(file)
            return Body.load(path)

    def loop(self, device: str | PathLike[str] | None = None, *, protected: bool = False) -> Loop:
        """The loop of the run, before its first tick, on the recorded device and as protected as it was; or on another
        `device` by name or file, `protected` or not.

        Raises SettingsError for a scene, for an eased rendering, and for `protected` without a device.
        """
        if self.is_scene or self.rendering == "eased":
            what = "a scene" if self.is_scene else "an eased rendering"
            raise SettingsError(f"{what} cannot be computed again from Python: use palpate view --recording")
        if device is None and protected:
            raise SettingsError("protected: the recorded device is as protected as it was; give a device as well")
        body = self.body()
        return Loop(
            self.device_numbers.tolist() if device is None else device,
            body,
            rate=self.rate_hz,
            stiffness=self.stiffness_n_per_m,
            damping=self.damping_n_s_per_m,
            max_force=self.max_force_n,
            velocity_corner=self.velocity_corner_hz,
            soft_start=self.soft_start_s,
            smooth=self.rendering == "smooth",
            protected=protected,
            at=self.body_origin_m.astype(np.float64) - np.asarray(body.centre),
        )


def _read(found: Any) -> Recording:
    if found["palpate"] != "recording":
        raise ValueError(f'"palpate" is {found["palpate"]!r}, not "recording"')
    ticks = int(found["ticks"])
    rate, stiffness, damping, force, corner, soft_start, *origin = (np.float32(number) for number in found["settings"])
    return Recording(
        model=found["model"],
        device=found["device"],
        on=found["on"],
        rendering=found.get("rendering", "plain"),
        state_hash=found["hash"],
        rate_hz=float(rate),
        stiffness_n_per_m=float(stiffness),
        damping_n_s_per_m=float(damping),
        max_force_n=float(force),
        velocity_corner_hz=float(corner),
        soft_start_s=float(soft_start),
        body_origin_m=np.array(origin, dtype=np.float32),
        link_timeout_s=float(np.float32(found["link_timeout"])),
        time_s=np.arange(ticks) / float(rate),
        counts=_counts(b64decode(found["counts"], validate=True), ticks),
        enable=np.arange(ticks) >= found["enable_at"],
        device_numbers=np.frombuffer(b64decode(found["device_numbers"], validate=True), dtype="<f4"),
        bodies=[(body["name"], b64decode(body["file"], validate=True)) for body in found["bodies"]],
        is_scene=found["scene"] is not None,
    )


def _counts(code: bytes, ticks: int) -> NDArray[np.int32]:
    """Differences of three counts from tick to tick, zig-zag and LEB128."""
    differences, number, shift = [], 0, 0
    for byte in code:
        number |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            differences.append(number >> 1 ^ -(number & 1))
            number, shift = 0, 0
    if len(differences) != 3 * ticks or shift:
        raise ValueError(f"{len(differences)} counts, not 3 in each of {ticks} ticks")
    # They wrap at 32 bits.
    return np.cumsum(np.array(differences, dtype=np.int64).reshape(ticks, 3), axis=0).astype(np.int32)
