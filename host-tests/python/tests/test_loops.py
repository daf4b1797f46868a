"""Trackers, pairs, simulated loops and telemetry."""

import inspect
import os
import re
import struct
import subprocess
import zlib

import numpy as np
import palpate
import pytest

from conftest import ROOT, same_bits


def test_a_tracker_arrives_at_the_closest_point_and_goes_on_where_it_was(capped_box):
    path = np.linspace([0.03, 0.02, 0.06], [0.05, 0.03, 0.05], 4000)
    whole = capped_box.tracker().step(path)
    parts = capped_box.tracker()
    halves = [parts.step(path[:1000]), parts.step(path[1000:])]
    for index, column in enumerate(whole):
        same_bits(column, np.concatenate([half[index] for half in halves]))
    assert whole.located[-1] and whole.contact[-1] == 1
    # No gap of 0, which would be contact, before there is one.
    assert np.isnan(whole.gap[0]) and abs(whole.gap[1] - capped_box.closest(path[1:2]).gap[0]) < 1e-6
    np.testing.assert_array_equal(np.isnan(whole.gap), ~whole.located | (whole.normal == 0).all(axis=1))
    cold = capped_box.closest(path[-1:], signed=False)
    # It follows within a tick's lag, of second order in a step of 6 micrometres.
    assert abs(np.linalg.norm(whole.point[-1] - path[-1]) - cold.gap[0]) < 1e-6 * capped_box.size


def test_a_tracker_begins_where_it_is_told_to(capped_box):
    start = (2, 0.25, 0.75)
    [place] = capped_box.evaluate(2, [start[1:]]).point
    ticks = capped_box.tracker(start=start).step(np.tile(place, (3, 1)))
    assert ticks.feature[0] == 2 and np.linalg.norm(ticks.point[0] - place) < 1e-6 * capped_box.size
    with pytest.raises(IndexError, match="there is no face 6"):
        capped_box.tracker(start=(6, 0.5, 0.5))
    with pytest.raises(palpate.ArrayError, match=r"start\[0\] is not finite"):
        capped_box.tracker(start=(0, float("nan"), 0.5))
    with pytest.raises(palpate.SettingsError, match="there is no law \"steepest\""):
        capped_box.tracker(law="steepest")


def test_both_laws_end_at_the_same_point(capped_box):
    starts = np.stack(np.meshgrid(np.linspace(0, 1, 11), np.linspace(0, 1, 11)), -1).reshape(-1, 2)
    at = capped_box.evaluate(0, [[0.5, 0.5]])
    normal = np.cross(at.u[0], at.v[0])
    probe = at.point[0] + 0.03 * normal / np.linalg.norm(normal)
    ends = [capped_box.settle(0, probe, starts, law=law, most=5000) for law in ("second-order", "certified")]
    places = [capped_box.evaluate(0, end.parameters).point for end in ends]
    distances = np.stack([np.linalg.norm(place - probe, axis=1) for place in places])
    # Single precision, of the size.
    assert np.abs(distances - distances.min()).max() < 1e-6 * capped_box.size
    assert ends[0].steps.max() < ends[1].steps.max()
    assert ends[0].rests.all()
    cut = capped_box.settle(0, probe, starts, most=1)
    assert cut.steps.max() == 1
    assert not cut.rests.any()
    with pytest.raises(palpate.SettingsError, match="there is no law \"steepest\""):
        capped_box.settle(0, probe, starts, law="steepest")
    with pytest.raises(palpate.ArrayError, match=r"probe is of shape \(2, 3\)"):
        capped_box.settle(0, [[0, 0, 0], [0, 0, 0]], starts)


