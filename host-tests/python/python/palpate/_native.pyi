"""The compiled half: arrays of exact kinds, without the comforts of the package."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "ArrayError",
    "Body",
    "Device",
    "FileError",
    "Knob",
    "Link",
    "LinkError",
    "Loop",
    "ModelError",
    "Pair",
    "Plant",
    "SettingsError",
    "ToolTracker",
    "Tracker",
    "devices",
    "simulate",
]

class ArrayError(ValueError): ...
class FileError(ValueError): ...
class LinkError(OSError): ...
class ModelError(ValueError): ...
class SettingsError(ValueError): ...

@final
class Body:
    @staticmethod
    def bake(
        model: str | PathLike[str] | Sequence[Mapping[str, Any]],
        tolerance: float,
        unit: str,
        modes: str | PathLike[str] | None,
        margin: float,
        progress: Callable[[int, int], None] | None,
    ) -> Body: ...
    @staticmethod
    def load(path: str | PathLike[str]) -> Body: ...
    def save(self, path: str | PathLike[str]) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def patches(self) -> list[str]: ...
    @property
    def flaws(self) -> list[tuple[str, bool]]: ...
    @property
    def faces(self) -> int: ...
    @property
    def edges(self) -> int: ...
    @property
    def vertices(self) -> int: ...
    @property
    def size(self) -> float: ...
    @property
    def centre(self) -> tuple[float, float, float]: ...
    @property
    def modes(self) -> int: ...
    @property
    def budget(self) -> float: ...
    @property
    def is_closed(self) -> bool: ...
    @property
    def is_convex(self) -> bool: ...
    def closest(
        self, points: NDArray[np.float64], q: NDArray[np.float64], signed: bool, bounded: bool
    ) -> tuple[
        NDArray[np.uint32],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.uint32],
        NDArray[np.float32],
        NDArray[np.uint32],
        NDArray[np.bool_],
        NDArray[np.bool_],
        NDArray[np.bool_],
        NDArray[np.float64],
    ]: ...
    def evaluate(self, face: int, parameters: NDArray[np.float64]) -> list[NDArray[np.float64]]: ...
    def settle(
        self,
        face: int,
        probe: tuple[float, ...],
        starts: NDArray[np.float64],
        law_name: str,
        most: int,
        tolerance: float,
    ) -> tuple[
        NDArray[np.float32], NDArray[np.uint32], NDArray[np.bool_], NDArray[np.float64], NDArray[np.float64]
    ]: ...
    def tracker(self, law: str, start: tuple[int, float, float] | None) -> Tracker: ...
    def pair(self, other: Body, face: int, other_face: int) -> Pair: ...
    def tool(self, half: tuple[float, float, float], core: Body | None, radius: float) -> ToolTracker: ...

@final
class Tracker:
    def step(
        self, points: NDArray[np.float64]
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float32],
        NDArray[np.float32],
        NDArray[np.float32],
        NDArray[np.uint16],
        NDArray[np.uint8],
        NDArray[np.bool_],
        NDArray[np.uint8],
    ]: ...

@final
class Pair:
    def step(
        self, origins: NDArray[np.float64], axes_of: NDArray[np.float64], steps: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float32]]: ...

_Pairs = tuple[NDArray[np.float32], NDArray[np.float64], NDArray[np.float64], NDArray[np.uint32], list[str]]

@final
class ToolTracker:
    def locate(self, origins: NDArray[np.float64], quaternions: NDArray[np.float64]) -> _Pairs: ...
    def step(self, origins: NDArray[np.float64], quaternions: NDArray[np.float64]) -> _Pairs: ...

@final
class Link:
    def __new__(cls, port: str, baud: int) -> Link: ...
    def read(self, count: int, timeout: float) -> dict[str, Any]: ...
    def close(self) -> None: ...

@final
class Knob:
    @staticmethod
    def simulated() -> Knob: ...
    @staticmethod
    def open(port: str, baud: int) -> Knob: ...
    def feel(self, part: str, numbers: Sequence[float] | None) -> None: ...
    def choose(self, index: int) -> None: ...
    def keep(self, keeps: bool) -> None: ...
    def read(self, seconds: float) -> dict[str, Any]: ...
    def press(self, pressed: bool) -> None: ...
    def hold(self, to: float, seconds: float, stiffness: float, damping: float) -> None: ...
    def reset(self) -> None: ...
    def release(self) -> None: ...
    def trace(self) -> dict[str, Any]: ...
    def close(self) -> None: ...

@final
class Device:
    def __new__(cls, device: str | PathLike[str]) -> Device: ...
    def pose(self, angles: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def angles(self, places: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def counts(self, angles: tuple[float, ...]) -> list[int]: ...
    def torques(self, duties: Sequence[int], rates: tuple[float, ...]) -> list[float]: ...
    def numbers(self) -> str: ...

@final
class Loop:
    def __new__(
        cls,
        device: str | PathLike[str] | Sequence[float],
        body: Body,
        *,
        rate: float,
        stiffness: float | None,
        damping: float | None,
        max_force: float | None,
        velocity_corner: float | None,
        soft_start: float,
        smooth: bool,
        protected: bool,
        beyond: bool,
        at: tuple[float, ...],
    ) -> Loop: ...
    def tick(self, counts: Sequence[int], enable: bool) -> list[int]: ...
    @property
    def probe(self) -> list[float]: ...
    @property
    def force(self) -> list[float]: ...
    @property
    def gap(self) -> float: ...
    @property
    def contact(self) -> int: ...
    @property
    def phase(self) -> int: ...
    @property
    def fault(self) -> int: ...

@final
class Plant:
    def __new__(cls, device: Device, position: tuple[float, ...], rate: float) -> Plant: ...
    def advance(
        self,
        duties: Sequence[int],
        aim: tuple[float, ...],
        velocity: tuple[float, ...],
        stiffness: float,
        damping: float,
    ) -> None: ...
    @property
    def counts(self) -> list[int]: ...
    @property
    def angles(self) -> list[float]: ...
    @property
    def position(self) -> list[float]: ...
    @property
    def velocity(self) -> list[float]: ...

def simulate(
    device: str | PathLike[str],
    body: Body,
    *,
    rate: float,
    seconds: float,
    seed: int,
    stiffness: float | None,
    damping: float | None,
    max_force: float | None,
    velocity_corner: float | None,
    soft_start: float,
    smooth: bool,
    protected: bool,
    at: tuple[float, ...] | None,
) -> dict[str, Any]: ...
def devices() -> list[str]: ...
