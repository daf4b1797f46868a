"""Compares the modes of `palpate bake --soft` with finite elements of another code (scikit-fem) and with closed forms.

A beam held at an end and a free block: frequencies and modal masses of the modes whose share is above 90 %, and the
deflection under a load at the beam's end. Exit status 1 if one is off by more than 5 %. Runs in the environment that
`.ci/long fem` makes.
"""

import math
import os
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np
from scipy.sparse.linalg import eigsh, splu
from skfem import Basis, ElementHex2, ElementVector, FacetBasis, LinearForm, MeshHex, BilinearForm
from skfem.helpers import ddot, dot, eye, sym_grad, trace

LIMIT = 0.05
YOUNG, NU, DENSITY = 2e5, 0.3, 1000.0
MATERIAL = f"youngs_modulus_pa = {YOUNG}\npoissons_ratio = {NU}\ndensity_kg_per_m3 = {DENSITY}\ndamping_ratio = 0.05\n"


def block(sides: tuple[float, float, float]) -> str:
    """A box in millimetres as a model file; the face x = 0 is "x0"."""
    text = 'name = "block"\nunit = "mm"\n'
    for axis, name in enumerate("xyz"):
        for end in (0, 1):
            a, b = (axis + 1) % 3, (axis + 2) % 3

            def corner(i: int, j: int) -> list[float]:
                at = [0.0] * 3
                at[axis], at[a], at[b] = sides[axis] * end, sides[a] * i, sides[b] * j
                return at

            points = [[corner(0, 0), corner(0, 1)], [corner(1, 0), corner(1, 1)]]
            flip = str(end == 0).lower()
            text += f'[[patch]]\nname = "{name}{end}"\ndegree = [1, 1]\nflip = {flip}\npoints = {points}\n'
    return text


def baked(sides: tuple[float, float, float], held: list[str]) -> list[dict]:
    """The modes of the tool."""
    with tempfile.TemporaryDirectory() as folder:
        model, material = Path(folder, "block.toml"), Path(folder, "material.toml")
        model.write_text(block(sides))
        material.write_text(MATERIAL)
        command = [os.environ["PALPATE_TOOL"], "bake", model, "--soft", material, "--modes", "8"]
        command += ["--held", *held] if held else []
        subprocess.run(command, check=True, cwd=folder, stdout=subprocess.DEVNULL)
        return tomllib.loads(Path(folder, "block.modes.toml").read_text())["mode"]


def displacement(mode: dict, at: np.ndarray) -> np.ndarray:
    """Of points, by columns, metres per metre of q."""
    x, y, z = (at - np.array(mode["centre"])[:, None]) / mode["half"]
    monomials = np.array([1 + 0 * x, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z])
    return np.array(mode["poly"]).T @ monomials


class Solid:
    """A block in finite elements."""

    def __init__(self, sides: tuple[float, float, float], cells: tuple[int, int, int], is_held: bool):
        metres = [side / 1e3 for side in sides]
        mesh = MeshHex.init_tensor(*(np.linspace(0, side, n + 1) for side, n in zip(metres, cells)))
        self.basis = Basis(mesh, ElementVector(ElementHex2()), intorder=4)
        lame, shear = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))

        @BilinearForm
        def stiffness(u, v, _):
            strain = sym_grad(u)
            return ddot(2 * shear * strain + lame * eye(trace(strain), 3), sym_grad(v))

        @BilinearForm
        def mass(u, v, _):
            return DENSITY * dot(u, v)

        self.stiffness, self.mass = stiffness.assemble(self.basis).tocsc(), mass.assemble(self.basis).tocsc()
        fixed = self.basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all() if is_held else np.array([], int)
        self.free = np.setdiff1d(np.arange(self.basis.N), fixed)
        self.end = FacetBasis(
            mesh, self.basis.elem, facets=mesh.facets_satisfying(lambda x: np.isclose(x[0], metres[0]))
        )
        self.area = metres[1] * metres[2]

    def modes(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies, Hz, and vectors with v·Mv = 1, without the rigid body's."""
        k, m = (matrix[self.free][:, self.free] for matrix in (self.stiffness, self.mass))
        # Below the lowest mode, so that the shifted matrix is regular for a free body too.
        values, vectors = eigsh(k, count, m, sigma=-1.0)
        order = [i for i in np.argsort(values) if values[i] > 1.0]
        whole = np.zeros((self.basis.N, len(order)))
        whole[self.free] = vectors[:, order]
        return np.sqrt(values[order]) / (2 * math.pi), whole

    def most(self, vector: np.ndarray) -> float:
        """The largest displacement: at nodes, of which those of a corner move most."""
        return max(np.linalg.norm(vector[self.basis.nodal_dofs], axis=0))

    def load(self) -> np.ndarray:
        """1 N along z, spread over the end."""
        return LinearForm(lambda v, _: v[2] / self.area).assemble(self.end)

    def deflection(self) -> float:
        """Of the end under that load, m/N."""
        load = self.load()[self.free]
        return load @ splu(self.stiffness[self.free][:, self.free]).solve(load)


failed = False


def check(what: str, ours: float, theirs: float, limit: float = LIMIT) -> None:
    global failed
    off = ours / theirs - 1
    failed |= abs(off) > limit
    print(f"{what:<58} {ours:12.6g} {theirs:12.6g} {100 * off:+6.2f} % {'' if abs(off) <= limit else 'OFF'}")


def compare(name: str, sides: tuple[float, float, float], cells: tuple[int, int, int], held: list[str]) -> Solid:
    ours = baked(sides, held)
    solid = Solid(sides, cells, bool(held))
    frequencies, vectors = solid.modes(26)
    for index, mode in enumerate(ours):
        where = int(np.argmin(abs(frequencies - mode["frequency"])))
        label = f"{name} mode {index}, share {100 * mode['share']:.0f} %"
        check(f"{label}, Hz", mode["frequency"], frequencies[where])
        # Vectors of one frequency may be mixed.
        is_alone = sum(abs(frequencies / frequencies[where] - 1) < 0.01) == 1
        if mode["share"] > 0.9 and is_alone:
            check(f"{label}, modal mass, kg", mode["mass"], 1 / solid.most(vectors[:, where]) ** 2)
    return solid


print(f"{'':<58} {'palpate':>12} {'other':>12}")
# Sides that differ, so that no two modes have one frequency.
beam = (100.0, 12.0, 10.0)
solid = compare("beam", beam, (24, 3, 3), ["x0"])
compare("block", (60.0, 40.0, 30.0), (8, 6, 5), [])
compare("block held", (60.0, 40.0, 30.0), (8, 6, 5), ["x0"])

# The beam under a load at its end along z: through the modes that bend it, against the whole deflection.
modes = baked(beam, ["x0"])
end = np.array([[beam[0]], [0.5 * beam[1]], [0.5 * beam[2]]]) / 1e3
compliance = 0.0
for mode in modes:
    k = mode["mass"] * (2 * math.pi * mode["frequency"]) ** 2
    compliance += float(displacement(mode, end)[2, 0]) ** 2 / k
check("beam, deflection of its end, m/N: all modes, elements", compliance, solid.deflection())
length, wide, thick = (side / 1e3 for side in beam)
euler = 4 * length**3 / (YOUNG * wide * thick**3)
check("beam, deflection of its end, m/N: all modes, F L³/3EI", compliance, euler)
bending = 1.875104**2 / (2 * math.pi) * math.sqrt(YOUNG * thick**2 / (12 * DENSITY)) / length**2
check("beam, lowest frequency, Hz: Euler and Bernoulli", modes[0]["frequency"], bending)
sys.exit(int(failed))
