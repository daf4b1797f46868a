"""Closest pairs of a body and a tool by palpate and by coal on the same poses, in one run: error and time.

    python3 compare.py [PAGE]       with the wheel, coal and SciPy installed: `.ci/long coal` sets that up

The distances of both are compared with double precision that shares no code with either: for two ellipsoids the dual
maximum over directions, otherwise the closed form of the distance to a box, minimised over the patches' parameters.
Exit status 1 if an answer of palpate is off by more than its tolerance.
"""

import sys
import tomllib
from io import StringIO
from pathlib import Path
from time import perf_counter_ns

import coal
import numpy as np
import palpate
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

MARK = "<!-- generated: .ci/long coal -->\n\n"
MODELS = Path(__file__).parents[1] / "models"
POSES = 200
# Of a cold answer, relative to the body's size.
TOLERANCE = 2e-6
BOX = np.array([0.012, 0.007, 0.004])
AXES, TOOL_AXES = np.array([0.05, 0.035, 0.025]), np.array([0.014, 0.009, 0.006])


def bernstein(degree, t):
    """All polynomials at each t, by de Casteljau's recurrence."""
    rows = [np.ones_like(t)]
    for _ in range(degree):
        rows = [(1 - t) * a + t * b for a, b in zip(rows + [0 * t], [0 * t] + rows)]
    return np.stack(rows)


def evaluate(net, u, v):
    """Points of a polynomial Bézier patch in double precision, (..., 3)."""
    return np.einsum("i...,j...,ijk->...k", bernstein(net.shape[0] - 1, u), bernstein(net.shape[1] - 1, v), net)


def box_distance(points):
    return np.linalg.norm(np.maximum(np.abs(points) - BOX, 0), axis=-1)


def distance_to_box(nets, turn, origin):
    """Least distance of the patches and a box, by ever finer grids about the lowest places of a coarse one."""
    grid = np.linspace(0, 1, 65)
    starts = []
    for net in nets:
        u, v = np.meshgrid(grid, grid, indexing="ij")
        far = box_distance((evaluate(net, u, v) - origin) @ turn)
        padded = np.pad(far, 1, constant_values=np.inf)
        around = [padded[1 + i : 66 + i, 1 + j : 66 + j] for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
        low = far <= np.min(around, axis=0)
        starts += [(far[i, j], net, grid[i], grid[j]) for i, j in zip(*np.nonzero(low))]
    best, spread = np.inf, np.linspace(-1, 1, 9)
    for _, net, u, v in sorted(starts, key=lambda start: start[0])[:6]:
        half = 1 / 64
        for _ in range(40):
            us, vs = np.meshgrid(*(np.clip(x + half * spread, 0, 1) for x in (u, v)), indexing="ij")
            far = box_distance((evaluate(net, us, vs) - origin) @ turn)
            at = np.unravel_index(np.argmin(far), far.shape)
            u, v, half = us[at], vs[at], 0.5 * half
        best = min(best, far[at])
    return best


def distance_of_ellipsoids(turn, origin):
    """Max over unit n of n·p - |A n| - |B n|, by Newton's method on the sphere: the distance, and n."""
    a, b = np.diag(AXES**2), turn @ np.diag(TOOL_AXES**2) @ turn.T
    n = origin / np.linalg.norm(origin)
    for _ in range(100):
        lengths = [np.sqrt(n @ m @ n) for m in (a, b)]
        slope = origin - sum(m @ n / length for m, length in zip((a, b), lengths))
        bend = -sum(m / l - np.outer(m @ n, m @ n) / l**3 for m, l in zip((a, b), lengths))
        flat = np.eye(3) - np.outer(n, n)
        step = np.linalg.lstsq(flat @ bend @ flat - (n @ slope) * flat, -flat @ slope, rcond=None)[0]
        value = n @ origin - sum(lengths)
        share = 1.0
        while share > 1e-9:
            tried = n + share * step
            tried /= np.linalg.norm(tried)
            if tried @ origin - sum(np.sqrt(tried @ m @ tried) for m in (a, b)) >= value:
                break
            share *= 0.5
        n = tried
    return n @ origin - sum(np.sqrt(n @ m @ n) for m in (a, b)), n


def ellipsoid(axes):
    """The shipped ellipsoid, whose patches are exact, scaled to half axes."""
    model = tomllib.loads((MODELS / "ellipsoid_body.toml").read_text())
    scale = np.append(axes / AXES / 1000, 1)
    return [{**patch, "points": np.array(patch["points"]) * scale} for patch in model["patch"]]


def nets_of(name):
    model = tomllib.loads((MODELS / f"{name}.toml").read_text())
    return [np.array(patch["points"]) / 1000 for patch in model["patch"]]


def wavy():
    """A sheet of 60 mm with four hills of 6 mm: not convex."""
    x, y = np.meshgrid(np.linspace(0, 0.06, 8), np.linspace(0, 0.06, 8), indexing="ij")
    z = 0.04 * np.sin(np.linspace(0, 4 * np.pi, 8))[:, None] * np.sin(np.linspace(0, 4 * np.pi, 8))[None, :]
    net = np.stack([x, y, z], axis=-1)
    return [np.array(net[:6, :6])]


def triangles(body, count):
    """A grid of so many squares each way on every face: corners, and triangles of their indices."""
    t = np.linspace(0, 1, count + 1)
    at = np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1).reshape(-1, 2)
    corners, faces = [], []
    square = np.arange(count)[:, None] * (count + 1) + np.arange(count)
    first = square.ravel()
    for face in range(body.faces):
        base = face * len(at)
        corners.append(body.evaluate(face, at).point)
        for way in ([0, count + 1, count + 2], [0, count + 2, 1]):
            faces.append(base + first[:, None] + np.array(way))
    return np.concatenate(corners), np.concatenate(faces)


