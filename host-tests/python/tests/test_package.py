"""The package itself: its notebooks run, its docstrings' examples hold, its stubs are those of the module."""

import doctest
import inspect
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import palpate
import pytest
from nbclient import NotebookClient
from palpate import bodies, knob, loops

from conftest import FOLDER, ROOT

NOTEBOOKS = sorted((FOLDER / "notebooks").glob("*.ipynb"))


def test_what_is_tested_is_the_wheel_that_was_installed():
    assert Path(sys.prefix) in Path(palpate.__file__).parents
    assert FOLDER not in Path(palpate.__file__).parents


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path):
    # In its own folder, where jupyter starts it.
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": path.parent}}).execute()


def test_there_are_three_notebooks_and_no_outputs_in_them():
    assert len(NOTEBOOKS) == 3
    for path in NOTEBOOKS:
        cells = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
        assert cells and not any(cell.outputs for cell in cells)


def test_the_examples_in_the_docstrings_hold():
    done = [doctest.testmod(module) for module in (palpate, bodies, knob, loops)]
    assert sum(tried.failed for tried in done) == 0 and sum(tried.attempted for tried in done) > 5


def test_everything_public_says_what_it_is():
    for name in palpate.__all__:
        item = getattr(palpate, name)
        assert inspect.getdoc(item), name
        if inspect.isclass(item) and item.__module__.startswith("palpate."):
            for member, value in vars(item).items():
                is_public = not member.startswith("_") and member not in getattr(item, "_fields", ())
                assert not is_public or inspect.getdoc(value), f"{name}.{member}"
    for columns in (palpate.Closest, palpate.Ticks, palpate.Curved, palpate.Apart, palpate.Run, palpate.Records, palpate.Dials, palpate.Turned, palpate.Recording):
        for field in columns._fields:
            assert field in columns.__doc__, f"{columns.__name__}.{field}: neither shape nor unit"


def test_the_page_lists_the_fields_of_results():
    def field(columns, name):
        # The size of a row, where it is more than a number.
        size = re.search(rf"\b{name}\b[^:\n]* : \(n, (\w+)\)", columns.__doc__)
        return f"`{name}`" + (f" ({size[1]})" if size else "")

    results = [palpate.Closest, palpate.Ticks, palpate.Settled, palpate.Run]
    rows = [f"| `{columns.__name__}` | {', '.join(field(columns, name) for name in columns._fields)} |" for columns in results]
    table = "\n".join(["| result | fields; numbers a row |", "|---|---|", *rows])
    assert table in (ROOT / "docs/howto/python.md").read_text(), f"docs/howto/python.md should have\n{table}"


def test_the_types_are_those_of_the_module_and_of_the_package(tmp_path):
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\nstrict = True\n")
    programs = Path(sys.executable).parent
    for command in (
        [programs / "stubtest", "palpate", "--mypy-config-file", settings],
        [programs / "mypy", "--config-file", settings, "--cache-dir", tmp_path / "cache", "-p", "palpate"],
    ):
        done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
