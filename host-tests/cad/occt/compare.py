"""Imports random parts with palpate and compares them with Open CASCADE: as run_parts.py has it.

The expected values are those of the shape in memory, which no STEP file comes near, and closed forms where a part has
one. Open CASCADE errs too: a part that its checker calls invalid, or whose volume is not that of the closed form, is
not counted. Lengths in mm.
"""

from __future__ import annotations

import csv
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
import tomllib
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

import cadquery as cq
import numpy as np
import parts
from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.gp import gp_Pnt
from OCP.ShapeAnalysis import ShapeAnalysis_ShapeTolerance
from OCP.TopAbs import TopAbs_IN

TOLERANCE = 0.01
# Of the numbers of a query to f32, at the size of these parts.
ROUNDING = 0.0005
PROBES = 300
LEAST_IMPORTED = 0.97
# For each face, over all parts that were imported.
MOST_PATCHES = 4


@dataclass
class Row:
    """Counts of one kind and dialect."""

    parts: int = 0
    imported: int = 0
    refused: int = 0
    late: int = 0
    wrong: int = 0
    cold: float = 0.0
    faces: int = 0
    patches: int = 0
    seconds: float = 0.0
    remarks: list[str] = field(default_factory=list)

    def add(self, other: Row) -> None:
        for name, value in vars(other).items():
            mine = getattr(self, name)
            setattr(self, name, max(mine, value) if name == "cold" else mine + value)

    def cells(self) -> str:
        share = f"{self.patches / self.faces:.1f}" if self.faces else "–"
        counts = f"{self.parts} | {self.imported} | {self.refused} | {self.late} | {self.wrong}"
        return f"{counts} | {self.cold:.4f} | {share} | {self.seconds:.1f} |"


def made(kind, seed: int) -> tuple[cq.Shape, float | None]:
    """A part that Open CASCADE calls valid, and its volume; the first of ten seeds that gives one."""
    for again in range(10):
        try:
            part = kind(Random(seed + 1000 * again))
        except Exception:  # of any kind, by the bindings
            continue
        part, volume = part if isinstance(part, tuple) else (part, None)
        solids = part.solids().vals()
        if len(solids) != 1 or not BRepCheck_Analyzer(solids[0].wrapped).IsValid():
            continue
        if volume is None or abs(volume / solids[0].Volume() - 1) < 1e-5:
            return solids[0], volume
    raise ValueError(f"{kind.__name__} {seed}: no valid part in ten")