def vectors(rows):
    out = coal.StdVec_Vec3s()
    for row in rows:
        out.append(np.asarray(row, float))
    return out


def indices(rows):
    out = coal.StdVec_Triangle()
    for row in rows:
        out.append(coal.Triangle(*map(int, row)))
    return out


def hull(points):
    """The convex hull as coal's shape, triangles outward."""
    shape = ConvexHull(points)
    used, faces = np.unique(shape.simplices, return_inverse=True)
    faces = faces.reshape(shape.simplices.shape)
    corners = points[used]
    a, b, c = (corners[faces[:, k]] for k in range(3))
    inward = np.einsum("nk,nk->n", np.cross(b - a, c - a), shape.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return coal.Convex(vectors(corners), indices(faces)), len(corners)


def soup(body, count):
    """The triangles as coal's tree of boxes."""
    corners, faces = triangles(body, count)
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(faces), len(corners))
    model.addVertices(corners)
    model.addTriangles(faces)
    model.endModel()
    return model, len(corners)


def best(run):
    """Answers, and the least mean time of a pose in three runs, µs."""
    runs = [run() for _ in range(3)]
    return runs[0][0], min(time for _, time in runs) / POSES / 1000


def by_coal(first, second, tolerance, turns, origins):
    """Distances, and nanoseconds of all poses; a call a pose."""
    request = coal.DistanceRequest()
    request.gjk_tolerance, request.gjk_max_iterations = tolerance, 1000
    query, here = coal.ComputeDistance(first, second), coal.Transform3s.Identity()
    distances, time = [], 0
    for turn, origin in zip(turns, origins):
        there, result = coal.Transform3s(turn, origin), coal.DistanceResult()
        start = perf_counter_ns()
        distances.append(query(here, there, request, result))
        time += perf_counter_ns() - start
    return np.array(distances), time


def by_palpate(query, quaternions, origins):
    """The same, in one call."""
    start = perf_counter_ns()
    found = query(origins, quaternions)
    return found.distance, perf_counter_ns() - start


