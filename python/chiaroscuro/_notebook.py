"""Picture in a notebook, turned and lit by the pointer. Needs the extra ``notebook``: jupyter_rfb and ipywidgets."""

from __future__ import annotations

import asyncio
import math
import time
from typing import TYPE_CHECKING, Any

import ipywidgets
import jupyter_rfb
import numpy as np

from ._renderer import Renderer

if TYPE_CHECKING:
    from ._viewer import Viewer

#: Degrees by which a drag of one pixel turns the volume, as in the window.
DEGREES_PER_PIXEL = 0.4

#: Factor of the camera's distance for a notch of the wheel, which browsers report as 100 pixels.
ZOOM_PER_NOTCH = 1.1
PIXELS_PER_NOTCH = 100.0

#: Nearest and farthest camera, as in the window.
DISTANCES = (0.05, 100.0)

#: Radius of the sphere on which the discs of lights lie, as a share of the shorter edge of the picture.
LIGHT_SPHERE = 0.42

#: Radius of a light's disc, and of the circle in which the pointer takes it, in pixels of the screen.
DISC_RADIUS, GRAB_RADIUS = 7.0, 12.0

#: Seconds without a change after which the whole picture is drawn: longer than between two events of a slow drag.
REST_S = 0.2

#: Seconds that a preview should take: ten pictures a second follow the hand. It becomes coarser or finer beyond these.
SLOW_S, QUICK_S = 0.1, 0.03

#: Coarsest preview, in pixels of the picture along the edge of one of the preview.
COARSEST = 4


