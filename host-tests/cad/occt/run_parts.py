#!/usr/bin/env python3
"""Holds the importer against Open CASCADE on random parts: `run_parts.py [COUNT [FIRST [SECONDS]]]`.

CadQuery goes into a virtual environment in target/occt; nothing else on the machine is touched. The tool is the one in
PALPATE_TOOL, or cargo builds it. Part N is of kind N modulo 7 in each of three dialects by turns (parts.py); compare.py
imports and compares; an import may take SECONDS of a processor, its queries three times that. Ends with 1 if a part is
silently wrong, if a planted fault is not noticed, if fewer parts than LEAST_IMPORTED are imported, or if they take more
than MOST_PATCHES for each face.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent.parent.parent
ENVIRONMENT = ROOT / "target/occt"
CADQUERY = "cadquery>=2.5,<3"


def python() -> Path:
    """The Python of a virtual environment that has CadQuery."""
    found = ENVIRONMENT / "bin/python"
    if not (ENVIRONMENT / "complete").exists():
        print(f"setting up the virtual environment {ENVIRONMENT.relative_to(ROOT)}: {CADQUERY}", file=sys.stderr)
        subprocess.run([sys.executable, "-m", "venv", "--clear", ENVIRONMENT], check=True)
        pip = [found, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:"]
        subprocess.run([*pip, CADQUERY], check=True)
        (ENVIRONMENT / "complete").touch()
    return found


def main() -> int:
    if "PALPATE_TOOL" in os.environ:
        tool = ROOT / os.environ["PALPATE_TOOL"]
    else:
        subprocess.run(["cargo", "build", "--package", "palpate-tool"], cwd=ROOT, check=True)
        tool = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug/palpate"
    return subprocess.run([python(), FOLDER / "compare.py", tool, *sys.argv[1:]], cwd=ROOT).returncode


if __name__ == "__main__":
    sys.exit(main())
