"""The loop a tick at a time, for a plant of your own; and the project's own plant, to compare with."""

from __future__ import annotations

import json
from os import PathLike
from typing import Any, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from .bodies import Body
from .rows import row, rows


class Device:
    """What the loop and its simulation know of a device: one of `devices`, or one's own file (``.toml``).

    Positions are in the device's frame, from the middle of its workspace, m; angles of the joints, rad.
    """

    __slots__ = ("_name", "_native")

    def __init__(self, device: str | PathLike[str]):
        """Raises SettingsError for no such device, FileNotFoundError and its like for a file that cannot be read."""
        self._native = _native.Device(device)
        self._name = device

    @property
    def name(self) -> str | PathLike[str]:
        """What it was asked for by."""
        return self._name

    def pose(self, angles: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The loop's own kinematics: positions, (n, 3), and Jacobians, (n, 3, 3), m/rad, a column a joint.

        Not a number where the mechanism does not close.
        """
        places, jacobians = self._native.pose(rows("angles", angles, 3))
        return places, jacobians.reshape(-1, 3, 3)

    def angles(self, positions: ArrayLike) -> NDArray[np.float64]:
        """Joint angles of the project's own plant, (n, 3); not a number out of reach."""
        return self._native.angles(rows("positions", positions, 3))

    def counts(self, angles: ArrayLike) -> list[int]:
        """What sound encoders read at joint angles, (3,)."""
        return self._native.counts(row("angles", angles, 3))

    def torques(self, duties: Sequence[int], rates: ArrayLike = (0.0, 0.0, 0.0)) -> list[float]:
        """The torques at the joints, N·m, that the motors aim at under these duties, at joint rates, (3,), rad/s: a motor
        on a bridge loses its back-EMF.
        """
        return self._native.torques(duties, row("rates", rates, 3))

    def numbers(self) -> dict[str, Any]:
        """Lengths, masses, friction and stops of the simulated device, in SI units.

        Of each joint: `rotors`, inertia that turns with it alone; `viscous` and `coulomb` friction; `time_constant` with
        which a motor's torque follows `torques`, L/R of one on a bridge; `stops`. `balance` of an arm: static moments,
        kg·m, that counterweights add to its links.
        """
        numbers: dict[str, Any] = json.loads(self._native.numbers())
        return numbers


class Loop:
    """The firmware's servo loop, one tick a call: encoder counts in, motor duties out."""

    __slots__ = ("_native",)

    def __init__(
        self,
        device: str | PathLike[str] | Sequence[float],
        body: Body,
        *,
        rate: float = 4000.0,
        stiffness: float | None = None,
        damping: float | None = None,
        max_force: float | None = None,
        velocity_corner: float | None = None,
        soft_start: float = 0.1,
        smooth: bool = True,
        protected: bool = False,
        beyond: bool = False,
        at: ArrayLike = (0.0, 0.0, 0.0),
    ):
        """`at` is where the model's origin lies in the device's frame, m; the others are as in `simulate`. `device` may be
        that of a recording, which has its own protection or none.

        `smooth` is the recommended rendering; without it the force is spring and damper alone. `beyond` lifts the
        device's limits of stiffness and damping, to find where a simulated one becomes unstable. Raises SettingsError
        for what the device or the loop refuses.
        """
        self._native = _native.Loop(
            device,
            body._native,
            rate=rate,
            stiffness=stiffness,
            damping=damping,
            max_force=max_force,
            velocity_corner=velocity_corner,
            soft_start=soft_start,
            smooth=smooth,
            protected=protected,
            beyond=beyond,
            at=row("at", at, 3),
        )

    def tick(self, counts: Sequence[int], enable: bool = True) -> list[int]:
        """One tick. The duties of the three motors, full scale 32767; zeros while they are off."""
        return self._native.tick(counts, enable)

    @property
    def probe(self) -> NDArray[np.float64]:
        """Where the loop took the probe to be, m, in the device's frame."""
        return np.array(self._native.probe)

    @property
    def force(self) -> NDArray[np.float64]:
        """The force of the contact, N."""
        return np.array(self._native.force)

    @property
    def gap(self) -> float:
        """Signed gap, m."""
        return self._native.gap

    @property
    def contact(self) -> int:
        """As in `Ticks`."""
        return self._native.contact

    @property
    def phase(self) -> int:
        """As in `Run`."""
        return self._native.phase

    @property
    def fault(self) -> int:
        """What stopped the loop, 0 for nothing."""
        return self._native.fault


class Plant:
    """The project's own simulated device, at rest at `position`, (3,), m, with nobody at its probe."""

    __slots__ = ("_native",)

    def __init__(self, device: Device, position: ArrayLike = (0.0, 0.0, 0.0), *, rate: float = 4000.0):
        """Raises SettingsError for a place out of reach."""
        self._native = _native.Plant(device._native, row("position", position, 3), rate)

    def advance(
        self,
        duties: Sequence[int],
        aim: ArrayLike = (0.0, 0.0, 0.0),
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        stiffness: float = 0.0,
        damping: float = 0.0,
    ) -> None:
        """A servo period in a hand that aims at a point, m, which moves, m/s, with this spring, N/m, and damper, N·s/m."""
        self._native.advance(duties, row("aim", aim, 3), row("velocity", velocity, 3), stiffness, damping)

    @property
    def counts(self) -> list[int]:
        """What the encoders read."""
        return self._native.counts

    @property
    def angles(self) -> NDArray[np.float64]:
        """Joint angles, rad."""
        return np.array(self._native.angles)

    @property
    def position(self) -> NDArray[np.float64]:
        """The probe, m."""
        return np.array(self._native.position)

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Its velocity, m/s."""
        return np.array(self._native.velocity)