class PictureWidget(jupyter_rfb.RemoteFrameBuffer):
    """Picture of a viewer: a drag turns it, a drag of a disc moves that light, the wheel moves the camera.

    While something moves, previews are drawn with fewer pixels; the whole picture follows when nothing moves.
    """

    def __init__(self, viewer: Viewer, renderer: Renderer, size: tuple[int, int]) -> None:
        super().__init__()
        self.css_width, self.css_height = (f"{edge}px" for edge in size)
        self.cursor = "grab"
        self._viewer, self._renderer = viewer, renderer
        #: Width and height in pixels of the screen, and how many pixels of the picture one of them has.
        self._size, self._ratio = size, 1.0
        self._pointer: tuple[float, float] | None = None
        #: Light that is dragged: its index, and 1 in front of the volume or −1 behind it.
        self._light: tuple[int, float] | None = None
        self._coarseness = 2
        self._moves = False
        self._rest: asyncio.TimerHandle | None = None
        #: Time of the last change or of the end of the last preview, in seconds.
        self._last_s = 0.0
        #: Number of previews, and seconds that they took together.
        self.previews, self.preview_s = 0, 0.0

    # --- Events -----------------------------------------------------------------------------------

    def handle_event(self, event: dict[str, Any]) -> None:
        """Turns, lights or moves by an event of the browser."""
        kind = event.get("event_type", event.get("type"))
        if kind == "resize":
            self._size = (max(1, round(event["width"])), max(1, round(event["height"])))
            self._ratio = float(event.get("pixel_ratio", event.get("ratio", 1.0)))
        elif kind == "pointer_down" and event.get("button") == 1:
            self._pointer = (event["x"], event["y"])
            self._light = self._light_at(*self._pointer)
        elif kind == "pointer_move" and self._pointer is not None:
            self._drag(event["x"], event["y"])
        elif kind == "pointer_up":
            self._pointer = self._light = None
        elif kind == "wheel":
            self._zoom(ZOOM_PER_NOTCH ** (event["dy"] / PIXELS_PER_NOTCH))

    def _drag(self, x: float, y: float) -> None:
        look, before = self._viewer.look, self._pointer
        if before is None or before == (x, y):
            return
        if self._light is not None:
            index, side = self._light
            look.lights[index].direction = self._direction_at(x, y, side)
        else:
            camera = look["camera"]
            camera["azimuth_deg"] = (camera["azimuth_deg"] - (x - before[0]) * DEGREES_PER_PIXEL) % 360.0
            elevation = camera["elevation_deg"] + (y - before[1]) * DEGREES_PER_PIXEL
            camera["elevation_deg"] = (elevation + 180.0) % 360.0 - 180.0
            look["camera"] = camera
        self._pointer = (x, y)
        self.note_change()

    def _zoom(self, factor: float) -> None:
        look = self._viewer.look
        look["camera.distance"] = min(max(look["camera.distance"] * factor, DISTANCES[0]), DISTANCES[1])
        self.note_change()

    def note_change(self) -> None:
        """Draws previews until nothing has changed for a moment, and then the whole picture."""
        self._moves = True
        self._last_s = time.monotonic()
        if self._rest is None:
            self._rest = asyncio.get_event_loop().call_later(REST_S, self._come_to_rest)
        self.request_draw()

    def _come_to_rest(self) -> None:
        # While a preview is drawn no events are seen, which come after it.
        left = self._last_s + REST_S - time.monotonic()
        if left > 0.0:
            self._rest = asyncio.get_event_loop().call_later(left, self._come_to_rest)
            return
        self._moves, self._rest = False, None
        self._viewer.note_look()
        self.request_draw()

    # --- Lights -----------------------------------------------------------------------------------

    def disc(self, index: int) -> tuple[float, float, float]:
        """Returns the place of a light's disc in pixels from the top left, and its side: 1 in front, −1 behind."""
        azimuth, elevation = (math.radians(angle) for angle in self._viewer.look.lights[index].direction)
        width, height = self._size
        radius = LIGHT_SPHERE * min(width, height)
        level = math.cos(elevation)
        x = width / 2 + radius * level * math.sin(azimuth)
        return x, height / 2 - radius * math.sin(elevation), math.copysign(1.0, level * math.cos(azimuth))

    def _light_at(self, x: float, y: float) -> tuple[int, float] | None:
        """Returns the light whose disc is nearest to a place, if it is near enough."""
        near = []
        for index, light in enumerate(self._viewer.look.lights):
            disc_x, disc_y, side = self.disc(index)
            near.append((math.hypot(disc_x - x, disc_y - y) if light.on else math.inf, index, side))
        distance, index, side = min(near, default=(math.inf, 0, 1.0))
        return (index, side) if distance <= GRAB_RADIUS else None

    def _direction_at(self, x: float, y: float, side: float) -> tuple[float, float]:
        """Returns azimuth and elevation in degrees of the place on the sphere of lights that is under the pointer."""
        width, height = self._size
        radius = LIGHT_SPHERE * min(width, height)
        right, up = (x - width / 2) / radius, (height / 2 - y) / radius
        beyond = max(1.0, math.hypot(right, up))
        right, up = right / beyond, up / beyond
        toward = side * math.sqrt(max(0.0, 1.0 - right**2 - up**2))
        return math.degrees(math.atan2(right, toward)), math.degrees(math.asin(up))

    # --- Pictures ---------------------------------------------------------------------------------

    def get_frame(self) -> np.ndarray:
        """Draws the picture, or a preview, with the discs of the lights: an array of shape (height, width, 3)."""
        width, height = (max(1, round(edge * self._ratio)) for edge in self._size)
        look = self._viewer.look
        if not self._moves:
            picture = self._renderer.render(self._viewer.volume, look, size=(width, height))
            return self._with_discs(picture, self._ratio)
        coarseness = self._coarseness
        began = time.perf_counter()
        size = (max(1, width // coarseness), max(1, height // coarseness))
        # Reading parts of finer levels would hold the hand up.
        preview = look.with_(settings={"output.antialiasing": 1, "sampling.finer_levels": False})
        picture = self._renderer.render(self._viewer.volume, preview, size=size)
        took = time.perf_counter() - began
        self._last_s = time.monotonic()
        self.previews, self.preview_s = self.previews + 1, self.preview_s + took
        if took > SLOW_S:
            self._coarseness = min(coarseness + 1, COARSEST)
        elif took < QUICK_S:
            self._coarseness = max(coarseness - 1, 1)
        return self._with_discs(picture, self._ratio / coarseness)

    def _with_discs(self, picture: np.ndarray, scale: float) -> np.ndarray:
        """Returns a picture with a disc for each light, filled in front of the volume and hollow behind it."""
        shown = np.ascontiguousarray(picture[..., :3])
        rows, columns = np.mgrid[: shown.shape[0], : shown.shape[1]]
        for index, light in enumerate(self._viewer.look.lights):
            if not light.on:
                continue
            x, y, side = self.disc(index)
            distance = np.hypot(columns + 0.5 - x * scale, rows + 0.5 - y * scale) / scale
            # Edges are one pixel of the screen wide.
            ring = np.clip(1.5 - abs(distance - DISC_RADIUS), 0, 1)[..., None]
            inside = np.clip(DISC_RADIUS + 0.5 - distance, 0, 1)[..., None] * (side > 0)
            color = 255 * np.asarray(light.color)
            shown = shown * (1 - inside) + color * inside
            shown = shown * (1 - ring) + 20 * ring
        return shown.astype(np.uint8)


def controls(viewer: Viewer, picture: PictureWidget) -> ipywidgets.Widget:
    """Returns the picture above sliders for exposure and strength of shadows."""

    def slider(name: str, setting: str, high: float) -> ipywidgets.FloatSlider:
        found = ipywidgets.FloatSlider(
            value=viewer.look[setting], min=0.0, max=high, step=high / 100, description=name, readout_format=".2f"
        )

        def change(event: dict[str, Any]) -> None:
            viewer.look[setting] = event["new"]
            picture.note_change()

        found.observe(change, names="value")
        return found

    # Twice the exposure that was found is a picture that is clipped; at 1, shadows are those of the material.
    exposure = slider("Exposure", "output.exposure", 2 * max(viewer.look["output.exposure"], 0.5))
    return ipywidgets.VBox([picture, ipywidgets.HBox([exposure, slider("Shadows", "shadows.strength", 1.0)])])
