"""A knob's feel from Python, held to its closed forms and to the simulated motor's shaft."""

import re

import numpy as np
import palpate
import pytest

from conftest import ROOT

TAU = 2 * np.pi


@pytest.fixture
def knob():
    with palpate.Knob.simulated() as knob:
        knob.free()
        yield knob


def held(knob, angle):
    """Clamps the shaft there; the means of the trace once it rests, and the last report."""
    knob.hold(angle)
    knob.read(0.2)
    knob.trace()
    told = knob.read(0.05)
    return np.array([column.mean() for column in knob.trace()]), told


def test_a_detent_is_its_closed_form_in_the_reports_and_at_the_shaft(knob):
    pitch, strength, centre, damping = TAU / 24, 0.02, 0.05, 4e-4
    knob.damping(damping)
    angles = np.linspace(-0.3, 0.3, 25)
    free = [held(knob, angle)[0] for angle in angles]
    # The hand is at the encoder's angle, but for 0.3 degrees of eccentricity and 0.07 of noise.
    for angle, row in zip(angles, free, strict=True):
        assert np.abs(row[[0, 3]] - angle).max() < 0.4 / 360 * TAU
    knob.detents(pitch=pitch, torque=strength, centre=centre)
    reported, shaft = [], []
    for angle, before in zip(angles, free, strict=True):
        row, told = held(knob, angle)
        form = -strength * np.sin(TAU * (told.angle - centre) / pitch) - damping * told.rate
        reported.append(np.abs(told.torque - form).max())
        # Cogging is the same with and without the feel.
        shaft.append(row[4] - before[4] + strength * np.sin(TAU * (row[0] - centre) / pitch))
        assert np.abs(np.subtract(*(row[[0, 3]] - before[[0, 3]]))) < 8e-4
        assert told.detent[-1] == np.rint((told.angle[-1] - centre) / pitch)
    print(f"reports {max(reported):.2g} N·m, shaft {np.abs(shaft).max():.2g} N·m off")
    # A rounding of the angle in single precision; the shaft's angle by the encoder is off by a count of 0.4 mrad.
    assert max(reported) < 1e-6
    assert np.abs(shaft).max() < 0.02 * strength


def test_a_setting_beyond_the_motor_is_refused_with_its_limit_and_changes_nothing(knob):
    knob.damping(3e-4)
    knob.detents(pitch=TAU / 12, torque=0.03)
    _, before = held(knob, 0.05)
    for part, numbers, says in [
        ("spring", (0.2, 0.03), r"spring was refused .* up to 60\.00 mN·m, .* limit is 56\.00 mN·m \(max_force_n\): weaken"),
        ("detents", (TAU / 60, 0.05), r"detents was .* stiff as 3000\.00 mN·m/rad, and .* is 1600\.00 mN·m/rad \(max_stiffness_n_per_m\): weaken"),
        ("damping", (4e-3,), r"damping was refused .* 4\.00 mN·m·s/rad, and .* 3\.20 mN·m·s/rad \(max_damping_n_s_per_m\): weaken .*; friction damps"),
        ("spring", (0.02, 0.01, 3.0), r"spring was refused .* turn the dial by .* rad .*°., and .* 0\.79 rad: turn"),
        ("friction", (float("nan"),), r"friction was refused .* finite"),
        ("notch", (0.0, 4.0, 0.01), r"notch was refused .* a width from 1e-4 rad to half a turn"),
        ("detents", (0.0, 0.005), r"detents was refused .* a pitch from 1e-4 rad to half a turn"),
        ("clicks", (0.2, 0.01, -5, 5, 1.5), r"clicks was refused .* a snap from 0\.5 to 1"),
        ("choose", (-1,), r"there is no feel -1"),
        ("choose", (256,), r"there is no feel 256"),
        ("notch", (0.1, 0.1, 0.015), r"notch was refused .* would ring: .* damped by 0\.30 .* need 0\.92; raise the damping first"),
    ]:
        with pytest.raises(palpate.SettingsError, match=says):
            getattr(knob, part)(*numbers)
    # The same closed form as before, to a rounding of the angle in single precision.
    for told in (before, knob.read(0.2)):
        assert np.abs(told.torque + 0.03 * np.sin(12 * told.angle) + 3e-4 * told.rate).max() < 1e-6
    with pytest.raises(palpate.SettingsError, match='no part "spin"'):
        knob.off("spin")


