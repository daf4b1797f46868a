"""Hosts in other languages. The C++ loop for a PC runs on the C library, against two springs in line. Frames are those
that docs/reference/wire.md and docs/howto/link.md print: C# as Unity takes it, compiled by Mono, and the mapping to ROS 2
messages. Neither Unity nor ROS 2 runs here: the object for Unity and the node around the mapping are sketches."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace as Message

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
DOCS = ROOT / "docs"
RECORD = {"tick": 70000, "phase": 3, "fault": 0, "gap": -0.0015, "probe": [0.05, 0.06, 0.0725], "force": [0, 0.25, 0.875]}


def set_up():
    """Mono's compiler, from Debian where it is missing."""
    if shutil.which("mcs") and shutil.which("mono"):
        return
    subprocess.run(["apt-get", "update", "-qq"], check=True)
    subprocess.run(["apt-get", "install", "-y", "-qq", "--no-install-recommends", "mono-mcs", "mono-runtime"], check=True)


def test_cpp():
    """Position in, force out: the hand's 300 N/m draws the grip 10 mm into the wall's 500 N/m."""
    library = ROOT / "host-tests/c"
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    cargo = ["cargo", "build", "--quiet", "--locked", "--profile", "abort", "--target-dir", str(target)]
    subprocess.run(cargo, cwd=library, check=True)
    file = (ROOT / "boards/bodies/capped_box.palp").read_bytes()
    with tempfile.TemporaryDirectory() as folder:
        # As `palpate c-library` writes it: a box has 6 faces and 12 edges, and its dome is 33.5 mm high.
        numbers = ", ".join(map(str, file))
        Path(folder, "part.h").write_text(
            f"#define PART_TOP {{0.03f, 0.02f, 0.0335f}}\nenum {{ PART_FACES = 6, PART_EDGES = 12 }};\nalignas(4) static const uint8_t part_palp[] = {{{numbers}}};\n"
        )
        program = f"{folder}/loop"
        options = ["-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I", f"{library}/include", "-I", folder]
        sources = [f"{library}/package/examples/host/loop.cpp", f"{target}/abort/libpalpate.a"]
        subprocess.run(["g++", *options, *sources, "-o", program], check=True)
        said = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    depth, force = map(float, re.fullmatch(r"depth (\S+) mm, force (\S+) N\n", said).groups())
    assert abs(depth - 300 * 10 / (300 + 500)) < 1e-3 and abs(force - 0.5 * depth) < 1e-3, said


def record_frame():
    section = (DOCS / "reference/wire.md").read_text().split("\n## Record\n")[1].split("\n## ")[0]
    return re.search(r"^Frame: `([0-9a-f ]+)`$", section, re.M)[1]


def test_c_sharp():
    frames = re.findall(r"^\| `([0-9a-f ]+)` \| ([^|]+) \|$", (DOCS / "howto/link.md").read_text(), re.M)
    shown = {says.strip(): frame for frame, says in frames}
    sent = [
        shown["hello, in version 5"],
        shown["the host is there"],
        shown["stop"],
        shown["order 1: a push of 0, 0, 0.5 N"],
    ]
    record = record_frame()
    # A bit of the gap changed on the way, a frame cut short, another message.
    spoiled = [record.replace("a6 9b c4 ba", "a7 9b c4 ba"), record[:59] + " 00", sent[0]]
    with tempfile.TemporaryDirectory() as folder:
        program = f"{folder}/test.exe"
        sources = [str(HERE / "unity" / name) for name in ("Test.cs", "PalpateLink.cs")]
        subprocess.run(["mcs", "-warnaserror", f"-out:{program}", *sources], check=True)
        text = "\n".join([record, *spoiled]) + "\n"
        lines = subprocess.run(["mono", program], input=text, capture_output=True, text=True, check=True).stdout.splitlines()
    assert lines[:4] == sent, lines[:4]
    tick, phase, fault, *numbers = lines[4].split()
    assert [int(tick), int(phase), int(fault)] == [RECORD["tick"], RECORD["phase"], RECORD["fault"]], lines[4]
    assert [float(number) for number in numbers] == [RECORD["gap"], *RECORD["probe"], *RECORD["force"]], lines[4]
    assert lines[5:] == ["none, damaged 1", "none, damaged 2", "none, damaged 2"], lines[5:]


def test_ros2():
    sys.path.insert(0, str(HERE))
    from ros2_bridge import FRAME, fill

    point, vector = Message(x=0.0, y=0.0, z=0.0), Message(x=0.0, y=0.0, z=0.0)
    probe = Message(header=Message(frame_id=""), point=point)
    wrench = Message(header=Message(frame_id=""), wrench=Message(force=vector))
    gap, fault = Message(data=0.0), Message(data=0)
    fill(RECORD, probe, wrench, gap, fault)
    assert [point.x, point.y, point.z] == RECORD["probe"]
    assert [vector.x, vector.y, vector.z] == RECORD["force"]
    assert (gap.data, fault.data, probe.header.frame_id, wrench.header.frame_id) == (RECORD["gap"], 0, FRAME, FRAME)


if __name__ == "__main__":
    set_up()
    test_cpp()
    test_c_sharp()
    test_ros2()
    print("3 passed, 0 failed")