def probes(shape: cq.Shape, random: Random) -> list[cq.Vector]:
    """Two thirds within 2 mm of the surface, the others anywhere about the part."""
    points, triangles = shape.tessellate(0.2)
    box = shape.BoundingBox()
    near = []
    for _ in range(2 * PROBES // 3):
        a, b, c = (points[index] for index in random.choice(triangles))
        s, t = sorted((random.random(), random.random()))
        way = (b - a).cross(c - a)
        way = way / way.Length if way.Length > 0 else cq.Vector(0, 0, 1)
        near.append(a * s + b * (t - s) + c * (1 - t) + way * random.uniform(-2, 2))
    sides = [(box.xmin, box.xmax), (box.ymin, box.ymax), (box.zmin, box.zmax)]
    span = 0.3 * max(high - low for low, high in sides)
    return near + [
        cq.Vector(*(random.uniform(low - span, high + span) for low, high in sides))
        for _ in range(PROBES - len(near))
    ]


def truth(shape: cq.Shape, points: list[cq.Vector]) -> list[tuple[float, bool]]:
    """Distance to the surface, and whether the point is inside."""
    shell = cq.Compound.makeCompound(shape.Faces()).wrapped
    classifier = BRepClass3d_SolidClassifier(shape.wrapped)
    answers = []
    for point in points:
        distance = BRepExtrema_DistShapeShape(cq.Vertex.makeVertex(*point.toTuple()).wrapped, shell).Value()
        classifier.Perform(gp_Pnt(*point.toTuple()), 1e-7)
        answers.append((distance, classifier.State() == TopAbs_IN))
    return answers


def winds_round(shape: cq.Shape, point: cq.Vector) -> bool:
    """Whether a point is inside, by the solid angle of a mesh finer than any distance at which sides are compared.

    The classifier's ray can take a thread's flank for its other side.
    """
    points, triangles = shape.tessellate(0.002, 0.05)
    a, b, c = np.moveaxis(np.array([p.toTuple() for p in points])[np.array(triangles)] - point.toTuple(), 1, 0)
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    dot = lambda p, q: np.einsum("ij,ij->i", p, q)
    angles = np.arctan2(dot(a, np.cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    return bool(abs(angles.sum()) > math.pi)


def run(longest: int, *command: str | Path) -> tuple[int, str, float]:
    """Exit status, the output, and processor seconds; killed when they are more than `longest`."""

    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (longest, longest))

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, preexec_fn=limit)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.returncode, done.stdout + done.stderr, seconds


def extent(model: Path) -> tuple[np.ndarray, np.ndarray, int]:
    """The corners of the bounding box of a model's patches, on a grid of 33 × 33 points each, and their number."""
    patches = tomllib.loads(model.read_text())["patch"]
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for patch in patches:
        grid = np.array(patch["points"])
        for _ in range(2):
            degree = len(grid) - 1
            t = np.linspace(0, 1, 33)[:, None]
            basis = np.hstack([math.comb(degree, k) * t**k * (1 - t) ** (degree - k) for k in range(degree + 1)])
            grid = np.einsum("tk,kjc->jtc", basis, grid)
        low, high = np.minimum(low, grid.min((0, 1))), np.maximum(high, grid.max((0, 1)))
    return low, high, len(patches)


def faults(report: str, model: Path, shape: cq.Shape, volume: float | None) -> tuple[list[str], int]:
    """The faults of a body as a whole, and the number of its patches."""
    found = []
    said = {name: float(number) for name, number in re.findall(r"(area|volume): patches (-?[\d.]+)", report)}
    area = shape.Area()
    # A surface that is displaced by the tolerance encloses that much more; the rest is Open CASCADE's quadrature.
    for name, wanted, slack in [
        ("volume", volume or shape.Volume(), TOLERANCE * area + 1e-5 * shape.Volume()),
        # Its area grows by the tolerance over the radius: 2 % of a round of 0.5 mm, which no part is made of.
        ("area", area, 0.01 * area),
    ]:
        if abs(said.get(name, 0) - wanted) > slack:
            found.append(f"{name} {said.get(name, 0):.3f}, not {wanted:.3f}")
    low, high, patches = extent(model)
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape.wrapped, box, False, False)
    # The grid misses a bulge by (1/64 of a quarter turn)² / 2 of its radius, 0.006 mm at 20 mm.
    slack = 2 * TOLERANCE + ROUNDING
    differs = lambda corners: max(np.abs(low - corners[:3]).max(), np.abs(high - corners[3:]).max()) > slack
    if differs(np.array(box.Get())):
        # The box of a slanted torus can miss half a millimetre: a mesh within a tenth of the tolerance decides.
        points = np.array([point.toTuple() for point in shape.tessellate(0.1 * TOLERANCE, 0.1)[0]])
        corners = np.concatenate([points.min(0), points.max(0)])
        if differs(corners):
            found.append(f"bounding box {low} to {high}, not {corners[:3]} to {corners[3:]}")
    return found, patches


def compared(
    tool: Path, folder: Path, file: Path, shape: cq.Shape, volume: float | None, seed: int, longest: int, spoil=None
) -> Row:
    """Imports a file and compares it with the shape that it should hold; `spoil` edits the model file between."""
    row = Row(parts=1)
    model, asked, answered = folder / "part.toml", folder / "in.csv", folder / "out.csv"
    status, report, seconds = run(longest, tool, "import", file, "--out", model, "--tolerance", str(TOLERANCE))
    row.seconds += seconds
    if status != 0:
        # Of the importer, which the tool runs, or of the tool itself.
        row.late = int(status != 2 or "exited with signal" in report)
        row.refused = 1 - row.late
        last = (report.strip().splitlines() or ["no message"])[-1]
        row.remarks.append(last if row.refused else f"not imported in {longest} processor seconds")
        return row
    wrong, row.patches = faults(report, model, shape, volume)
    row.faces = len(shape.Faces())
    if spoil is not None:
        model.write_text(spoil(model.read_text()))
    points = probes(shape, Random(seed))
    with asked.open("w") as text:
        csv.writer(text).writerows([("qx", "qy", "qz"), *(point.toTuple() for point in points)])
    # They bake the locator, which takes longer than the import.
    status, said, seconds = run(3 * longest, tool, "closest", "--model", model, "--queries", asked, "--out", answered)
    row.seconds += seconds
    if status != 0:
        row.late, row.remarks = 1, [f"closest ended with {status}: {said.strip()[-200:]}"]
        return row
    row.imported = 1
    slack = TOLERANCE + ROUNDING + ShapeAnalysis_ShapeTolerance().Tolerance(shape.wrapped, 1)
    sides = 0
    with answered.open() as text:
        for point, (distance, is_inside), answer in zip(points, truth(shape, points), csv.DictReader(text), strict=True):
            gap = float(answer["gap"])
            row.cold = max(row.cold, abs(abs(gap) - distance))
            # Nearer than that the side is that of the surface's displacement.
            differs = distance > slack and (gap < 0) != is_inside
            sides += differs and (gap < 0) != winds_round(shape, point)
    if row.cold > slack:
        wrong.append(f"a distance is {row.cold:.4f} mm off")
    if sides:
        wrong.append(f"{sides} probes on the wrong side")
    row.wrong, row.remarks = int(bool(wrong)), wrong
    return row


