"""Looks: all settings of a picture."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._errors import InvalidArgument

if TYPE_CHECKING:
    from ._renderer import Renderer
    from ._volume import Volume

#: Rules by which values along a ray become a colour.
RENDERINGS = ("matter", "surface", "maximum", "minimum", "mean")

#: Other names of them, as other packages have them.
RENDERING_ALIASES = {"mip": "maximum", "minip": "minimum", "average": "mean", "iso": "surface", "translucent": "matter"}

#: Opacity curves by name: pairs of a share of the shown range and an opacity.
OPACITY_CURVES = {
    "ramp": ((0.0, 0.0), (1.0, 1.0)),
    "linear": ((0.0, 0.0), (1.0, 1.0)),
    "ramp_r": ((0.0, 1.0), (1.0, 0.0)),
    # A smooth step, in pieces that differ from it by less than a hundredth.
    "sigmoid": tuple((t / 16, (t / 16) ** 2 * (3 - t / 8)) for t in range(17)),
}

#: Number of places at which a function of opacity is read.
FUNCTION_SAMPLES = 33


class Light:
    """Light of a look: reading and writing its attributes reads and writes the settings of the look."""

    def __init__(self, look: Look, index: int) -> None:
        self._look, self._index = look, index

    def _get(self, name: str) -> Any:
        return self._look[f"lights.{self._index}.{name}"]

    def _set(self, name: str, value: Any) -> None:
        self._look[f"lights.{self._index}.{name}"] = value

    @property
    def direction(self) -> tuple[float, float]:
        """Degrees to the right of the viewer's line of sight, and above it: (−50, 25) is left, from above."""
        return self._look._native.light_direction(self._index)

    @direction.setter
    def direction(self, azimuth_elevation_deg: Sequence[float]) -> None:
        azimuth, elevation = azimuth_elevation_deg
        self._look._native = self._look._native.with_light_direction(self._index, float(azimuth), float(elevation))

    @property
    def kind(self) -> str:
        """``"parallel"``, as from the sun, or ``"perspective"``, from a point nearby."""
        return self._get("kind")

    @kind.setter
    def kind(self, kind: str) -> None:
        self._set("kind", kind)

    @property
    def size(self) -> float:
        """Size of the light, in units of the scene; 0 casts sharp shadows."""
        return self._get("size")

    @size.setter
    def size(self, size: float) -> None:
        self._set("size", size)

    @property
    def color(self) -> tuple[float, float, float]:
        """Colour as sRGB, 0 … 1."""
        return tuple(self._get("color"))

    @color.setter
    def color(self, color: Sequence[float]) -> None:
        self._set("color", [float(channel) for channel in color])

    @property
    def intensity(self) -> float:
        """Factor for the light."""
        return self._get("intensity")

    @intensity.setter
    def intensity(self, intensity: float) -> None:
        self._set("intensity", intensity)

    @property
    def on(self) -> bool:
        """True if the light is switched on."""
        return self._get("on")

    @on.setter
    def on(self, on: bool) -> None:
        self._set("on", bool(on))

    @property
    def casts_shadows(self) -> bool:
        """True if material attenuates the light."""
        return self._get("casts_shadows")

    @casts_shadows.setter
    def casts_shadows(self, casts_shadows: bool) -> None:
        self._set("casts_shadows", bool(casts_shadows))

    def __repr__(self) -> str:
        azimuth, elevation = self.direction
        return f"<chiaroscuro.Light {self._index}: {self.kind}, direction ({azimuth:.1f}, {elevation:.1f})°>"


