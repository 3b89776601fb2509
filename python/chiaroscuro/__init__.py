"""Pictures of volume data with true volumetric shadows.

Arrays have the order of NumPy and scikit-image everywhere: (z, y, x), and so have scales and shapes.

    import chiaroscuro as ch

    picture = ch.render(array, scale=(2, 0.5, 0.5), units="um")  # (960, 1280, 4) uint8
"""

from . import _native
from ._errors import Error, ForkedProcess, InvalidArgument, NoAdapter, OutOfMemory, UnreadableFile
from ._look import Light, Look
from ._renderer import Renderer, render, render_frame, turntable
from ._viewer import Viewer
from ._volume import Scene, Volume, remove_table

__version__: str = _native.VERSION

__all__ = [
    "Error",
    "ForkedProcess",
    "InvalidArgument",
    "Light",
    "Look",
    "NoAdapter",
    "OutOfMemory",
    "Renderer",
    "Scene",
    "UnreadableFile",
    "Viewer",
    "Volume",
    "colormaps",
    "presets",
    "remove_table",
    "render",
    "render_frame",
    "turntable",
]


def colormaps() -> list[str]:
    """Returns the names of the colour maps."""
    return _native.color_map_names()


def presets() -> list[str]:
    """Returns the names of the built-in presets."""
    return _native.preset_names()
