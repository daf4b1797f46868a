"""MuJoCo under the loop: a model (MJCF) of your own device. MuJoCo is imported once a model is made."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .rig import Device


class Outside:
    """A model of MuJoCo in the place of palpate's own plant: the methods of `Plant`.

    `motors` are the joints that the encoders read, as three rows of numbers that multiply qpos; `centre` is where the
    device's frame lies in the model, m. The model has a body and a site ``tip``, whose place and velocity are its first
    sensors, and an actuator for each motor that takes the torque of `Device.torques`, N·m, back-EMF of a bridge included,
    and follows it with the ``time_constant`` of `Device.numbers`.
    """

    def __init__(
        self,
        device: Device,
        model: str,
        motors: ArrayLike,
        centre: ArrayLike = (0.0, 0.0, 0.0),
        *,
        rate: float = 4000.0,
        steps: int = 4,
    ):
        """`model` is MJCF, as text; its time step is that of a servo period over `steps`."""
        # Here, for those who have no MuJoCo; and it says nothing of its types.
        mujoco: Any = import_module("mujoco")
        self.device, self.steps, self.period, self._mujoco = device, steps, 1 / rate, mujoco
        self.model: Any = mujoco.MjModel.from_xml_string(model)
        self.model.opt.timestep = self.period / steps
        self.data: Any = mujoco.MjData(self.model)
        self.motors, self.centre = np.array(motors, dtype=float), np.array(centre, dtype=float)
        self.tip = self.model.body("tip").id
        self.underway: Sequence[int] = [0, 0, 0]

    def close(self, angles: ArrayLike, guess: NDArray[np.float64] | None = None) -> None:
        """Puts the motors at these angles and closes the loops by Newton's method on MuJoCo's own constraints."""
        data, held, angles = self.data, self.motors, np.asarray(angles, dtype=float)
        data.qpos[:] = np.linalg.pinv(held) @ angles if guess is None else guess
        for _ in range(30):
            self._mujoco.mj_forward(self.model, data)
            rows = data.ne
            jacobian = data.efc_J.reshape(-1, self.model.nv)[:rows] if rows else np.zeros((0, self.model.nv))
            wanted = np.concatenate([data.efc_pos[:rows], held @ data.qpos - angles])
            step = np.linalg.lstsq(np.concatenate([jacobian, held]), wanted, rcond=None)[0]
            data.qpos[:] -= step
            if np.abs(step).max() < 1e-13:
                break
        data.qvel[:], data.act[:], self.underway = 0, 0, [0, 0, 0]
        self._mujoco.mj_forward(self.model, data)

    def spread(self) -> NDArray[np.float64]:
        """How all coordinates move with the motors, from MuJoCo's constraints."""
        rows = self.data.ne
        jacobian = self.data.efc_J.reshape(-1, self.model.nv)[:rows] if rows else np.zeros((0, self.model.nv))
        right = np.concatenate([np.zeros((rows, 3)), np.eye(3)])
        spread: NDArray[np.float64] = np.linalg.lstsq(np.concatenate([jacobian, self.motors]), right, rcond=None)[0]
        return spread

    def jacobian(self) -> NDArray[np.float64]:
        """The tip's velocity by the motors'."""
        motion = np.zeros((3, self.model.nv))
        self._mujoco.mj_jacSite(self.model, self.data, motion, None, self.model.site("tip").id)
        return motion @ self.spread()

    def weight(self) -> NDArray[np.float64]:
        """The torques that hold it up, N·m."""
        torques: NDArray[np.float64] = self.spread().T @ self.data.qfrc_bias
        return torques

    @property
    def angles(self) -> Any:
        """Joint angles, rad."""
        return self.motors @ self.data.qpos

    @property
    def counts(self) -> list[int]:
        """What the encoders read."""
        return self.device.counts(self.angles)

    @property
    def position(self) -> Any:
        """The probe, m."""
        return self.data.sensordata[:3] - self.centre

    @property
    def velocity(self) -> Any:
        """Its velocity, m/s."""
        return self.data.sensordata[3:6].copy()

    def advance(
        self,
        duties: Sequence[int],
        aim: ArrayLike = (0.0, 0.0, 0.0),
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        stiffness: float = 0.0,
        damping: float = 0.0,
    ) -> None:
        """A servo period in a hand, as `Plant.advance`. Duties act a period late, as those of a real loop."""
        data, wanted = self.data, np.asarray(aim, dtype=float) + self.centre
        speed = np.asarray(velocity, dtype=float)
        acting, self.underway = self.underway, list(duties)
        for step in range(self.steps):
            data.ctrl[:] = self.device.torques(acting, self.motors @ data.qvel)
            place, moving = data.sensordata[:3], data.sensordata[3:6]
            ahead = wanted + speed * (step * self.period / self.steps)
            data.xfrc_applied[self.tip, :3] = stiffness * (ahead - place) + damping * (speed - moving)
            self._mujoco.mj_step(self.model, data)
        self._mujoco.mj_forward(self.model, data)
