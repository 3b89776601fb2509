"""Volumes are handed to the window of the program, and its look is read back."""

import json
import stat

import numpy as np
import pytest

import chiaroscuro as ch

#: Program in place of the window: it notes its arguments, and changes the session as a user would.
WINDOW = """#!/usr/bin/env python3
import json, pathlib, sys
pathlib.Path({note!r}).write_text(json.dumps(sys.argv[1:]))
session = pathlib.Path(sys.argv[sys.argv.index("--session") + 1])
look = json.loads(session.read_text())
look["shadows"]["strength"] = 0.25
session.write_text(json.dumps(look))
sys.exit({code})
"""


@pytest.fixture
def window(tmp_path, monkeypatch):
    def install(code=0):
        path = tmp_path / "window"
        path.write_text(WINDOW.format(note=str(tmp_path / "arguments.json"), code=code))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setenv("CHIAROSCURO_PROGRAM", str(path))
        return tmp_path / "arguments.json"

    return install


def test_the_look_of_the_window_comes_back(window, chair, chair_look):
    arguments = window()
    seen = []
    viewer = ch.Viewer(chair, chair_look, on_change=seen.append)
    assert json.loads(arguments.read_text())[0] == "builtin:chair:32"
    assert "--temporary" not in json.loads(arguments.read_text())
    assert viewer.look["shadows.strength"] == 0.25
    assert seen == [viewer.look]
    assert chair_look["shadows.strength"] != 0.25, "the look that was given stays"
    assert viewer.snapshot((32, 24)).shape == (24, 32, 4)
    assert not viewer.is_open


def test_arrays_are_shown_as_files(window, ball):
    arguments = window()
    volume = ch.Volume(ball, scale=(3, 2, 1), units="um", name="a/b?")
    viewer = ch.Viewer(volume, wait=False)
    viewer.wait()
    assert json.loads(arguments.read_text())[0].endswith("a-b-.nrrd")
    assert "--temporary" in json.loads(arguments.read_text()), "it is not listed among the recent files"


def test_volumes_are_saved(ball, tmp_path):
    volume = ch.Volume(ball, scale=(3, 2, 1), units="um", translate=(1, 2, 3))
    volume.save(tmp_path / "a.nrrd")
    again = ch.Volume(tmp_path / "a.nrrd")
    np.testing.assert_array_equal(np.asarray(again), ball)
    np.testing.assert_allclose(again.affine, volume.affine)
    with pytest.raises(ch.InvalidArgument, match="nrrd"):
        volume.save(tmp_path / "a.xyz")


def test_a_window_that_fails_says_so(window, chair, chair_look, monkeypatch):
    window(code=4)
    with pytest.raises(ch.Error, match="ended with an error: 4"):
        ch.Viewer(chair, chair_look)
    monkeypatch.delenv("CHIAROSCURO_PROGRAM")
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("sysconfig.get_path", lambda _: "nowhere")
    with pytest.raises(ch.Error, match="chiaroscuro-app"):
        ch.Viewer(chair, chair_look)