def test_a_pair_of_parallel_squares_is_as_far_apart_as_their_planes():
    square = {"degree": [1, 1], "points": [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]}
    body = palpate.Body.bake([square])
    apart = body.pair(body).step([[0.2, 0.1, 0.5], [3.0, 0.0, 0.0]], steps=200)
    # Closed forms: over each other the gap is 0.5; beside each other the edges are 2 apart.
    np.testing.assert_allclose(apart.distance, [0.5, 2.0], rtol=1e-6)
    quarter = [[[0, 1, 0], [-1, 0, 0], [0, 0, 1]]]
    turned = body.pair(body).step([[3.0, 0.0, 0.0]], quarter, steps=200)
    np.testing.assert_allclose(turned.distance, [1.0], rtol=1e-6)
    for axes in ([[[1, 0, 0], [0, 1, 0], [0, 0, -1]]], [[[2, 0, 0], [0, 1, 0], [0, 0, 1]]], [np.full((3, 3), np.nan)]):
        with pytest.raises(palpate.ArrayError, match=r"axes\[0\]"):
            body.pair(body).step([[0, 0, 1]], axes)
    with pytest.raises(palpate.ArrayError, match=r"axes is of shape \(3, 3\), and must be \(1, 3, 3\)"):
        body.pair(body).step([[0, 0, 1]], np.eye(3))
    with pytest.raises(IndexError, match="there is no face 1"):
        body.pair(body, 0, 1)


def test_a_pair_knows_both_models_frames():
    away = np.array([7.0, 2.0, -4.0])
    points = np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    near, far = (palpate.Body.bake([{"degree": [1, 1], "points": points + at}]) for at in (0 * away, away))
    # The second model is put so that its square lies half a metre over the first one's.
    apart = near.pair(far).step([np.array([0.0, 0.0, 0.5]) - away], steps=200)
    np.testing.assert_allclose(apart.distance, [0.5], rtol=1e-6)
    np.testing.assert_allclose(apart.second - away + [0, 0, 0.5], apart.first + [0, 0, 0.5], atol=1e-6)


def test_a_tool_over_a_square_is_as_far_as_its_lowest_point(capped_box):
    """Closed forms: a segment and a box turned about y over a plane, and a body in its model's frame."""
    square = {"degree": [1, 1], "points": [[[-1, -1, 3], [-1, 1, 3]], [[1, -1, 3], [1, 1, 3]]]}
    body = palpate.Body.bake([square])
    angles = np.linspace(0.0, 1.5, 31)
    turned = np.stack([np.cos(angles / 2), 0 * angles, np.sin(angles / 2), 0 * angles], axis=1)
    origins = np.array([0.1, -0.2, 3.4]) + np.outer(angles, [0.01, 0.0, 0.0])
    segment, brick = 0.1 * np.cos(angles), 0.1 * np.sin(angles) + 0.02 * np.cos(angles)
    for tool, reach in (
        (body.tool(), 0.0 * angles),
        (body.tool(0.1, 0.03), segment + 0.03),
        (body.tool([0.1, 0.05, 0.02]), brick),
    ):
        for found, status in ((tool.locate(origins, turned), "converged"), (tool.step(origins, turned), "tracking")):
            # 2e-6 of the square's side.
            np.testing.assert_allclose(found.distance, 0.4 - reach, atol=4e-6)
            assert set(found.status) == {status} and found.evaluations.min() > 0
            np.testing.assert_allclose(found.on_body[:, 2], 3.0, atol=1e-6)
    # The capped box, 60 mm long over its model's z = 0: as it is, then with x pointing down.
    boxed = body.tool(capped_box, 0.002)
    for found in (boxed.locate, boxed.step):
        pairs = found([[0.1, 0.2, 3.1]] * 2, [[1, 0, 0, 0], [0.5**0.5, 0, 0.5**0.5, 0]])
        np.testing.assert_allclose(pairs.distance, [0.098, 0.038], atol=4e-6)
        np.testing.assert_allclose([pairs.on_core[0, 2], pairs.on_core[1, 0]], [0.0, 0.06], atol=1e-6)


