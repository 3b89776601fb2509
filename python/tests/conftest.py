"""Objects that tests share."""

import os
import pathlib
import shutil

import numpy as np
import pytest

import chiaroscuro as ch


@pytest.fixture(scope="session")
def renderer():
    """Renderer of all tests that need no own one: pipelines are compiled once."""
    from chiaroscuro import _renderer

    return _renderer.default_renderer()


@pytest.fixture(scope="session")
def chair():
    return ch.Volume("builtin:chair:32")


@pytest.fixture(scope="session")
def chair_look(chair, renderer):
    return ch.Look.auto(chair, renderer=renderer)


@pytest.fixture(scope="session")
def program():
    """Path of the command-line program, whose pictures are compared with those of the package."""
    path = os.environ.get("CHIAROSCURO_PROGRAM") or shutil.which("chiaroscuro")
    advice = "the program `chiaroscuro` was not found; build it, and name it by CHIAROSCURO_PROGRAM"
    assert path, advice
    assert pathlib.Path(path).exists(), advice
    return path


@pytest.fixture
def ball():
    """Array of (12, 16, 20) voxels with a ball that is brighter below."""
    z, y, x = np.mgrid[-1:1:12j, -1:1:16j, -1:1:20j]
    inside = x**2 + y**2 + z**2 < 0.7
    return np.where(inside, 100 + 50 * y, 0).astype(np.uint16)