class Case:
    """A body and a tool at random poses near it, with their true distances."""

    def __init__(self, name, body, core, true, reach, middle):
        self.name, self.body, self.tool = name, body, body.tool(core)
        random = np.random.default_rng(7)
        self.turns, self.origins, self.true = [], [], []
        while len(self.true) < POSES:
            turn = Rotation.random(random_state=random)
            way = random.normal(size=3)
            origin = middle + way / np.linalg.norm(way) * random.uniform(*reach)
            distance = true(turn.as_matrix(), origin)
            if 1e-4 < distance < 0.03:
                self.turns.append(turn)
                self.origins.append(origin)
                self.true.append(distance)
        self.quaternions = np.array([turn.as_quat()[[3, 0, 1, 2]] for turn in self.turns])
        self.origins, self.true = np.array(self.origins), np.array(self.true)

    def approach(self, apart, normals):
        """Along the common normal of each pose, until so much is left: of convex bodies the witness points stay."""
        self.name += f", {apart:g} m apart"
        self.origins = self.origins - (self.true - apart)[:, None] * normals
        self.true = np.full(POSES, apart)

    def compare(self, out, shapes):
        """Rows of the table; the worst error of palpate."""
        matrices = [turn.as_matrix() for turn in self.turns]
        runs = [("palpate, cold", lambda: by_palpate(self.tool.locate, self.quaternions, self.origins))]
        for method, *of in shapes:
            runs.append((method, lambda *of: by_coal(*of, matrices, self.origins), *of))
        worst = []
        for method, run, *of in runs:
            distances, micro = best(lambda: run(*of))
            error = np.abs(distances - self.true) / self.body.size
            ours = ours if worst else micro
            worst.append(error.max())
            cells = (self.name, method, f"{np.median(error):.1e}", f"{worst[-1]:.1e}", f"{micro:.1f}", f"{micro / ours:.2g}")
            print(f"| {' | '.join(cells)} |", file=out)
        return worst[0]


def main():
    out = StringIO()
    print("| pair | by | median error, sizes | worst | µs, mean | × ours |\n|---|---|---|---|---|---|", file=out)
    worst = []
    body, core = (palpate.Body.bake(ellipsoid(axes)) for axes in (AXES, TOOL_AXES))
    case = Case("two ellipsoids", body, core, lambda *pose: distance_of_ellipsoids(*pose)[0], (0.03, 0.08), np.zeros(3))
    exact = coal.Ellipsoid(AXES), coal.Ellipsoid(TOOL_AXES)
    shapes = [(f"coal, exact, tolerance {tolerance:g}", *exact, tolerance) for tolerance in (1e-6, 1e-9)]
    for count in (8, 32):
        (first, n), (second, m) = (hull(triangles(each, count)[0]) for each in (body, core))
        shapes.append((f"coal, hulls of {n:,} and {m:,} vertices", first, second, 1e-9))
    worst.append(case.compare(out, shapes))
    poses = zip(case.turns, case.origins)
    case.approach(1e-7, np.array([distance_of_ellipsoids(turn.as_matrix(), origin)[1] for turn, origin in poses]))
    worst.append(case.compare(out, shapes[:2]))

    brick = coal.Box(*(2 * BOX))
    body, nets = palpate.Body.bake("capped_box"), nets_of("capped_box")
    case = Case("capped box, box", body, BOX, lambda *pose: distance_to_box(nets, *pose), (0.02, 0.06), np.array([0.03, 0.02, 0.015]))
    shapes = []
    for count in (8, 32, 128):
        shape, n = hull(triangles(body, count)[0])
        shapes.append((f"coal, hull of {n:,} vertices", shape, brick, 1e-9))
    worst.append(case.compare(out, shapes))

    nets = wavy()
    body = palpate.Body.bake([{"degree": [5, 5], "points": net} for net in nets])
    case = Case("wavy sheet, box", body, BOX, lambda *pose: distance_to_box(nets, *pose), (0.005, 0.05), np.array([0.02, 0.02, 0.0]))
    shapes = []
    for count in (16, 64, 256):
        shape, n = soup(body, count)
        shapes.append((f"coal, {n:,} vertices", shape, brick, 1e-9))
    worst.append(case.compare(out, shapes))

    table = out.getvalue()
    print(table, end="")
    if len(sys.argv) > 1:
        page = Path(sys.argv[1])
        before, after = page.read_text().split(MARK)
        page.write_text(before + MARK + table + "\n<!-- end -->" + after.split("<!-- end -->", 1)[1])
    if max(worst) > TOLERANCE:
        sys.exit(f"palpate is off by {max(worst):.1e} sizes, and may be by {TOLERANCE:g}")


main()