def test_a_tool_that_cannot_be_is_refused(capped_box):
    with pytest.raises(palpate.SettingsError, match="half lengths must be 0 to 1e6 m"):
        capped_box.tool(-0.1)
    with pytest.raises(palpate.SettingsError, match="radius: must be 0 to 1e6 m"):
        capped_box.tool(0.1, float("nan"))
    with pytest.raises(palpate.ArrayError, match="core"):
        capped_box.tool([0.1, 0.2])
    with pytest.raises(palpate.SettingsError, match="certified convex"):
        capped_box.tool(palpate.Body.bake("teapot"))
    tool = capped_box.tool(0.01)
    with pytest.raises(palpate.ArrayError, match=r"quaternions\[1\] has length 2"):
        tool.step([[0, 0, 1]] * 2, [[1, 0, 0, 0], [2, 0, 0, 0]])
    with pytest.raises(palpate.ArrayError, match="origins has 2 rows, and quaternions 1"):
        tool.locate([[0, 0, 1]] * 2, [[1, 0, 0, 0]])


def test_a_simulated_run_is_the_demo_of_the_readme(capped_box):
    run = palpate.simulate("woodenhaptics-2016", capped_box)
    assert f"state hash           {run.state_hash}" in (ROOT / "README.md").read_text()
    assert run.time.shape == (20_000,) and run.force.shape == (20_000, 3) and not run.fault.any()
    assert (run.contact == 2).mean() > 0.2 and np.abs(run.force).max() > 1
    again = palpate.simulate("woodenhaptics-2016", capped_box)
    for ours, theirs in zip(run[1:], again[1:]):
        same_bits(ours, theirs)


@pytest.mark.parametrize(
    ("model", "is_file"), [("ellipsoid", False), ("ellipsoid", True), ("thin_plate", False)]
)
def test_a_run_of_one_face_or_of_many_has_the_hash_of_the_command(model, is_file, tmp_path):
    body = palpate.Body.bake(model)
    if is_file:
        body.save(model := tmp_path / "one_face.palp")
        body = palpate.Body.load(model)
    path = tmp_path / "run.json"
    command = [os.environ["PALPATE_TOOL"], "sim", "--model", model, "--seconds", "1", "--recording", path]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    run = palpate.simulate("woodenhaptics-2016", body, seconds=1)
    assert re.findall(r"state hash +(\w+)", printed) == [run.state_hash]
    assert (run.contact == 2).any()
    # The loop of a recording has the same surface.
    loop, forces = palpate.Recording.load(path).loop(), []
    for counts, enable in zip(run.counts.tolist(), (np.arange(4000) >= 400).tolist()):
        loop.tick(counts, enable)
        forces.append(loop.force)
    same_bits(np.array(forces, dtype=np.float32), run.force)


@pytest.mark.parametrize("device", palpate.devices())
def test_every_device_feels_the_box(device, capped_box):
    run = palpate.simulate(device, capped_box, seconds=1.5, seed=3)
    assert len(run.time) == 6000 and not run.fault.any() and (run.contact == 2).any()


def device_file(folder, **changes):
    """The arm in the example of docs/reference/device-format.md, with entries changed."""
    text = (ROOT / "docs/reference/device-format.md").read_text().split("```toml\n")[1].split("```")[0]
    head, joint = text.split("[[joint]]")
    kinds = (("-16.0", "16.0", "[-1.6, 1.6]"), ("-12.0", "-12.0", "[-0.8, 2.2]"), ("12.0", "12.0", "[-1.2, 1.8]"))
    joints = [
        joint.replace("ratio = -16.0", f"ratio = {encoder}")
        .replace("ratio = 16.0", f"ratio = {motor}")
        .replace("range = [-1.6, 1.6]", f"range = {span}")
        .replace("channel = 0", f"channel = {index}")
        for index, (encoder, motor, span) in enumerate(kinds)
    ]
    text = "[[joint]]".join([head, *joints])
    for before, after in changes.values():
        assert before in text
        text = text.replace(before, after, 1)
    path = folder / "my.toml"
    path.write_text(text)
    return path


