"""A knob: a dial on a motor whose feel is set at run time, simulated or at a serial port."""

from __future__ import annotations

from math import tau
from types import TracebackType

from . import _native
from .results import Dials, Turned


class Knob:
    """A knob, `Knob.simulated()` or `Knob.open(port)`. It is also a context manager.

    Its feel is a sum of parts, each set by a method. The first one changes a copy of the active feel, so start with
    `free` and `damping`: 0.0007 s times the stiffness of all parts, or the dial would ring once it is let go of. No change
    steps the torque: the old one ramps down. Parts beyond the device's limits, or too stiff for the damping, raise
    SettingsError, which names the part, the sum that it asks for, the limit and the remedy, and change nothing. Any other
    failure raises LinkError.

    The boards' knob goes on without its host. A device that watches its link stops if it hears nothing: call a method at
    least every third of its timeout.

    >>> knob = Knob.simulated()
    >>> knob.free()
    >>> knob.damping(5e-4)
    >>> knob.detents(pitch=tau / 24, torque=0.02)
    >>> knob.read(0.1).torque.shape[0] >= 9
    True
    >>> knob.spring(stiffness=0.1, max_torque=0.04)
    Traceback (most recent call last):
    ...
    palpate.SettingsError: spring was refused by the device: with it the feel has up to 60.00 mN·m, and the device's limit is 56.00 mN·m (max_force_n): weaken it or another part, or take one away
    """

    __slots__ = ("_native",)

    def __init__(self, native: _native.Knob):
        """Use `simulated` or `open`."""
        self._native = native

    @classmethod
    def simulated(cls) -> Knob:
        """The boards' loop at a simulated gimbal motor, aligned and under force. Its time passes in calls alone."""
        return cls(_native.Knob.simulated())

    @classmethod
    def open(cls, port: str, *, baud: int = 500_000) -> Knob:
        """The knob at a serial port, such as ``/dev/ttyACM0``; `baud`, Bd. Its own button gives force."""
        if not 0 < baud < 2**32:
            raise _native.LinkError(f"{port}: {baud} Bd is no speed of a port")
        return cls(_native.Knob.open(port, baud))

    def free(self) -> None:
        """Takes all parts away."""
        self._native.feel("free", None)

    def detents(self, pitch: float, torque: float, centre: float = 0.0) -> None:
        """Smooth detents: the torque is ``-torque * sin(2 pi (angle - centre) / pitch)``; rad and N·m."""
        self._native.feel("detents", (pitch, torque, centre))

    def clicks(
        self, pitch: float, torque: float, first: int, last: int, snap: float = 0.55, damping: float | None = None
    ) -> None:
        """Detents that snap, `pitch` apart, rad, numbered from `first` to `last`: each pulls back with up to `torque`,
        N·m, until the dial is `snap` pitches off, 1/2 to 1; `damping`, N·m·s/rad, by default as much as they need."""
        own = () if damping is None else (damping,)
        self._native.feel("clicks", (pitch, torque, first, last, snap, *own))

    def texture(self, pitch: float, torque: float, centre: float = 0.0) -> None:
        """A fine wave beside the detents: as `detents`."""
        self._native.feel("texture", (pitch, torque, centre))

    def spring(self, stiffness: float, max_torque: float, rest: float = 0.0) -> None:
        """A spring to `rest`, rad; `stiffness`, N·m/rad, up to `max_torque`, N·m."""
        self._native.feel("spring", (stiffness, max_torque, rest))

    def ends(self, low: float, high: float, stiffness: float, damping: float | None = None) -> None:
        """End stops at `low` and `high`, rad; `stiffness`, N·m/rad, and `damping`, N·m·s/rad, beyond them, by default
        0.001 or as much as they need."""
        own = () if damping is None else (damping,)
        self._native.feel("ends", (low, high, stiffness, *own))

    def damping(self, damping: float) -> None:
        """Damping everywhere, N·m·s/rad; 0 for none."""
        self._native.feel("damping", (damping,))

    def friction(self, torque: float, whole_at: float = 2.0) -> None:
        """Dry friction of `torque`, N·m, whole from `whole_at` on, rad/s."""
        self._native.feel("friction", (torque, whole_at))

    def notch(self, at: float, width: float, torque: float) -> None:
        """A click at one angle: `at` and `width`, rad, `torque`, N·m."""
        self._native.feel("notch", (at, width, torque))

    def off(self, part: str) -> None:
        """Takes one part away, by the name of its method."""
        self._native.feel(part, None)

    def choose(self, index: int) -> None:
        """Makes a feel of the knob's table the active one; the index after its last is the one that was set here."""
        if not 0 <= index <= 255:
            raise _native.SettingsError(f"there is no feel {index}: choose 0 to 255")
        self._native.choose(index)

    def keep(self) -> None:
        """Stores the feel that was set, for every reset from the next on, and waits for the outcome: the button
        released, a person then holds it for half a second and releases it, within 30 s. The simulated hand does, once
        `press(False)` has released it.

        Raises SettingsError if the device refuses: a motor that is on, nobody who confirmed, no flash.
        """
        self._native.keep(True)

    def forget(self) -> None:
        """Clears the stored feel, confirmed as in `keep`."""
        self._native.keep(False)

    def read(self, seconds: float) -> Dials:
        """The dial's reports of the next `seconds`, s, 100 a second; at least one. Raises LinkError once a fault has
        stopped the device."""
        return Dials(**self._native.read(seconds))

    def press(self, pressed: bool = True) -> None:
        """Simulated: presses or releases the enable button, from the next call on."""
        self._native.press(pressed)

    def hold(self, angle: float, *, seconds: float = 0.2, stiffness: float = 50.0, damping: float = 0.05) -> None:
        """Simulated: a hand takes the shaft to `angle`, rad, as `read` counts it, in `seconds`, s, which pass in this call
        (`trace` has its ticks, `read` the reports after it), and holds it: to 0.4 degrees, the encoder's error. By default
        it is a clamp; fingers have a `stiffness` of 0.12 N·m/rad and a `damping` of 0.002 N·m·s/rad."""
        self._native.hold(angle, seconds, stiffness, damping)

    def reset(self) -> None:
        """Simulated: no hand; the board is reset, aligns its rotor again and gives force: with the kept feel, if there
        is one."""
        self._native.reset()

    def release(self) -> None:
        """Simulated: no hand."""
        self._native.release()

    def trace(self) -> Turned:
        """Simulated: every tick since the last call; recording starts with the first. The simulated knob has no cogging
        map: the shaft has the motor's cogging beside the feel, up to 6 mN·m."""
        return Turned(**self._native.trace())

    def close(self) -> None:
        """Closes the port."""
        self._native.close()

    def __enter__(self) -> Knob:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
