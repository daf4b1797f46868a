#!/usr/bin/env python3
"""Writes parts of about 10, 100 and 1,000 faces: `target/occt/bin/python host-tests/cad/occt/large.py FOLDER`.

Keycaps: loft, dished by a cylinder, each a solid. Plate: with ribs, pockets and holes. Grid: a plate of round holes.
The virtual environment is run_parts.py's.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import cadquery as cq

COUNTS = {"keycaps": (2, 17, 166), "plate": (1, 9, 90), "grid": (4, 90)}


def places(count: int, pitch: float) -> tuple[list[float], list[tuple[float, float]]]:
    """Sides of a rectangle, and points in it."""
    across = math.ceil(math.sqrt(count))
    up = math.ceil(count / across)
    points = [(pitch * (k % across - (across - 1) / 2), pitch * (k // across - (up - 1) / 2)) for k in range(count)]
    return [across * pitch, up * pitch], points


def keycaps(count: int) -> cq.Workplane:
    dish = cq.Workplane("XZ").center(0, 38).circle(30).extrude(20, both=True)
    key = cq.Workplane().rect(17, 17).workplane(offset=9).rect(13, 14).loft(combine=True).cut(dish)
    keys = [key.translate((x, y, 0)).val() for x, y in places(count, 19)[1]]
    return cq.Workplane(cq.Compound.makeCompound(keys))


def plate(count: int) -> cq.Workplane:
    sides, points = places(count, 30)
    part = cq.Workplane().box(*(side + 6 for side in sides), 8)
    part = part.faces(">Z").workplane().pushPoints([(x, y - 9) for x, y in points]).rect(22, 3).extrude(6)
    pockets = [(x - 6, y + 5) for x, y in points]
    part = part.faces("<Z").workplane(invert=True, offset=8).pushPoints(pockets).rect(10, 8).cutBlind(-4)
    holes = [(x + 7, y + 5) for x, y in points]
    return part.cut(cq.Workplane().workplane(offset=-10).pushPoints(holes).circle(3).extrude(30))


def grid(count: int) -> cq.Workplane:
    sides, points = places(count, 10)
    part = cq.Workplane().box(*(side + 10 for side in sides), 6).edges("|Z").fillet(3)
    return part.faces(">Z").workplane().pushPoints(points).hole(4)


def main() -> None:
    folder = Path(sys.argv[1])
    for make in (keycaps, plate, grid):
        for count in COUNTS[make.__name__]:
            part = make(count)
            cq.exporters.export(part, str(folder / f"{make.__name__}_{part.faces().size()}.step"))


if __name__ == "__main__":
    main()
