"""Models of MuJoCo with the numbers of palpate's simulated devices, for the loop of the wheel."""

import numpy as np
from palpate import Outside

from arm import FRICTION, arm

# Constraints of loops: as stiff as a step bears.
CLOSED = 'solref="0.00013 1" solimp="0.9999 0.9999 0.001 0.5 2"'


def delta(numbers, period, steps):
    """The MJCF of a delta: each leg a thigh, a stub, a shin that swings sideways and a stub, tied to the plate."""
    (a, b, c, d, e, f, r, s), depth = numbers["lengths"], numbers["depth"]
    mass, middle = numbers["thigh"]
    light = '<inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
    legs, sites, ties, motors = "", "", "", ""
    for leg, turn in enumerate(numbers["legs"]):
        low, high = numbers["stops"][leg]
        place = f"{r * np.cos(turn) - s * np.sin(turn)} {r * np.sin(turn) + s * np.cos(turn)} 0"
        # The rotor's inertia has the thigh's about the hip, of which its mass brings a part.
        armature = numbers["rotors"][leg] - mass * middle**2
        legs += f"""
    <body pos="{place}" euler="0 0 {turn}">
      <joint name="hip{leg}" axis="0 -1 0" limited="true" range="{low} {high}" armature="{armature}"
        damping="{numbers["viscous"][leg]}" frictionloss="{numbers["coulomb"][leg]}" {FRICTION}/>
      <inertial pos="{middle} 0 0" mass="{mass}" diaginertia="1e-9 1e-9 1e-9"/>
      <body pos="{a} 0 0"><joint name="knee{leg}" axis="0 -1 0"/>{light}
        <body pos="{d} 0 0"><joint name="tilt{leg}" axis="0 0 1"/>
          <inertial pos="{b / 2} 0 0" mass="{numbers["shin"]}" diaginertia="1e-9 1e-9 1e-9"/>
          <body pos="{b} 0 0"><joint name="back{leg}" axis="0 0 1"/>{light}<site name="end{leg}" pos="{e} 0 0"/></body>
        </body></body></body>"""
        at = f"{c * np.cos(turn) - f * np.sin(turn)} {c * np.sin(turn) + f * np.cos(turn)} 0"
        ties += f"""
    <connect site1="end{leg}" site2="plate{leg}" {CLOSED}/>
    <joint joint1="back{leg}" joint2="tilt{leg}" polycoef="0 -1 0 0 0" {CLOSED}/>"""
        motors += f'<general joint="hip{leg}" gainprm="1" dyntype="filterexact" dynprm="{numbers["time_constant"][leg]}"/>'
        sites += f'<site name="plate{leg}" pos="{at}"/>'
    axes = zip("xyz", ("1 0 0", "0 1 0", "0 0 1"))
    slides = "".join(f'<joint name="{name}" type="slide" axis="{axis}"/>' for name, axis in axes)
    return f"""<mujoco>
  <compiler angle="radian"/>
  <option timestep="{period / steps}" gravity="0 {-numbers["gravity"]} 0" integrator="implicitfast" jacobian="dense"/>
  <worldbody>{legs}
    <body name="tip" pos="0 0 {depth}">{slides}
      <inertial pos="0 0 0" mass="{numbers["plate"]}" diaginertia="1e-4 1e-4 1e-4"/>{sites}<site name="tip"/></body>
  </worldbody>
  <equality>{ties}</equality>
  <actuator>{motors}</actuator>
  <sensor><framepos objtype="site" objname="tip"/><framelinvel objtype="site" objname="tip"/></sensor>
</mujoco>"""


def wooden_haptics(device, place, steps=4):
    """WoodenHaptics at a place: a serial arm, its second motor a tendon over both joints."""
    numbers = device.numbers()
    outside = Outside(device, arm(numbers), [[1, 0, 0], [0, 1, 0], [0, 1, 1]], numbers["centre"], steps=steps)
    outside.close(device.angles(place)[0])
    return outside


def falcon(device, place, steps=8):
    """The Falcon at a place: its coordinates are those of three legs, four each, and the plate's three."""
    numbers = device.numbers()
    xml = delta(numbers, 1 / 4000, steps)
    motors = np.zeros((3, 15))
    motors[range(3), range(0, 12, 4)] = 1
    outside = Outside(device, xml, motors, [0, 0, numbers["depth"]], steps=steps)
    angles, (a, _, c, *_, r, _) = device.angles(place)[0], numbers["lengths"]
    guess = np.zeros(15)
    for leg, angle in enumerate(angles):
        reach = c - r - a * np.cos(angle)
        guess[4 * leg] = angle
        guess[4 * leg + 1] = np.arctan2(numbers["depth"] - a * np.sin(angle), reach) - angle
    guess[12:] = place
    outside.close(angles, guess)
    return outside
