"""Looks: settings by name, changes, files."""

import pickle

import numpy as np
import pytest

import chiaroscuro as ch


def test_settings_are_read_and_written_by_name(chair_look):
    look = chair_look.copy()
    look["shadows.strength"] = 0.5
    look["range"] = {"typed": [10, 150]}
    look["output.background.top"] = np.array([0.1, 0.2, 0.3])
    assert look["shadows.strength"] == 0.5
    assert look["layers.0.range"] == look["range"] == {"typed": [10.0, 150.0]}
    np.testing.assert_allclose(look["output.background.top"], [0.1, 0.2, 0.3], atol=1e-7)
    assert look != chair_look
    with pytest.raises(KeyError, match="shadows.strenght"):
        look["shadows.strenght"]
    with pytest.raises(ch.InvalidArgument, match="strength"):
        look["shadows.strenght"] = 1
    with pytest.raises(ch.InvalidArgument):
        look["shadows.strength"] = "much"
    with pytest.warns(UserWarning, match="out of range"):
        look["shadows.strength"] = -3


def test_a_light_is_where_it_was_put(chair_look):
    look = chair_look.copy()
    assert len(look.lights) == look._native.light_count
    light = look.lights[0]
    for direction in [(-40, 35), (90, 0), (170, -20)]:
        light.direction = direction
        np.testing.assert_allclose(light.direction, direction, atol=1e-9)
    light.color, light.intensity, light.size, light.on = (1, 0.5, 0), 2, 0.3, False
    assert (light.intensity, light.on) == (2.0, False)
    np.testing.assert_allclose(light.color, (1, 0.5, 0))
    assert chair_look.lights[0].on, "a copy leaves the first as it is"
    with pytest.raises(IndexError):
        look.lights[9]
    # One that is locked to the camera turns with it, one that is locked to the scene does not.
    for lock, stays in [("camera", True), ("scene", False)]:
        look["lights.0.lock"] = lock
        light.direction = (-40, 35)
        look["camera.azimuth_deg"] = look["camera.azimuth_deg"] + 30
        assert np.allclose(light.direction, (-40, 35), atol=1e-9) == stays


def test_changes_have_the_words_of_other_packages(chair, chair_look):
    look = chair_look.with_(chair, colormap="magma_r", clim=(20, 120), opacity="ramp", rendering="mip")
    assert look["mode.kind"] == "maximum"
    assert look["range"] == {"typed": [20.0, 120.0]}
    points = look["transfer.points"]
    assert (points[0]["opacity"], points[-1]["opacity"]) == (0.0, 1.0)
    assert (points[0]["value"], points[-1]["value"]) == (20.0, 120.0)
    assert chair_look["mode.kind"] == "matter"
    drawn = chair_look.with_(chair, opacity=lambda values: (values > 50) * 0.5)
    assert max(point["opacity"] for point in drawn["transfer.points"]) == 0.5
    listed = chair_look.with_(opacity=[(0, 0), (30, 0), (200, 0.7)])
    assert [point["value"] for point in listed["transfer.points"]] == [0, 30, 200]
    for wrong in [
        {"colormap": "rainbow"},
        {"opacity": "steep"},
        {"rendering": "x"},
        {"clim": (3, 1)},
        {"quality": "x"},
    ]:
        with pytest.raises(ch.InvalidArgument, match=next(iter(wrong)).replace("clim", "contrast_limits")):
            chair_look.with_(chair, **wrong)
    with pytest.raises(ch.InvalidArgument, match="give it"):
        chair_look.with_(contrast_limits=(0, 1))


def test_limits_stretch_the_curve(chair, chair_look):
    before = [point["value"] for point in chair_look["transfer.points"]]
    low, high = chair_look._native.shown_range(chair._native)
    look = chair_look.with_(chair, contrast_limits=(2 * low, 2 * high))
    np.testing.assert_allclose([point["value"] for point in look["transfer.points"]], 2 * np.array(before))


def test_looks_are_saved_loaded_and_sent(chair_look, tmp_path):
    look = chair_look.copy()
    look["shadows.gain"] = 1.3
    look.save(tmp_path / "look.json")
    assert ch.Look.load(tmp_path / "look.json") == look
    assert pickle.loads(pickle.dumps(look)) == look
    with pytest.raises(ch.UnreadableFile, match="nothing.json"):
        ch.Look.load(tmp_path / "nothing.json")


def test_automatic_parts_that_are_set_stay(chair, renderer):
    wished = {"output.exposure": 0.7, "lights": [{"name": "One", "position": [0, 0, 3]}]}
    look = ch.Look.auto(chair, renderer=renderer, settings=wished, quality="fast")
    assert look["output.exposure"] == 0.7
    assert (len(look.lights), look["lights.0.position"]) == (1, [0.0, 0.0, 3.0])


def test_presets_are_applied(chair, chair_look):
    names = [name for name in ch.presets() if name.startswith("light/")]
    assert names
    for name in names:
        assert chair_look.apply(name, chair) != chair_look
    with pytest.raises(ch.UnreadableFile):
        chair_look.apply("light/nothing", chair)