def test_a_device_of_ones_own_feels_the_box(capped_box, tmp_path):
    run = palpate.simulate(device_file(tmp_path), capped_box, seconds=1.5, seed=3)
    assert len(run.time) == 6000 and not run.fault.any() and (run.contact == 2).any()
    # Another motor is another run, though the counts are the same until it is driven.
    weaker = device_file(tmp_path, motor=("torque_constant = 0.0259", "torque_constant = 0.0200"))
    other = palpate.simulate(str(weaker), capped_box, seconds=1.5, seed=3)
    assert other.state_hash != run.state_hash
    same_bits(other.counts[:400], run.counts[:400])


def test_a_device_file_that_is_none_is_refused_by_its_entry(capped_box, tmp_path):
    for before, after, entry in (
        ("first_link = 0.205", "first_link = 205.0", "mechanism.first_link"),
        ("counts = 2000.0", "count = 2000.0", "unknown field `count`"),
        ("max_force = 5.0", "max_force = -5.0", "limits"),
    ):
        spoilt = device_file(tmp_path, spoilt=(before, after))
        with pytest.raises(palpate.SettingsError, match=entry):
            palpate.simulate(spoilt, capped_box)
    with pytest.raises(FileNotFoundError, match="none.toml"):
        palpate.simulate(tmp_path / "none.toml", capped_box)


def test_protection_reaches_the_loop(capped_box):
    plain, protected = (palpate.simulate("falcon", capped_box, seconds=0.5, protected=with_) for with_ in (False, True))
    assert plain.state_hash != protected.state_hash


def test_settings_reach_the_loop(capped_box):
    run = palpate.simulate("falcon", capped_box, seconds=0.5, rate=2000, stiffness=500, max_force=0.1, at=(0, 0, -0.04))
    assert len(run.time) == 1000 and np.isclose(run.time[1], 1 / 2000)
    # The force is held to the limit, up to the rounding of a norm.
    assert np.linalg.norm(run.force, axis=1).max() < 0.1 * (1 + 1e-6)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"stiffness": 1e5}, "stiffness = 100000: this device takes 0 to [0-9]+ N/m"),
        ({"damping": -1}, "damping = -1: this device takes 0 to [0-9]+ N·s/m"),
        ({"velocity_corner": -1}, "velocity_corner = -1: "),
        ({"rate": float("nan")}, "ticks"),
        ({"seconds": 0}, "ticks"),
        ({"seconds": 1e12}, "ticks"),
        ({"max_force": float("nan")}, "force"),
        ({"at": (9, 9, 9)}, "workspace"),
    ],
)
def test_what_a_device_cannot_is_refused_by_name(options, says, capped_box):
    with pytest.raises(palpate.SettingsError, match=says):
        palpate.simulate("falcon", capped_box, **options)
    if not {"seconds", "at"} & set(options) and says != "ticks":
        with pytest.raises(palpate.SettingsError, match=says):
            palpate.Loop("falcon", capped_box, **options)


def test_unknown_devices_and_places_that_are_none_are_refused(capped_box):
    with pytest.raises(palpate.SettingsError, match="there is no device \"hapkit\"; there are woodenhaptics-2016"):
        palpate.simulate("hapkit", capped_box)
    with pytest.raises(palpate.SettingsError, match="arm.urdf: a device file ends in .toml"):
        palpate.simulate("arm.urdf", capped_box)
    with pytest.raises(palpate.ArrayError, match=r"at\[0\] is not finite"):
        palpate.simulate("falcon", capped_box, at=(0, 0, np.nan))
    with pytest.raises(TypeError, match="colour"):
        palpate.simulate("falcon", capped_box, colour=1)


def varint(number):
    out = bytearray()
    while number > 127:
        out.append(number & 127 | 128)
        number >>= 7
    return bytes([*out, number])


def zigzag(number):
    return varint(number * 2 if number >= 0 else -number * 2 - 1)


