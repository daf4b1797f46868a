"""WoodenHaptics in MuJoCo, at the far end of a pipe: 16 kHz of physics under a loop of 4 kHz, with a period of delay.

The first line of the input has the arm's numbers (JSON). Then each period comes as eleven doubles: the torques that the
motors are asked for, N·m, where the hand aims, m, how fast that moves, m/s, its stiffness, N/m, and damping, N·s/m. The
answer is nine: joint angles, rad, the probe's position, m, and velocity, m/s. Kinematics, weight and motion are
MuJoCo's. `host-tests/suites/tests/servo/mujoco.rs` is the near end.
"""

import json
import struct
import sys

import mujoco
import numpy as np

STEPS = 4
PERIOD = 1 / 4_000
# Dry friction that holds: MuJoCo's default lets a joint creep below it.
FRICTION = 'solreffriction="0.001 1" solimpfriction="0.9995 0.9995 0.001 0.5 2"'


def arm(numbers):
    """The MJCF: the parallelogram as a serial arm, its second motor as a tendon over both joints."""
    (length, mass, centre, inertia), (reach, fore, middle, turn) = numbers["first"], numbers["second"]

    def lossy(joint):
        low, high = numbers["stops"][joint]
        return (
            f'limited="true" range="{low} {high}" armature="{numbers["rotors"][joint]}" '
            f'damping="{numbers["viscous"][joint]}" frictionloss="{numbers["coulomb"][joint]}"'
        )

    # A counterweight without inertia is none of MuJoCo's bodies.
    assert np.allclose(numbers["balance"], 0), numbers["balance"]
    motors = [f'gainprm="1" dyntype="filterexact" dynprm="{lag}"' for lag in numbers["time_constant"]]
    light = '<inertial pos="0 0 0" mass="1e-9" diaginertia="1e-12 1e-12 1e-12"/>'
    return f"""<mujoco>
  <compiler angle="radian"/>
  <option timestep="{PERIOD / STEPS}" gravity="0 0 {-numbers["gravity"]}" integrator="implicitfast"/>
  <worldbody><body>
    <joint name="a" axis="0 0 1" {lossy(0)} {FRICTION}/>{light}
    <body pos="0 0 {numbers["base_height"]}">
      <joint name="b" axis="0 1 0" {lossy(1)} {FRICTION}/>
      <inertial pos="0 0 {centre}" mass="{mass}" diaginertia="{inertia} {inertia} 1e-9"/>
      <body pos="0 0 {length}">
        <joint name="elbow" axis="0 1 0"/>
        <inertial pos="{middle} 0 0" mass="{fore}" diaginertia="1e-9 {turn} {turn}"/>
        <body name="tip" pos="{reach} 0 0">{light}<site name="tip"/></body>
      </body>
    </body>
  </body></worldbody>
  <tendon><fixed name="c" {lossy(2)} {FRICTION}>
    <joint joint="b" coef="1"/><joint joint="elbow" coef="1"/>
  </fixed></tendon>
  <actuator>
    <general joint="a" {motors[0]}/><general joint="b" {motors[1]}/><general tendon="c" {motors[2]}/>
  </actuator>
  <sensor><framepos objtype="site" objname="tip"/><framelinvel objtype="site" objname="tip"/></sensor>
</mujoco>"""


def main():
    numbers = json.loads(sys.stdin.buffer.readline())
    model = mujoco.MjModel.from_xml_string(arm(numbers))
    data = mujoco.MjData(model)
    tip, centre = model.body("tip").id, np.array(numbers["centre"])
    a, b, c = numbers["angles"]
    data.qpos[:] = a, b, c - b
    underway = np.zeros(3)

    def answer():
        mujoco.mj_forward(model, data)
        (a, b, elbow), place = data.qpos, data.sensordata
        sys.stdout.buffer.write(struct.pack("9d", a, b, b + elbow, *(place[:3] - centre), *place[3:]))
        sys.stdout.buffer.flush()

    answer()
    while len(asked := sys.stdin.buffer.read(88)) == 88:
        asked = np.frombuffer(asked)
        data.ctrl[:], underway = underway, asked[:3]
        aim, velocity, (stiffness, damping) = asked[3:6] + centre, asked[6:9], asked[9:]
        for step in range(STEPS):
            place, moving = data.sensordata[:3], data.sensordata[3:]
            ahead = aim + velocity * (step * PERIOD / STEPS)
            data.xfrc_applied[tip, :3] = stiffness * (ahead - place) + damping * (velocity - moving)
            mujoco.mj_step(model, data)
        answer()


if __name__ == "__main__":
    main()