def test_no_change_steps_the_torque_by_more_than_a_millinewton_metre_a_tick(knob):
    damped = {"damping": lambda angle, rate: -2.5e-4 * rate}
    random, forms, largest, change = np.random.default_rng(5), dict(damped), 0.0, 0.0
    knob.damping(2.5e-4)
    for number in range(100):
        knob.hold(0.3 * np.sin(number / 9))
        at, strength = knob.read(0.1).angle[-1], random.uniform(0.005, 0.015)
        before = dict(forms)
        knob.trace()
        if number % 5 == 0:
            knob.detents(TAU / 8, strength)
            forms["detents"] = lambda angle, _, strength=strength: -strength * np.sin(8 * angle)
        elif number % 5 == 1:
            knob.texture(TAU / 24, strength / 10)
            forms["texture"] = lambda angle, _, strength=strength: -strength / 10 * np.sin(24 * angle)
        elif number % 5 == 2:
            knob.spring(0.05, strength, at + 0.3)
            forms["spring"] = lambda angle, _, rest=at + 0.3, most=strength: np.clip(0.05 * (rest - angle), -most, most)
        elif number % 5 == 3:
            knob.notch(at + 0.1, 1.2, strength)
            forms["notch"] = lambda angle, _, at=at + 0.1, strength=strength: np.where(
                np.abs(angle - at) < 0.6, -strength * np.sin(TAU * (angle - at) / 1.2), 0
            )
        else:
            knob.free()
            knob.damping(2.5e-4)
            forms = dict(damped)
        knob.read(0.1)
        trace = knob.trace()
        # The sensor's noise moves the torque of either feel by itself.
        old, new = [sum((form(trace.angle, trace.rate) for form in each.values()), 0 * trace.angle) for each in (before, forms)]
        by_itself = np.maximum(np.abs(np.diff(old)), np.abs(np.diff(new)))
        largest = max(largest, (np.abs(np.diff(trace.torque)) - by_itself).max())
        change = max(change, np.abs(new - old).max())
        assert np.abs(trace.torque - new)[-100:].max() < 1e-6
    print(f"largest step {1e3 * largest:.3f} mN·m a tick, largest change {1e3 * change:.1f} mN·m")
    assert change > 0.02 and largest <= 1e-3


def test_a_part_is_set_by_the_angle_that_is_read(knob):
    # Two turns and half a radian away from where the table's end stops are.
    knob.hold(2 * TAU + 0.5, seconds=1.0)
    assert set(knob.read(0.2).turns) == {0}
    knob.choose(4)
    told = knob.read(0.2)
    assert told.turns[-1] == 2 and abs(told.angle[-1] - 0.5) < 0.4 / 360 * TAU
    rest = told.angle[-1] + 0.1
    knob.damping(2e-4)
    knob.spring(0.05, 0.02, rest)
    told = knob.read(0.2)
    assert abs(told.torque[-1] - 0.05 * (rest - told.angle[-1]) + 2e-4 * told.rate[-1]) < 1e-6
    assert abs(held(knob, 0.3)[1].angle[-1] - 0.3) < 0.4 / 360 * TAU


def test_reports_come_at_their_rate_with_detents_and_ends(knob):
    _, told = held(knob, 0.0)
    at = told.angle[-1]
    knob.damping(2e-4)
    knob.detents(TAU / 24, 0.01)
    knob.ends(at - 0.5, at + 0.5, 0.5)
    knob.hold(0.6)
    told = knob.read(1.0)
    assert 99 <= len(told.tick) <= 101 and set(np.diff(told.tick)) <= {39, 40, 41}
    assert told.end[-1] == 1 and told.detent[-1] == round(told.angle[-1] / (TAU / 24))
    assert told.torque[-1] < 0 and set(told.kept) == {0}


def test_a_fault_ends_the_reading_with_its_reason(knob):
    # 75 rad/s.
    knob.hold(15.0, seconds=0.2)
    with pytest.raises(palpate.LinkError, match="stopped: .*fast"):
        knob.read(0.1)


def test_a_feel_is_kept_once_the_button_is_up(knob):
    knob.damping(2e-4)
    knob.detents(TAU / 24, 0.01)
    with pytest.raises(palpate.SettingsError, match="keep-feel was refused .* release the enable input first"):
        knob.keep()
    knob.press(False)
    knob.read(0.1)
    knob.keep()
    knob.hold(0.3)
    knob.reset()
    told = knob.read(0.1)
    assert set(told.kept) == {1} and set(told.feel) == {6}
    knob.press(False)
    knob.read(0.1)
    knob.forget()
    knob.reset()
    told = knob.read(0.1)
    assert set(told.kept) == {0} and set(told.feel) == {0}


def test_a_port_that_is_none_and_a_knob_that_is_closed(knob):
    with pytest.raises(palpate.LinkError, match="cannot open the serial port /dev/no-such-port"):
        palpate.Knob.open("/dev/no-such-port")
    knob.close()
    with pytest.raises(palpate.LinkError, match="closed"):
        knob.read(0.1)


def test_the_example_of_the_page_runs():
    page = (ROOT / "docs/howto/python.md").read_text()
    [code] = [code for code in re.findall(r"```python\n(.*?)```", page, re.S) if "Knob" in code]
    names = {}
    exec(code, names)
    assert len(names["dials"].torque) >= 99