def planted(tool: Path, folder: Path) -> bool:
    """Gives palpate other parts than are compared with: each must be found wrong."""
    plate = cq.Workplane().box(30, 20, 6)
    drilled = plate.faces(">Z").workplane().hole(5)

    def rim(middle: float) -> cq.Shape:
        """A cylinder whose rim is an arc of 2 mm through the middle: the round, or the rest of its torus."""
        profile = cq.Workplane("XZ").lineTo(10, 0).lineTo(10, 8).threePointArc((middle, middle), (8, 10))
        return profile.lineTo(0, 10).close().revolve(360, (0, 0, 0), (0, 1, 0)).val()

    round_, cove = rim(8 + 2**0.5), rim(10 - 2**0.5)
    drilled, plate = (part.solids().val() for part in [drilled, plate])
    centimetres = {".MILLI.,.METRE.": ".CENTI.,.METRE."}

    def turned(model: str) -> str:
        """The first patch with its normal inward."""
        head, first, rest = model.split("[[patch]]", 2)
        first = first.replace("flip = true\n", "") if "flip = true" in first else first.rstrip() + "\nflip = true\n\n"
        return "[[patch]]".join([head, first, rest])

    def torn(model: str) -> str:
        """Without the first patch, as where a seam is lost."""
        head, _, rest = model.split("[[patch]]", 2)
        return head + "[[patch]]" + rest

    is_caught = True
    for name, wanted, given, swaps, spoil in [
        ("hole dropped", drilled, plate, {}, None),
        ("complement of a round", round_, cove, {}, None),
        ("unit", drilled, drilled, centimetres, None),
        ("placement lost", drilled.moved(cq.Location(cq.Vector(0.1, 0, 0))), drilled, {}, None),
        ("turned about an axis", drilled.moved(cq.Location((0, 0, 0), (0, 0, 1), 1)), drilled, {}, None),
        ("face turned", drilled, drilled, {}, turned),
        ("seam lost", drilled, drilled, {}, torn),
    ]:
        file = folder / "planted.step"
        parts.step(given, file, parts.plain)
        text = file.read_text()
        for old, new in swaps.items():
            text = text.replace(old, new)
        file.write_text(text)
        row = compared(tool, folder, file, wanted, None, 1, 60, spoil)
        # A spoiled model is refused where its faces do not go together.
        is_noticed = bool(row.wrong) or spoil is not None and bool(row.late)
        print(f"planted, {name}: {'; '.join(row.remarks) if is_noticed else 'NOT NOTICED'}", flush=True)
        is_caught &= is_noticed
    return is_caught


def main() -> int:
    tool = Path(sys.argv[1])
    count, first, longest = (int(word) for word in sys.argv[2:] + ["30", "0", "60"][len(sys.argv) - 2 :])
    rows: dict[tuple[str, str], Row] = defaultdict(Row)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.environ["PALPATE_CACHE"] = name
        # Builds the importer, if it is not built yet: no limit holds for the compiler.
        box = Path(__file__).parents[1] / "tests/parts/box.step"
        subprocess.run([tool, "import", box, "--out", folder / "box.toml"], check=True, capture_output=True)
        for number in range(first, first + count):
            kind = parts.KINDS[number % len(parts.KINDS)]
            dialect = parts.DIALECTS[number // len(parts.KINDS) % len(parts.DIALECTS)]
            shape, volume = made(kind, number)
            file = folder / f"{kind.__name__}_{number}.step"
            parts.step(shape, file, dialect)
            row = compared(tool, folder, file, shape, volume, number, longest)
            rows[kind.__name__, dialect.__name__].add(row)
            for remark in row.remarks:
                state = "WRONG" if row.wrong else "late" if row.late else "refused"
                print(f"{kind.__name__} {number}, {dialect.__name__}: {state}: {remark}", flush=True)
        is_caught = planted(tool, folder)
    print("\n| kind | dialect | parts | imported | refused | timed out | wrong | cold, mm | patches a face | processor s |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    every = Row()
    for (kind, dialect), row in sorted(rows.items()):
        print(f"| {kind} | {dialect} | {row.cells()}")
        every.add(row)
    print(f"| all |  | {every.cells()}")
    is_few = every.patches <= MOST_PATCHES * every.faces
    return int(every.wrong > 0 or not is_caught or not is_few or every.imported < LEAST_IMPORTED * every.parts)


if __name__ == "__main__":
    sys.exit(main())
