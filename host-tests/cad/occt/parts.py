"""Random parts in CadQuery, by kind and seed, and the dialects in which they are written as STEP.

A kind is a function of a random generator that returns the part, or the part and its volume in closed form, mm³.
Lengths in mm.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from random import Random

import cadquery as cq
from OCP.Interface import Interface_Static

W = cq.Workplane


def turned(corners: list[tuple[float, float]]) -> tuple[W, float]:
    """A polygon of (radius, height), turned about the z axis; its volume is Pappus's."""
    part = W("XZ").polyline(corners).close().revolve(360, (0, 0, 0), (0, 1, 0))
    pairs = zip(corners, corners[1:] + corners[:1])
    moment = sum((a * d - c * b) * (a + c) / 6 for (a, b), (c, d) in pairs)
    return part, 2 * math.pi * abs(moment)


def revolved(random: Random):
    r, h, way = random.uniform(6, 20), random.uniform(6, 30), random.randrange(5)
    if way == 0:
        neck = random.uniform(0.4, 0.9) * r
        return turned([(0, 0), (r, 0), (r, 0.3 * h), (neck, 0.5 * h), (neck, h), (0, h + random.choice([0, 0.2 * h]))])
    if way == 1:
        bore = random.uniform(0.2, 0.7) * r
        return turned([(bore, 0), (r, 0), (r, 0.6 * h), (0.5 * (bore + r), h), (bore, h)])
    profile = W("XZ").lineTo(r, 0).lineTo(r, 0.5 * h)
    rise = random.uniform(0.1, 0.9) * r
    if way == 2:  # a crown: an arc that is level on the axis
        radius = (r * r + rise * rise) / (2 * rise)
        half = math.asin(min(1, r / radius)) / 2
        middle = (radius * math.sin(half), 0.5 * h + rise - radius * (1 - math.cos(half)))
        volume = math.pi * (r * r * 0.5 * h + rise * rise * (3 * radius - rise) / 3)
        profile = profile.threePointArc(middle, (0, 0.5 * h + rise)).close()
        return profile.revolve(360, (0, 0, 0), (0, 1, 0)), volume
    waist = [(0.8 * r, 0.65 * h), (random.uniform(0.5, 0.8) * r, 0.8 * h)]
    if way == 3:  # a knob with a level top
        profile = profile.spline([*waist, (0, h)], tangents=[(0, 1), (-1, 0)], includeCurrent=True)
    else:  # a flat tip
        profile = profile.spline([*waist, (0.3 * r, h)], includeCurrent=True).lineTo(0, h)
    return profile.close().revolve(random.choice([360, 360, 200]), (0, 0, 0), (0, 1, 0))


def lofted(random: Random):
    a, b, h = random.uniform(10, 30), random.uniform(10, 30), random.uniform(8, 30)
    ends = random.randrange(4)
    if ends == 0:
        return W().rect(a, b).workplane(offset=h).circle(random.uniform(3, 12)).loft()
    if ends == 1:
        k = random.uniform(0.3, 0.9)
        return W().rect(a, b).workplane(offset=h).rect(k * a, k * b).loft(ruled=True), a * b * h * (1 + k + k * k) / 3
    if ends == 2:
        return W().ellipse(a / 2, b / 2).workplane(offset=h).ellipse(b / 3, a / 3).loft()
    middle = W().circle(a / 2).workplane(offset=h / 2).circle(random.uniform(0.2, 0.7) * a)
    return middle.workplane(offset=h / 2).circle(b / 3).loft()


def shelled(random: Random):
    a, b, h, t = (random.uniform(*range_) for range_ in [(15, 40), (15, 40), (8, 25), (1, 3)])
    way = random.randrange(4)
    if way == 0:
        return W().box(a, b, h).faces(">Z").shell(-t), a * b * h - (a - 2 * t) * (b - 2 * t) * (h - t)
    if way == 1:
        r = a / 2
        volume = math.pi * (r * r * h - (r - t) ** 2 * (h - t))
        return W().circle(r).extrude(h).faces(">Z").shell(-t), volume
    if way == 2:
        return W().box(a, b, h).edges("|Z").fillet(t + random.uniform(1, 3)).faces(">Z").shell(-t)
    cup = W().box(a, b, h).edges("|Z or <Z").fillet(t + random.uniform(0.5, 2))
    return cup.faces(">Z").shell(-t)


def filleted(random: Random):
    a, b, h, r = (random.uniform(*range_) for range_ in [(15, 40), (15, 40), (10, 25), (0.5, 3.5)])
    way = random.randrange(6)
    if way == 0:
        core = (a - 2 * r) * (b - 2 * r) * (h - 2 * r)
        sides = 2 * r * sum(x * y for x, y in [(a - 2 * r, b - 2 * r), (a - 2 * r, h - 2 * r), (b - 2 * r, h - 2 * r)])
        round_ = math.pi * r * r * (a + b + h - 6 * r) + 4 / 3 * math.pi * r**3
        return W().box(a, b, h).edges().fillet(r), core + sides + round_
    if way == 1:
        return W().circle(a / 2).extrude(h).edges().fillet(r)
    if way == 2:
        return W().box(a, b, h).edges("|Z").fillet(r + 1).faces(">Z").edges().chamfer(0.8)
    if way == 3:
        boss = W().box(a, b, h / 2).faces(">Z").workplane().circle(min(a, b) / 4).extrude(h / 2)
        return boss.edges(cq.selectors.NearestToPointSelector((min(a, b) / 4, 0, h / 4))).fillet(min(r, 2))
    if way == 4:
        tube = W().circle(a / 2).circle(a / 4).extrude(h)
        return tube.edges().fillet(min(r, a / 10))
    step = W("XZ").polyline([(0, 0), (a, 0), (a, 0.4 * h), (0.4 * a, 0.4 * h), (0.4 * a, h), (0, h)]).close()
    return step.extrude(b).edges("|Y").fillet(min(r, 2))


