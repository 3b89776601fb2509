"""The example for napari shows a layer and its lit picture."""

import importlib.util
import os
import pathlib

import numpy as np
import pytest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
napari = pytest.importorskip("napari")

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "python" / "napari_dock.py"


def test_the_dock_shows_the_lit_picture(ball):
    from qtpy.QtWidgets import QApplication

    application = QApplication.instance() or QApplication([])
    specification = importlib.util.spec_from_file_location("napari_dock", EXAMPLE)
    example = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(example)
    dock = example.LitPicture(napari.layers.Image(ball, scale=(2, 1, 1), name="ball"))

    def shown():
        image = dock.picture.pixmap().toImage()
        return np.frombuffer(image.constBits().asstring(image.sizeInBytes()), np.uint8)

    before = shown().copy()
    assert before.std() > 5
    dock.sliders["light from the left … right"].setValue(80)
    application.processEvents()
    assert not np.array_equal(shown(), before)