def frame(record):
    """COBS(message, CRC-32), 0: by docs/reference/wire.md, not by the library."""
    message = record + struct.pack("<I", zlib.crc32(record))
    runs = message.split(b"\0")
    return b"".join(bytes([len(run) + 1]) + run for run in runs) + b"\0"


def record(tick, gap):
    """The fields in the order of docs/reference/wire.md: 1 is a record."""
    before = b"".join(map(varint, (1, tick, tick, 25_000_000, 7, 6250, 6251, 1800, 0)))
    state = bytes([3, 0]) + varint(0) + bytes([0]) + varint(0) + varint(0)
    state += varint(0) + bytes([0, 0, 0]) + bytes([0]) + varint(2) + bytes([0, 2])
    return before + state + struct.pack("<7f", gap, 0.1, 0.2, 0.3, 1.0, 2.0, 3.0) + b"".join(map(zigzag, (-5, 0, 700)))


def test_telemetry_comes_from_a_port_and_nothing_goes_to_it():
    device, line = os.openpty()
    with palpate.Link(os.ttyname(line)) as link:
        sent = b"".join(frame(record(tick, -1e-3 * tick)) for tick in range(5))
        os.write(device, b"rubbish\0" + sent)
        records = link.read(5, timeout=10)
        np.testing.assert_array_equal(records.tick, range(5))
        np.testing.assert_allclose(records.gap, -1e-3 * np.arange(5), rtol=1e-6)
        np.testing.assert_array_equal(records.duties[-1], [-5, 0, 700])
        np.testing.assert_allclose(records.force[-1], [1, 2, 3])
        assert records.damaged == 1
        assert len(link.read(1, timeout=0.05).tick) == 0, "nothing more came"
        os.set_blocking(device, False)
        with pytest.raises(BlockingIOError):
            os.read(device, 1)
        with pytest.raises(palpate.SettingsError, match="timeout"):
            link.read(1, timeout=-1)
    with pytest.raises(palpate.LinkError, match="is closed"):
        link.read(1)
    with pytest.raises(palpate.LinkError, match="/dev/none"):
        palpate.Link("/dev/none")


def test_a_link_opens_at_the_speed_that_monitor_takes():
    monitor = (ROOT / "host-tests/tool/src/commands/monitor.rs").read_text()
    [speed] = re.findall(r"default_value_t = ([\d_]+)[^\]]*\]\s+baud:", monitor)
    assert inspect.signature(palpate.Link).parameters["baud"].default == int(speed)


def test_the_loop_by_itself_is_the_loop_of_a_run(capped_box):
    """On the own plant, against the run's own duties: the same counts give the same duties."""
    run = palpate.simulate("woodenhaptics-2016", capped_box, seconds=1.0, at=(-0.03, -0.02, -0.03))
    loop = palpate.Loop(
        "woodenhaptics-2016", capped_box, at=(-0.03, -0.02, -0.03)
    )
    duties = [loop.tick(counts.tolist(), tick >= 400) for tick, counts in enumerate(run.counts)]
    assert (np.array(duties) == run.duties).all() and np.any(run.duties)
    assert loop.fault == 0 and loop.phase == 3


def flat_wall(side=0.1):
    return palpate.Body.bake([{"degree": [1, 1], "points": [[[-side, -side, 0], [-side, side, 0]], [[side, -side, 0], [side, side, 0]]]}])


def test_a_loop_takes_the_settings_that_are_recommended_for_its_device(tmp_path):
    for most, stiffness in ((380.0, 380.0), (900.0, 500.0)):
        path = device_file(tmp_path, wall=("max_stiffness = 1000.0", f"max_stiffness = {most}"))
        plant, loop = palpate.Plant(palpate.Device(path), [0, 0, 0.004]), palpate.Loop(path, flat_wall())
        for _ in range(4_000):
            plant.advance(loop.tick(plant.counts), [0, 0, -0.006], stiffness=300.0, damping=20.0)
        assert loop.force[2] == pytest.approx(stiffness * -loop.gap, rel=1e-3) and loop.force[2] > 1
        with pytest.raises(palpate.SettingsError, match=f"stiffness = {most + 1:.0f}: this device takes 0 to {most:.0f} N/m"):
            palpate.Loop(path, flat_wall(), stiffness=most + 1)