class Lights(Sequence[Light]):
    """Lights of a look."""

    def __init__(self, look: Look) -> None:
        self._look = look

    def __len__(self) -> int:
        return self._look._native.light_count

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [Light(self._look, at) for at in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(f"there are {len(self)} lights, and no light {index}")
        return Light(self._look, index % len(self))

    def __iter__(self) -> Iterator[Light]:
        return (Light(self._look, index) for index in range(len(self)))


class Look:
    """All settings of a picture: camera, lights, transfer functions, shadows, quality.

    A look is made from a volume by `Look.auto`, or read from a file by `Look.load`. Single settings are read and
    written by the names that the command line's ``--set`` has.
    """

    def __init__(self, native: _native.NativeLook) -> None:
        self._native = native

    @classmethod
    def auto(
        cls,
        volume: Volume,
        *,
        renderer: Renderer | None = None,
        preset: str | os.PathLike[str] | None = None,
        **changes: Any,
    ) -> Look:
        """Returns the look that the program finds for a volume, with changes that are made before lights, floor and
        brightness are found.

        Args:
            volume: the volume.
            renderer: renderer that draws the small pictures by which lights are compared; by default a common one.
            preset: built-in preset, JSON file or exported picture that is applied first; see `presets`.
            **changes: as for `with_`.

        >>> from chiaroscuro import Volume
        >>> look = Look.auto(Volume("builtin:chair:16"), settings={"lights.0.intensity": 1.0})
        >>> look["lights.0.intensity"]
        1.0
        """
        from ._renderer import default_renderer

        first = _native.NativeLook.automatic(volume._native, None if volume._kind == "auto" else volume._kind)
        look = cls(first)
        for index, blend in enumerate(getattr(volume, "_blends", ()), start=1):
            look[f"layers.{index}.blend"] = blend
        if preset is not None:
            look._native = look._native.with_look_of(os.fspath(preset), volume._native)
        look._change(volume, **changes)
        native = look._native.with_floor_laid(first, volume._native)
        renderer = renderer if renderer is not None else default_renderer()
        return cls(renderer._native.finish_look(volume._native, native))

    def with_(self, volume: Volume | None = None, **changes: Any) -> Look:
        """Returns a copy with changes; lights and brightness stay.

        Args:
            volume: volume whose range of values names of opacity curves and `contrast_limits` refer to.
            colormap: name of a colour map, see `colormaps`; ``_r`` at its end reverses it.
            contrast_limits: values shown at the ends of the colours and opacities.
            clim: another name of ``contrast_limits``.
            opacity: ``"ramp"``, ``"sigmoid"`` or ``"ramp_r"``; pairs of value and opacity; or a function from an array
                of values to opacities of 0 … 1 for a typical length.
            rendering: ``"matter"``, ``"surface"``, ``"maximum"``, ``"minimum"`` or ``"mean"``.
            isovalue: value of a surface.
            quality: ``"fast"``, ``"standard"`` or ``"fine"``.
            settings: further settings by their names, such as ``{"shadows.strength": 0.5}``.
        """
        look = Look(self._native)
        look._change(volume, **changes)
        return look

    def _change(
        self,
        volume: Volume | None,
        *,
        colormap: str | None = None,
        contrast_limits: Sequence[float] | None = None,
        clim: Sequence[float] | None = None,
        opacity: str | Sequence[Sequence[float]] | Callable[[np.ndarray], Any] | None = None,
        rendering: str | None = None,
        isovalue: float | None = None,
        quality: str | None = None,
        settings: dict[str, Any] | None = None,
    ) -> None:
        if quality is not None:
            self._native = self._native.with_quality(quality)
        limits = contrast_limits if contrast_limits is not None else clim
        if limits is not None:
            low, high = (float(limit) for limit in limits)
            if not low < high:
                raise InvalidArgument(f"contrast_limits: expected two ascending values, found {(low, high)}")
            self._native = self._native.with_range(_native_of(volume, "contrast_limits"), low, high)
        if opacity is not None:
            points = _opacity_points(opacity, lambda: self._native.shown_range(_native_of(volume, "opacity")))
            self._native = self._native.with_opacities(0, points)
        if colormap is not None:
            is_reversed = colormap.endswith("_r")
            self._native = self._native.with_color_map(0, colormap.removesuffix("_r"), is_reversed)
        if rendering is not None:
            kind = RENDERING_ALIASES.get(rendering, rendering)
            if kind not in RENDERINGS:
                raise InvalidArgument(f"rendering: expected one of {', '.join(RENDERINGS)}, found {rendering!r}")
            self["mode.kind"] = kind
        if isovalue is not None:
            self["mode.isovalue"] = float(isovalue)
        for name, value in (settings or {}).items():
            self[name] = value

    def apply(self, preset: str | os.PathLike[str], volume: Volume | None = None) -> Look:
        """Returns a copy with the settings of a built-in preset, a JSON file or an exported picture."""
        native = volume._native if volume is not None else None
        return Look(self._native.with_look_of(os.fspath(preset), native))

    @classmethod
    def load(cls, path: str | os.PathLike[str], volume: Volume | None = None) -> Look:
        """Reads a look from a JSON file that window, program or `save` wrote, or from an exported picture.

        Raises:
            UnreadableFile: the file is missing, or carries no settings.
        """
        return cls(_native.NativeLook.default()).apply(path, volume)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes all settings to a JSON file: ``chiaroscuro render VOLUME --session FILE`` draws the same picture."""
        self._native.save(os.fspath(path))

    @property
    def lights(self) -> Lights:
        """Lights, whose attributes may be changed."""
        return Lights(self)

    def __getitem__(self, name: str) -> Any:
        value = self._native.value(name)
        if value is None:
            raise KeyError(f"there is no setting {name!r}; look.to_dict() shows all of them")
        return json.loads(value)

    def __setitem__(self, name: str, value: Any) -> None:
        self._native = self._native.with_value(name, json.dumps(_plain(value)))

    def to_dict(self) -> dict[str, Any]:
        """Returns all settings."""
        return json.loads(self._native.to_json())

    def copy(self) -> Look:
        """Returns a copy, whose changes leave this look as it is."""
        return Look(self._native)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Look) and self._native == other._native

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _from_json, (self._native.to_json(),)

    def __repr__(self) -> str:
        return (
            f"<chiaroscuro.Look: {len(self.lights)} lights, {self['mode.kind']}, shadows {self['shadows.algorithm']}>"
        )


def _from_json(text: str) -> Look:
    return Look(_native.NativeLook.from_json(text))


def _native_of(volume: Volume | None, argument: str) -> _native.NativeVolume:
    if volume is None:
        raise InvalidArgument(f"{argument} refers to the values of a volume; give it: look.with_(volume, {argument}=…)")
    return volume._native


def _opacity_points(opacity: Any, shown_range: Callable[[], tuple[float, float]]) -> list[tuple[float, float]]:
    """Returns pairs of value and opacity."""
    if isinstance(opacity, str):
        if opacity not in OPACITY_CURVES:
            raise InvalidArgument(f"opacity: expected one of {', '.join(OPACITY_CURVES)}, found {opacity!r}")
        low, high = shown_range()
        return [(low + share * (high - low), at) for share, at in OPACITY_CURVES[opacity]]
    if callable(opacity):
        low, high = shown_range()
        values = np.linspace(low, high, FUNCTION_SAMPLES)
        found = np.broadcast_to(np.asarray(opacity(values), dtype=float), values.shape)
        return list(zip(values.tolist(), found.tolist(), strict=True))
    points = np.asarray(opacity, dtype=float)
    if points.ndim == 1 and points.size > 1:
        low, high = shown_range()
        points = np.column_stack([np.linspace(low, high, points.size), points])
    if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
        raise InvalidArgument("opacity: expected a name, pairs of value and opacity, or a function")
    return [(float(value), float(at)) for value, at in points]


def _plain(value: Any) -> Any:
    """Returns numbers and arrays of NumPy as numbers and lists of Python."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    return value
