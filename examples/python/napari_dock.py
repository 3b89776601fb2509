"""Shows a layer of napari and its lit picture side by side: python napari_dock.py [FILE]

Two sliders move the light, and a third turns the volume. Needs napari with a Qt backend.
"""

import sys

import napari
import numpy as np
from qtpy.QtCore import Qt
from qtpy.QtGui import QImage, QPixmap
from qtpy.QtWidgets import QLabel, QSlider, QVBoxLayout, QWidget

import chiaroscuro as ch

#: Width and height of the picture in pixels.
SIZE = (480, 360)


class LitPicture(QWidget):
    """Picture of an image layer with volumetric shadows, and sliders for its light and camera."""

    def __init__(self, layer: napari.layers.Image) -> None:
        super().__init__()
        # napari has array order and scale as here; its unit is that of the layer.
        self.volume = ch.Volume(layer.data, scale=layer.scale[-3:], name=layer.name)
        self.look = ch.Look.auto(self.volume)
        self.first_azimuth_deg = self.look["camera.azimuth_deg"]
        self.picture = QLabel()
        self.sliders = {
            name: self._slider(low, high, value)
            for name, low, high, value in [
                ("light from the left … right", -90, 90, round(self.look.lights[0].direction[0])),
                ("light from below … above", -80, 80, round(self.look.lights[0].direction[1])),
                ("turn", -180, 180, 0),
            ]
        }
        layout = QVBoxLayout(self)
        layout.addWidget(self.picture)
        for name, slider in self.sliders.items():
            layout.addWidget(QLabel(name))
            layout.addWidget(slider)
        self.draw()

    def _slider(self, low: int, high: int, value: int) -> QSlider:
        slider = QSlider(Qt.Orientation.Horizontal)
        slider.setRange(low, high)
        slider.setValue(value)
        slider.valueChanged.connect(self.draw)
        return slider

    def draw(self) -> None:
        """Draws the picture with the light and the camera of the sliders."""
        azimuth, elevation, turn = (slider.value() for slider in self.sliders.values())
        self.look["camera.azimuth_deg"] = self.first_azimuth_deg + turn
        self.look.lights[0].direction = (azimuth, elevation)
        picture = ch.render(self.volume, look=self.look, size=SIZE)
        height, width, _ = picture.shape
        image = QImage(picture.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888)
        self.picture.setPixmap(QPixmap.fromImage(image))


def main() -> None:
    source = sys.argv[1] if len(sys.argv) > 1 else "builtin:cells:96"
    viewer = napari.Viewer(ndisplay=3)
    layer = viewer.add_image(np.asarray(ch.Volume(source)), name=source)
    viewer.window.add_dock_widget(LitPicture(layer), name="Chiaroscuro", area="right")
    napari.run()


if __name__ == "__main__":
    main()