def bridged(folder):
    """An arm on bridges, and no counterweight beside the rods of 100 g."""
    path = device_file(folder, masses=("[0.15229268, 0.04085714]", "[0.15, 0.05]"))
    text = re.sub("(?m)^inertia = .*\n", "", path.read_text())
    bridge = "bridge = { supply = 24.0, resistance = 0.7, inductance = 0.00012, back_emf_share = 0.8 }"
    path.write_text(text.replace("[joint.motor]\n", f"[joint.motor]\n{bridge}\n"))
    return path


def test_the_numbers_of_a_device_file_are_those_of_its_preset(tmp_path):
    for name in palpate.devices():
        path = tmp_path / "own.toml"
        subprocess.run([os.environ["PALPATE_TOOL"], "device", name, "--out", path], check=True, capture_output=True)
        ours, theirs = palpate.Device(path).numbers(), palpate.Device(name).numbers()
        assert set(ours) == set(theirs)
        for key in ("centre", "depth", "legs", "gravity", "coulomb", "time_constant"):
            assert np.allclose(ours.get(key, 0), theirs.get(key, 0), atol=1e-7), key
    numbers = palpate.Device(bridged(tmp_path)).numbers()
    assert np.allclose(numbers["time_constant"], 0.00012 / 0.7) and np.allclose(numbers["balance"], 0)


def test_a_bridge_loses_its_back_emf(tmp_path):
    device, rates = palpate.Device(bridged(tmp_path)), np.array([2.0, -1.0, 0.5])
    # Volts over ohms, by the torque constant at the joint.
    constants = 0.0259 * np.array([16, -12, 12])
    currents = (24.0 * np.array([1000, -2000, 300]) / 32767 - constants * rates) / 0.7
    assert np.allclose(device.torques([1000, -2000, 300], rates), currents * constants)


def test_an_arm_on_bridges_moves_in_mujoco_as_on_the_own_plant(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "host-tests/mujoco"))
    import plants

    device, start = palpate.Device(bridged(tmp_path)), [0, 0, 0.01]
    heights = []
    for plant in (plants.wooden_haptics(device, start), palpate.Plant(device, start)):
        loop = palpate.Loop(device.name, flat_wall())
        heights.append([])
        for tick in range(4000):
            aim = [0, 0, 0.01 * np.cos(2 * np.pi * tick / 2000)]
            plant.advance(loop.tick(plant.counts), aim, stiffness=1000.0, damping=20.0)
            heights[-1].append(plant.position[2])
        assert loop.fault == 0
    apart = np.abs(np.subtract(*heights)).max()
    print(f"an arm on bridges: {apart * 1e6:.0f} µm apart")
    # A count of the encoders is 58 µm.
    assert apart < 58e-6


def test_a_wall_holds_the_own_plant_by_its_spring():
    wall = flat_wall()
    device = palpate.Device("falcon")
    plant, loop = palpate.Plant(device, [0, 0, 0.004]), palpate.Loop("falcon", wall)
    for _ in range(6_000):
        plant.advance(loop.tick(plant.counts), [0, 0, -0.01], stiffness=1000.0, damping=20.0)
    # The loop knows the depth by its encoders: 16 µm of 3 mm, and friction holds the probe off its rest.
    assert loop.force[2] == pytest.approx(400.0 * -plant.position[2], rel=0.02)
    assert np.allclose(device.pose(device.angles(plant.position))[0], plant.position, atol=1e-7)
    with pytest.raises(palpate.SettingsError):
        palpate.Loop("falcon", wall, stiffness=1e5)
