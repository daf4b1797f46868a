"""Feel a CAD surface from Python: the firmware's own code over numpy arrays.

Lengths are metres, angles radians, forces newtons, times seconds. Points are in the frame of the model that a body was
baked from; the library computes in single precision in the frame of the body's tables, and every bit of an answer is
the one that a microcontroller would give. No function loops over points in Python, and while one computes, other
threads run.

>>> import numpy as np, palpate
>>> body = palpate.Body.bake("capped_box")
>>> found = body.closest(np.array([[0.03, 0.02, 0.05]]))
>>> found.gap.shape, found.point.shape
((1,), (1, 3))
"""

from importlib.metadata import version as _version

from ._native import ArrayError, FileError, LinkError, ModelError, SettingsError
from .bodies import Body, Pair, ToolTracker, Tracker
from .knob import Knob
from .loops import Link, devices, simulate
from .outside import Outside
from .recordings import Recording
from .results import Apart, Closest, Curved, Dials, Records, Run, Settled, Ticks, ToolPairs, Turned
from .rig import Device, Loop, Plant
from .surfaces import patch_of

__version__ = _version("palpate")

__all__ = [
    "Apart",
    "ArrayError",
    "Body",
    "Closest",
    "Curved",
    "Device",
    "Dials",
    "FileError",
    "Knob",
    "Link",
    "LinkError",
    "Loop",
    "ModelError",
    "Outside",
    "Pair",
    "Plant",
    "Recording",
    "Records",
    "Run",
    "Settled",
    "SettingsError",
    "Ticks",
    "ToolPairs",
    "ToolTracker",
    "Tracker",
    "Turned",
    "devices",
    "patch_of",
    "simulate",
]
