"""Renderers: pictures, light volumes and facts about what is seen."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from . import _native
from ._errors import InvalidArgument
from ._look import Look
from ._volume import Volume

#: Options that belong to a volume, and not to its look.
VOLUME_OPTIONS = (
    "scale", "spacing", "translate", "units", "name", "kind", "channel_axis", "reduce", "channel", "frame",
    "component", "series", "array", "level",
)  # fmt: skip


class Renderer:
    """Graphics device, with the light volumes that it keeps between pictures.

    Pictures of one volume with one renderer share everything that did not change: after a turn of the camera no light
    is computed. Calls from several threads wait for each other; other Python threads run meanwhile.

    Args:
        adapter: number of the graphics adapter, counted from the fastest, which is 0.
        memory: memory for finer resolution levels than the one that a volume has in memory, in bytes or as a text such
            as ``"2 GiB"``. Pictures show the level that their pixels call for, and read what is missing in parts that
            fit. By default at most 1 GiB and a quarter of what is free, and a level that was named
            (``Volume(path, level=2)``) is shown alone; with ``memory`` finer ones are shown as well.

    Raises:
        NoAdapter: there is none; the message says what to install.
        InvalidArgument: memory is no size.

    >>> with Renderer() as renderer:
    ...     renderer.render(Volume("builtin:chair:16"), size=(8, 6)).shape
    (6, 8, 4)
    """

    def __init__(self, adapter: int = 0, *, memory: int | str | None = None) -> None:
        self._native = _native.NativeRenderer(adapter, None if memory is None else _bytes(memory))

    @property
    def adapter(self) -> str:
        """Name and driver of the graphics adapter."""
        return self._native.adapter

    def close(self) -> None:
        """Frees the device and everything on it."""
        self._native.close()

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def render(
        self,
        volume: Volume,
        look: Look | None = None,
        *,
        size: tuple[int, int] = (1280, 960),
        samples: int = 1,
        transparent: bool = False,
        dtype: str = "uint8",
    ) -> np.ndarray:
        """Draws a picture.

        Args:
            volume: the volume.
            look: all settings; by default `Look.auto`.
            size: width and height in pixels.
            samples: samples along the edge of a pixel, 1 … 4.
            transparent: leaves the background out (straight alpha; premultiplied for linear light).
            dtype: ``"uint8"`` for sRGB, ``"float32"`` for linear light before tone mapping.

        Returns:
            Array of shape (height, width, 4), from the top row down.

        Raises:
            InvalidArgument: size, samples or dtype are out of range.
            OutOfMemory: the device has too little memory.
        """
        if look is None:
            look = Look.auto(volume, renderer=self)
        name = np.dtype(dtype).name
        if name not in ("uint8", "float32"):
            raise InvalidArgument(f"dtype: expected uint8 or float32, found {name}")
        request = {
            "size": _size(size),
            "samples": _samples(samples),
            "is_transparent": bool(transparent),
            "is_linear": name == "float32",
        }
        return self._native.render(volume._native, look._native, request)

    def light_volume(self, volume: Volume, look: Look, light: int = 0) -> np.ndarray:
        """Returns the share of a light, 0 … 1, that reaches each voxel of its light volume.

        Returns:
            Array of shape (z, y, x) and type ``float32``. The light volume may be coarser than the volume
            (``look["shadows.resolution"]``).
        """
        return self._native.light_volume(volume._native, look._native, int(light))

    def pick(
        self, volume: Volume, look: Look, pixel: tuple[float, float], size: tuple[int, int] = (1280, 960)
    ) -> dict[str, Any] | None:
        """Returns facts about the material that is first seen at a pixel, or None if there is none.

        Args:
            pixel: column and row, counted from the top left.
            size: width and height of the picture.

        Returns:
            ``value``, ``opacity``, ``index`` and ``position_mm`` (z, y, x), ``layer``, ``lights`` (the share of each
            light that arrives) and ``sky``.
        """
        column, row = pixel
        return self._native.pick(volume._native, look._native, (float(column), float(row)), _size(size))

    def stats(self) -> dict[str, Any]:
        """Returns how often light volumes were filled, times in milliseconds, and memory in bytes."""
        return self._native.stats()

    def __repr__(self) -> str:
        return f"<chiaroscuro.Renderer on {self.adapter}>"


def _size(size: Sequence[int]) -> tuple[int, int]:
    try:
        width, height = (int(edge) for edge in size)
    except (TypeError, ValueError):
        width, height = -1, -1
    if width < 1 or height < 1 or max(width, height) > 2**31:
        raise InvalidArgument(f"size: expected (width, height) in pixels, found {size!r}")
    return width, height


def _bytes(memory: int | str) -> int:
    """Returns a size in bytes, of a number or of a text with a unit."""
    units = {"": 1, "b": 1, "k": 2**10, "kib": 2**10, "m": 2**20, "mib": 2**20, "g": 2**30, "gib": 2**30}
    parts = re.fullmatch(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([a-z]*)\s*", str(memory).lower())
    size = float(parts[1]) * units.get(parts[2], 0) if parts else 0.0
    if not 1 <= size < 2**63:
        raise InvalidArgument(f'memory: expected bytes, or a text such as "512 MiB" or "2 GiB", found {memory!r}')
    return int(size)


def _samples(samples: int) -> int:
    if int(samples) < 1:
        raise InvalidArgument(f"samples: expected 1 to 4 samples along the edge of a pixel, found {samples}")
    return int(samples)


_default: Renderer | None = None
_default_lock = threading.Lock()


def default_renderer() -> Renderer:
    """Returns the renderer of functions that are given none, which is opened once."""
    global _default
    with _default_lock:
        if _default is None:
            _default = Renderer()
        return _default


def _volume_of(data: Any, options: dict[str, Any]) -> Volume:
    """Returns a volume, with the options that belong to it removed from the others."""
    own = {name: options.pop(name) for name in VOLUME_OPTIONS if name in options}
    if isinstance(data, Volume):
        if own:
            raise InvalidArgument(f"{', '.join(own)}: the volume has these already; give them to Volume()")
        return data
    return Volume(data, **own)


def _look_of(volume: Volume, look: Look | None, renderer: Renderer, options: dict[str, Any]) -> Look:
    """Returns a look with the options that are left, or the automatic one with them."""
    if look is None:
        return Look.auto(volume, renderer=renderer, **options)
    return look.with_(volume, **options) if options else look


def render(
    data: Any,
    *,
    look: Look | None = None,
    size: tuple[int, int] = (1280, 960),
    samples: int = 1,
    transparent: bool = False,
    dtype: str = "uint8",
    renderer: Renderer | None = None,
    **options: Any,
) -> np.ndarray:
    """Draws a picture of an array or a file in one line.

    Args:
        data: what a `Volume` is made of, or a `Volume`.
        look: all settings; by default those of `Look.auto`, with changes among the options.
        size, samples, transparent, dtype: as for `Renderer.render`.
        renderer: renderer to draw with; by default a common one.
        **options: arguments of `Volume` (``scale=``, ``units=`` …) and of `Look.auto` (``colormap=``, ``preset=`` …).

    Returns:
        Array of shape (height, width, 4).

    >>> import numpy as np
    >>> ball = np.hypot(*np.ogrid[-1:1:16j, -1:1:16j, -1:1:16j][:2]) < 0.7
    >>> render(np.broadcast_to(ball, (16, 16, 16)), size=(32, 24)).shape
    (24, 32, 4)
    """
    volume = _volume_of(data, options)
    renderer = renderer if renderer is not None else default_renderer()
    look = _look_of(volume, look, renderer, options)
    return renderer.render(volume, look, size=size, samples=samples, transparent=transparent, dtype=dtype)


def turntable(
    data: Any,
    look: Look | None = None,
    *,
    frames: int = 72,
    light: int | None = None,
    size: tuple[int, int] = (640, 480),
    samples: int = 1,
    transparent: bool = False,
    renderer: Renderer | None = None,
    **options: Any,
) -> Iterator[np.ndarray]:
    """Yields the pictures of one turn of the camera around the volume, or of a light, counted from 0.

    The last picture is the one before the first, so that a film of them repeats without a jump.
    """
    volume = _volume_of(data, options)
    renderer = renderer if renderer is not None else default_renderer()
    look = _look_of(volume, look, renderer, options)
    for frame in range(int(frames)):
        turned = Look(look._native.turned(frame / frames, light))
        yield renderer.render(volume, turned, size=size, samples=samples, transparent=transparent)


#: Last volume of `render_frame` in this process, with the arguments that it was opened with.
_frame_volume: tuple[Any, Volume] | None = None
_frame_lock = threading.Lock()


def render_frame(
    frame: int,
    volume: str,
    look: Look,
    *,
    frames: int = 72,
    light: int | None = None,
    size: tuple[int, int] = (640, 480),
    samples: int = 1,
    transparent: bool = False,
    **options: Any,
) -> np.ndarray:
    """Draws one picture of a turn, for programs that draw the others elsewhere: the result follows from the arguments.

    Args:
        frame: number of the picture, 0 … ``frames`` − 1.
        volume: path of a file, which is read once in each process.
        look: all settings, of which the turn begins; see `Look.auto`.
        **options: arguments of `Volume`.
    """
    global _frame_volume
    key = (volume, tuple(sorted(options.items())))
    with _frame_lock:
        if _frame_volume is None or _frame_volume[0] != key:
            _frame_volume = (key, Volume(volume, **options))
        opened = _frame_volume[1]
    turned = Look(look._native.turned(frame / frames, light))
    return default_renderer().render(opened, turned, size=size, samples=samples, transparent=transparent)