def patterned(random: Random):
    across, along, pitch, t = random.randint(2, 4), random.randint(1, 3), random.uniform(8, 12), random.uniform(3, 8)
    a, b, d = (across + 1) * pitch, (along + 1) * pitch, random.uniform(2, 5)
    plate, count, way = W().box(a, b, t), across * along, random.randrange(4)
    at = plate.faces(">Z").workplane()
    if way == 0:
        return at.rarray(pitch, pitch, across, along).hole(d), a * b * t - count * math.pi * d * d / 4 * t
    if way == 1:
        pockets = at.rarray(pitch, pitch, across, along).rect(d, 1.4 * d)
        return pockets.cutBlind(-t / 2), a * b * t - count * 1.4 * d * d * t / 2
    if way == 2:
        bosses = at.rarray(pitch, pitch, across, along).circle(d / 2)
        return bosses.extrude(t), a * b * t + count * math.pi * d * d / 4 * t
    r, n = pitch * 1.5, random.randint(3, 6)
    flange = W().circle(r + d).extrude(t).faces(">Z").workplane().polarArray(r, 0, 360, n).hole(d)
    return flange, math.pi * t * ((r + d) ** 2 - n * d * d / 4)


def threaded(random: Random):
    r, pitch, turns = random.uniform(5, 12), random.uniform(2, 4), random.uniform(1.2, 3)
    depth, h = 0.35 * pitch, pitch * (turns + 2)
    helix = cq.Wire.makeHelix(pitch, pitch * turns, r)
    tooth = W("XZ").moveTo(r - depth, 0).lineTo(r + 0.2, -0.4 * pitch).lineTo(r + 0.2, 0.4 * pitch).close()
    groove = tooth.sweep(W(helix), isFrenet=True).translate((0, 0, pitch))
    return W().circle(r).extrude(h).cut(groove)


def drilled(random: Random):
    a, b, h, d = (random.uniform(*range_) for range_ in [(20, 40), (20, 40), (10, 20), (3, 7)])
    way, top = random.randrange(6), lambda part: part.faces(">Z").workplane()
    if way == 0:
        return top(W().box(a, b, h)).cboreHole(d, 1.8 * d, h / 3)
    if way == 1:
        return top(W().box(a, b, h)).cskHole(d, 2 * d, 82)
    if way == 2:
        hole = W("YZ").circle(d / 2).extrude(a, both=True)
        return W().circle(a / 2).extrude(2 * d).cut(hole.translate((0, 0, d)))
    if way == 3:
        return W().sphere(a / 2).cut(W().circle(d / 2).extrude(a).translate((a / 8, 0, 0)))
    if way == 4:
        tip = cq.Solid.makeCone(0, d / 2, d / 3, dir=cq.Vector(0, 0, 1)).translate(cq.Vector(a / 6, 0, -d / 3))
        return W().box(a, b, h).cut(W().center(a / 6, 0).circle(d / 2).extrude(h).union(W(tip)))
    cross = W("XZ").circle(d / 2).extrude(b, both=True)
    return top(W().box(a, b, h)).hole(d).cut(cross)


KINDS = [revolved, lofted, shelled, filleted, patterned, threaded, drilled]
# Placements whose `ref_direction` does not change the shape.
ROUND = r"(?:PLANE|CYLINDRICAL_SURFACE|CONICAL_SURFACE|SPHERICAL_SURFACE|TOROIDAL_SURFACE|CIRCLE)"


def plain(text: str) -> str:
    """As Open CASCADE writes it."""
    return text


def bare(text: str) -> str:
    """Without fields that may be left out, as CATIA and Rhino write."""
    uses: dict[str, list[str]] = {}
    for entity, placement in re.findall(r"=\s*(\w+)\('[^']*',(?:#\d+,)*?(#\d+)[,)]", text):
        uses.setdefault(placement, []).append(entity)
    simple = {place for place, entities in uses.items() if all(re.fullmatch(ROUND, entity) for entity in entities)}

    def without(match: re.Match) -> str:
        return f"{match[1]}$);" if match[2] in simple else match[0]

    return re.sub(r"((#\d+) = AXIS2_PLACEMENT3D\('[^']*',#\d+,#\d+,)#\d+\);", without, text)


def coarse(text: str) -> str:
    """With a large uncertainty."""
    return re.sub(r"(UNCERTAINTY_MEASURE_WITH_UNIT\(LENGTH_MEASURE\()[^)]*", r"\g<1>5.E-03", text)


DIALECTS = [plain, bare, coarse]


def step(shape: cq.Shape, path: Path, dialect) -> None:
    """Writes a part; curves in parameters are optional too, and would belong to the directions that `bare` leaves out."""
    Interface_Static.SetIVal_s("write.surfacecurve.mode", int(dialect is not bare))
    shape.exportStep(str(path))
    # Entities run over lines: one line each.
    text = re.sub(r"\n\s+", "", path.read_text().replace("\r", ""))
    text = re.sub(r"(?<=[^;])\n(?=[^#\n])", "", text.split("DATA;", 1)[1])
    path.write_text(path.read_text().split("DATA;", 1)[0] + "DATA;" + dialect(text))
