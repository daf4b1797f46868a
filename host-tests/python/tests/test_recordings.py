"""Recordings that the tool wrote, read in Python and computed again."""

import json
import os
import subprocess

import numpy as np
import palpate
import pytest

from conftest import same_bits


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Half a second of `palpate sim`, as its file."""
    program = os.environ.get("PALPATE_TOOL")
    assert program, "PALPATE_TOOL names no program: cargo palpate test --python sets it"
    path = tmp_path_factory.mktemp("recording") / "run.json"
    subprocess.run([program, "sim", "--seconds", "0.5", "--stiffness", "300", "--recording", path], check=True, capture_output=True)
    return path


def test_a_recording_is_the_run_and_its_loop_gives_the_forces_again(recorded, capped_box):
    run = palpate.Recording.load(recorded)
    truth = palpate.simulate("woodenhaptics-2016", capped_box, seconds=0.5, stiffness=300)
    assert (run.device, run.model, run.state_hash) == ("woodenhaptics-2016", "capped_box.toml", truth.state_hash)
    assert (run.rate_hz, run.stiffness_n_per_m, run.rendering, run.is_scene) == (4000.0, 300.0, "smooth", False)
    same_bits(run.counts, truth.counts)
    np.testing.assert_allclose(run.time_s, truth.time, rtol=0, atol=1e-12)
    assert run.body().closest([0.03, 0.02, 0.05]).gap == capped_box.closest([0.03, 0.02, 0.05]).gap
    loop = run.loop()
    forces = []
    for counts, enable in zip(run.counts.tolist(), run.enable.tolist()):
        loop.tick(counts, enable)
        forces.append(loop.force)
    same_bits(np.array(forces, dtype=np.float32), truth.force)
    assert np.abs(truth.force).max() > 0.1


@pytest.mark.parametrize("options", [(), ("--protected",)])
def test_a_recording_carries_its_device_and_protection(options, capped_box, tmp_path):
    tool, device, path = os.environ["PALPATE_TOOL"], tmp_path / "lab-arm.toml", tmp_path / "run.json"
    subprocess.run([tool, "device", "polhem-v2", "--out", device], check=True, capture_output=True)
    device.write_text(device.read_text().replace('"polhem-v2"', '"lab-arm"'))
    command = [tool, "sim", "--device", device, "--seconds", "0.5", "--recording", path, *options]
    subprocess.run(command, check=True, capture_output=True)
    truth = palpate.simulate(device, capped_box, seconds=0.5, protected=bool(options))
    device.unlink()
    run = palpate.Recording.load(path)
    loop, forces = run.loop(), []
    for counts, enable in zip(run.counts.tolist(), run.enable.tolist()):
        loop.tick(counts, enable)
        forces.append(loop.force)
    assert (run.device, run.state_hash) == ("lab-arm", truth.state_hash)
    same_bits(np.array(forces, dtype=np.float32), truth.force)
    with pytest.raises(palpate.FileError, match="the recording's device is damaged"):
        run._replace(device_numbers=run.device_numbers[:-1]).loop()


def test_counts_that_wrap_are_read(recorded, tmp_path):
    from base64 import b64encode

    found = json.loads(recorded.read_text())
    # From the largest count to the least: a difference of 1, modulo 2^32.
    found.update(ticks=2, counts=b64encode(bytes([0xFE, 0xFF, 0xFF, 0xFF, 0x0F, 0, 1, 2, 0, 0])).decode())
    (tmp_path / "wraps.json").write_text(json.dumps(found))
    counts = palpate.Recording.load(tmp_path / "wraps.json").counts
    assert counts.tolist() == [[2**31 - 1, 0, -1], [-(2**31), 0, -1]]


def test_a_file_that_is_no_recording_is_refused(recorded, tmp_path):
    found = json.loads(recorded.read_text())
    for change, says in [
        ({"palpate": "report"}, "not \"recording\""),
        ({"ticks": 2001}, "6000 counts, not 3 in each of 2001 ticks"),
        ({"counts": "?"}, "no recording of palpate"),
        ({"settings": [1.0]}, "no recording of palpate"),
    ]:
        spoilt = tmp_path / "spoilt.json"
        spoilt.write_text(json.dumps(found | change))
        with pytest.raises(palpate.FileError, match=says):
            palpate.Recording.load(spoilt)
    del found["hash"]
    spoilt.write_text(json.dumps(found))
    with pytest.raises(palpate.FileError, match="missing entry 'hash'"):
        palpate.Recording.load(spoilt)
    spoilt.write_text("{")
    with pytest.raises(palpate.FileError, match="spoilt.json: no recording"):
        palpate.Recording.load(spoilt)
    with pytest.raises(FileNotFoundError):
        palpate.Recording.load(tmp_path / "none.json")
