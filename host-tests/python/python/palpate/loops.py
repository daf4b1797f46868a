"""Servo loops: simulated, and the telemetry of real ones."""

from __future__ import annotations

from os import PathLike
from types import TracebackType

from numpy.typing import ArrayLike

from . import _native
from .bodies import Body
from .results import Records, Run
from .rows import row


def devices() -> list[str]:
    """The devices that ship, by name: those with three joints."""
    return _native.devices()


def simulate(
    device: str | PathLike[str],
    body: Body,
    *,
    rate: float = 4000.0,
    seconds: float = 5.0,
    seed: int = 2,
    stiffness: float | None = None,
    damping: float | None = None,
    max_force: float | None = None,
    velocity_corner: float | None = None,
    soft_start: float = 0.1,
    smooth: bool = True,
    protected: bool = False,
    at: ArrayLike | None = None,
) -> Run:
    """Runs the firmware's servo loop against a simulated device in a simulated hand.

    It is what ``palpate sim`` runs, bit by bit; the only patch of a model is felt by itself, as there.

    `device` is one of `devices`, or the path of one's own device file (``.toml``); `body` is what it feels. `rate`, Hz, `seconds`, and `seed` of the hand's path;
    `stiffness`, N/m, and `damping`, N·s/m, of the surface, `max_force`, N, and `velocity_corner`, Hz, of the velocity
    filter: what is recommended for the device, unless given; `soft_start`, s, over which force is faded in; `smooth` is
    the recommended rendering, without it the force is spring and damper alone; `protected` with all protection of the device; `at`, (3,), m, where the model's origin lies in the device's
    workspace, or None to centre the body there.

    A body with modes gives way: `q` of the run is theirs in each tick; its modes file then needs ``frequency``,
    ``mass`` and ``damping`` of each, ModelError says which is missing.

    Raises SettingsError for what the device or the loop refuses and for a device file that describes no device,
    FileNotFoundError and its like for one that cannot be read.
    """
    place = None if at is None else row("at", at, 3)
    columns = _native.simulate(
        device,
        body._native,
        rate=rate,
        seconds=seconds,
        seed=seed,
        stiffness=stiffness,
        damping=damping,
        max_force=max_force,
        velocity_corner=velocity_corner,
        soft_start=soft_start,
        smooth=smooth,
        protected=protected,
        at=place,
    )
    return Run(**columns)


class Link:
    """A device's telemetry over a serial port: read, never written. It is also a context manager."""

    __slots__ = ("_native",)

    def __init__(self, port: str, *, baud: int = 500_000):
        """Opens a port at `baud`, Bd. Raises LinkError for one that cannot be opened."""
        self._native = _native.Link(port, baud)

    def read(self, count: int, *, timeout: float = 1.0) -> Records:
        """The next records: `count` of them or some more, or those that came within `timeout` seconds.

        Raises LinkError once the port is closed or gone.
        """
        return Records(**self._native.read(count, timeout))

    def close(self) -> None:
        """Closes the port."""
        self._native.close()

    def __enter__(self) -> Link:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
