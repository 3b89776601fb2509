"""Volumes: voxels with their spacing, from arrays, files and built-in scenes."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _arrays, _native
from ._errors import InvalidArgument

#: Kinds of data, which decide the first look.
KINDS = ("auto", "scalar", "ct", "dark-on-bright", "signed", "mask", "labels")

#: Most fields that are shown together.
MAX_FIELDS = 4


class Volume:
    """Voxels on a grid, with their spacing and unit.

    Args:
        data: an array of shape (z, y, x) (NumPy, Dask, Zarr, xarray, a tensor of torch on the CPU), an image of
            SimpleITK, nibabel or VTK, the path of a file or folder, or a built-in volume such as ``"builtin:chair"``.
        scale: distance between voxels along z, y, x in ``units``, or one number; wins over what the object says.
        spacing: another name of ``scale``.
        translate: position of the first voxel along z, y, x in ``units``.
        units: ``"nm"``, ``"um"``, ``"mm"``, ``"cm"`` or ``"m"``; millimetres if there is a scale without unit.
        name: name that is shown; by default that of the object or file.
        kind: kind of data for the first look, one of ``auto``, ``scalar``, ``ct``, ``dark-on-bright``, ``signed``,
            ``mask``, ``labels``.
        channel_axis: axis of an array along which up to four channels lie, which are shown together.
        reduce: edge of blocks of voxels that are averaged while a file is read.
        channel, frame, component, series, array, level: choice among what a file holds, as on the command line.

    Raises:
        UnreadableFile: the file is missing, damaged or of an unknown kind.
        InvalidArgument: the array has no three dimensions, or an argument a wrong value.
        OutOfMemory: the voxels do not fit into memory.

    >>> import numpy as np
    >>> Volume(np.zeros((4, 5, 6), np.uint8), scale=(2, 0.5, 0.5), units="um").shape
    (4, 5, 6)
    """

    def __init__(
        self,
        data: Any,
        *,
        scale: float | Sequence[float] | None = None,
        spacing: float | Sequence[float] | None = None,
        translate: Sequence[float] | None = None,
        units: str | None = None,
        name: str | None = None,
        kind: str = "auto",
        channel_axis: int | None = None,
        reduce: int | None = None,
        channel: int | None = None,
        frame: int | None = None,
        component: int | None = None,
        series: str | None = None,
        array: str | None = None,
        level: int | str | None = None,
    ) -> None:
        if kind not in KINDS:
            raise InvalidArgument(f"kind: expected one of {', '.join(KINDS)}, found {kind!r}")
        if scale is not None and spacing is not None:
            raise InvalidArgument("scale and spacing are the same; give one of them")
        self._kind = kind
        self._source: tuple[str, dict[str, Any]] | None = None
        scale = scale if scale is not None else spacing
        if isinstance(data, (str, os.PathLike)):
            if scale is not None or translate is not None or units is not None or channel_axis is not None:
                raise InvalidArgument("scale, translate, units and channel_axis belong to arrays; a file has its own")
            selection = {
                "reduce": reduce, "channel": channel, "frame": frame, "component": component, "series": series,
                "array": array, "level": None if level is None else str(level),
            }  # fmt: skip
            source = os.fspath(data)
            self._native = _native.NativeVolume.open(source, selection)
            self._source = (source, selection)
            return
        image = _arrays.image_of(data)
        arrays = [image.array]
        if channel_axis is not None:
            arrays = _channels(image.array, channel_axis)
        facts = {"scale": scale, "translate": translate, "units": units, "name": name, "are_labels": kind == "labels"}
        volumes = [_from_array(image, array, facts) for array in arrays]
        for other in volumes[1:]:
            volumes[0] = volumes[0].with_field(other)
        self._native = volumes[0]

    @classmethod
    def _wrap(cls, native: _native.NativeVolume, kind: str) -> Volume:
        volume = Volume.__new__(Volume)
        volume._native, volume._kind, volume._source = native, kind, None
        return volume

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of voxels along z, y, x."""
        return self._native.shape

    @property
    def dtype(self) -> np.dtype:
        """Number type of the voxels."""
        return np.dtype(self._native.dtype)

    @property
    def spacing_mm(self) -> tuple[float, float, float]:
        """Distance between voxels along z, y, x in millimetres; in voxels if it is unknown."""
        return self._native.spacing_mm

    @property
    def affine(self) -> np.ndarray:
        """Affine map of shape (4, 4) from voxel indices (x, y, z) to millimetres, as nibabel has it."""
        return np.vstack([self._native.world_from_index, [0.0, 0.0, 0.0, 1.0]])

    @property
    def name(self) -> str:
        """Name of the volume: that of its file, array or built-in scene."""
        return self._native.name

    @property
    def kind(self) -> str:
        """Kind of data, which decides the first look: the one that was given, or the detected one."""
        return self._native.kind if self._kind == "auto" else self._kind

    @property
    def value_range(self) -> tuple[float, float]:
        """Smallest and largest finite value."""
        return self._native.value_range

    @property
    def field_count(self) -> int:
        """Number of fields that are shown together: channels, labels, overlays."""
        return self._native.field_count

    @property
    def remarks(self) -> list[str]:
        """Remarks about how the file was read."""
        return self._native.remarks

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the voxels of the first field as NRRD, NIfTI or TIFF, by the ending of the name."""
        self._native.save(os.fspath(path))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        """Copies the voxels of the first field, of shape (z, y, x)."""
        if copy is False:
            raise ValueError("the voxels are always copied; leave copy=False out")
        array = self._native.voxels().reshape(self.shape)
        return array if dtype is None else array.astype(dtype, copy=False)

    def __repr__(self) -> str:
        z, y, x = self.shape
        spacing: tuple[float, ...] = self.spacing_mm
        unit = "mm"
        if self._native.has_unknown_scale:
            unit = "voxels"
        elif max(spacing) < 0.1:
            spacing, unit = tuple(1e3 * step for step in spacing), "um"
        steps = " × ".join(f"{step:.4g}" for step in spacing)
        low, high = self.value_range
        fields = f", {self.field_count} fields" if self.field_count > 1 else ""
        return (
            f"<chiaroscuro.Volume {self.name!r}: {z} × {y} × {x} {self.dtype}{fields}, spacing {steps} {unit} "
            f"(z, y, x), values {low:g} … {high:g}, {self.kind}>"
        )

    def _repr_png_(self) -> bytes:
        from ._renderer import default_renderer

        return _native.encode_png(default_renderer().render(self, size=(480, 360)))

    def __reduce__(self) -> tuple[Any, ...]:
        if self._source is None:
            raise TypeError("a volume of an array is not pickled; send the array, or the path of a file")
        source, selection = self._source
        return _reopen, (source, selection, self._kind)


class Scene(Volume):
    """Volume with others over it: channels, labels, a second modality, a mask.

    Args:
        volume: first volume, whose grid the others are resampled to; a `Volume`, or what a `Volume` is made of.
        channels: further volumes whose material is added.
        labels: volume of label numbers, which colour the first one.
        overlay: second modality, such as PET over CT, whose material is added.
        mask: volume whose material decides where the first one is shown.
        **options: arguments of `Volume` for all volumes that are none yet.

    Raises:
        InvalidArgument: the grids do not meet, or there are more than four volumes.

    >>> Scene("builtin:cells:16", labels="builtin:sphere:16").field_count
    2
    """

    def __init__(
        self,
        volume: Any,
        *,
        channels: Sequence[Any] = (),
        labels: Any = None,
        overlay: Any = None,
        mask: Any = None,
        **options: Any,
    ) -> None:
        def opened(data: Any, kind: str = "auto") -> Volume:
            return data if isinstance(data, Volume) else Volume(data, **{"kind": kind, **options})

        first = opened(volume)
        self._kind = first._kind
        self._source = None
        self._native = first._native
        #: Blend of each further field.
        self._blends = ["add"] * (self._native.field_count - 1)
        others = [(opened(channel), "add") for channel in channels]
        if labels is not None:
            others.append((opened(labels, "labels"), "tint"))
        if overlay is not None:
            others.append((opened(overlay), "add"))
        if mask is not None:
            others.append((opened(mask, "mask"), "gate"))
        for other, blend in others:
            self._native = self._native.with_field(other._native)
            self._blends.append(blend)

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("a scene is not pickled; send the paths of its files, and make the scene where it is drawn")


def _reopen(source: str, selection: Mapping[str, Any], kind: str) -> Volume:
    return Volume(source, kind=kind, **selection)


def _channels(array: Any, axis: int) -> list[Any]:
    """Returns the channels of an array along an axis."""
    shape = tuple(array.shape)
    if not -len(shape) <= axis < len(shape):
        raise InvalidArgument(f"channel_axis: expected an axis of shape {shape}, found {axis}")
    axis %= len(shape)
    if not 1 <= shape[axis] <= MAX_FIELDS:
        raise InvalidArgument(
            f"channel_axis: expected 1 to {MAX_FIELDS} channels, found {shape[axis]} in shape {shape}; choose some"
        )
    return [array[(slice(None),) * axis + (at,)] for at in range(shape[axis])]


def _from_array(image: _arrays.ArrayImage, array: Any, facts: Mapping[str, Any]) -> _native.NativeVolume:
    array = _arrays.three_dimensional(array)
    z, y, x = (int(n) for n in array.shape)
    facts = _arrays.facts_of(image, (z, y, x), **facts)
    return _native.NativeVolume.from_voxels(_arrays.voxels_of(array), facts)


def remove_table(volume: Any, **options: Any) -> Volume:
    """Returns a CT without the table under the body, and warns if there is none.

    Args:
        volume: a `Volume`, or what a `Volume` is made of, with its arguments as ``options``.
    """
    volume = volume if isinstance(volume, Volume) else Volume(volume, **options)
    native, is_found = volume._native.without_table()
    if not is_found:
        warnings.warn("no table was found under a body, so nothing is hidden", stacklevel=2)
    return Volume._wrap(native, volume._kind)
