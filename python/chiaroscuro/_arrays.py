"""Conversion of arrays and images of other packages to voxels.

Nothing here imports those packages: objects are recognised by what they offer.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from . import _native
from ._errors import InvalidArgument

#: Lengths in millimetres, by the names that people and files write.
UNITS_MM = {
    "nm": 1e-6, "nanometer": 1e-6, "nanometre": 1e-6,
    "um": 1e-3, "µm": 1e-3, "μm": 1e-3, "micron": 1e-3, "micrometer": 1e-3, "micrometre": 1e-3,
    "mm": 1.0, "millimeter": 1.0, "millimetre": 1.0,
    "cm": 10.0, "centimeter": 10.0, "centimetre": 10.0,
    "m": 1e3, "meter": 1e3, "metre": 1e3,
}  # fmt: skip

#: Types of voxels that are drawn as they are.
VOXEL_TYPES = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")

#: Bytes of a lazy array that are read at a time.
BLOCK_BYTES = 64 << 20


@dataclasses.dataclass
class ArrayImage:
    """Array with the facts that its package knows about it.

    ``array`` has an index (z, y, x); it is a NumPy array, or a lazy one that is read block by block. ``scale`` and
    ``translate`` are in ``units``, in array order. ``affine`` maps indices (x, y, z) to millimetres, three rows of four
    numbers, and replaces both.
    """

    array: Any
    scale: tuple[float, ...] | None = None
    translate: tuple[float, ...] | None = None
    units: str | None = None
    affine: np.ndarray | None = None
    is_anatomical: bool = False
    name: str | None = None
    value_unit: str | None = None


def image_of(data: Any) -> ArrayImage:
    """Returns the array of an object, with the facts that the object states."""
    if isinstance(data, np.ndarray):
        return ArrayImage(data)
    if hasattr(data, "dims") and hasattr(data, "coords") and hasattr(data, "attrs"):
        return _from_xarray(data)
    if hasattr(data, "dataobj") and hasattr(data, "affine"):
        return _from_nibabel(data)
    if hasattr(data, "GetDirection") and hasattr(data, "GetSpacing") and hasattr(data, "GetPixelIDValue"):
        return _from_simpleitk(data)
    if hasattr(data, "dataset") and hasattr(data.dataset, "GetPointData"):
        # A volume of vedo.
        data = data.dataset
    if hasattr(data, "GetPointData") and hasattr(data, "GetDimensions"):
        return _from_vtk(data)
    if hasattr(data, "detach") and hasattr(data, "cpu"):
        return _from_torch(data)
    if hasattr(data, "shape") and hasattr(data, "dtype") and hasattr(data, "__getitem__"):
        return ArrayImage(data)
    return ArrayImage(np.asarray(data))


def _from_torch(data: Any) -> ArrayImage:
    """Takes the values of a tensor; those of bfloat16, which NumPy lacks, become float32, which has all of them."""
    tensor = data.detach().cpu()
    if str(tensor.dtype) == "torch.bfloat16":
        tensor = tensor.float()
    try:
        return ArrayImage(tensor.numpy())
    except TypeError as error:
        raise InvalidArgument(f"the tensor cannot be read as an array: {error}") from error


def _from_xarray(data: Any) -> ArrayImage:
    """Takes spacing and origin from evenly spaced coordinates, and units from attributes."""
    scale, translate = [], []
    units = None
    for dim in data.dims:
        step, first = 1.0, 0.0
        if dim in data.coords and data.coords[dim].ndim == 1 and np.issubdtype(data.coords[dim].dtype, np.number):
            places = np.asarray(data.coords[dim].values, dtype=float)
            units = data.coords[dim].attrs.get("units", units)
            if places.size > 1:
                steps = np.diff(places)
                step, first = float(steps.mean()), float(places[0])
                # Coordinates are often rounded to seven digits.
                if step == 0.0 or not np.allclose(steps, step, rtol=1e-3):
                    raise InvalidArgument(
                        f"the coordinates of dimension {dim!r} are not evenly spaced; resample the array, or give its "
                        "values and a scale"
                    )
        scale.append(step)
        translate.append(first)
    has_coordinates = any(dim in data.coords for dim in data.dims)
    units = units if units in UNITS_MM else None
    return ArrayImage(
        data.data,
        scale=tuple(scale) if has_coordinates else None,
        translate=tuple(translate) if has_coordinates else None,
        units=units,
        name=str(data.name) if data.name is not None else None,
        value_unit=data.attrs.get("units"),
    )


def _from_nibabel(data: Any) -> ArrayImage:
    """Takes the affine map to right-anterior-superior millimetres."""
    array = np.asanyarray(data.dataobj)
    # Its index is (x, y, z), and perhaps time.
    while array.ndim > 3 and array.shape[-1] == 1:
        array = array[..., 0]
    return ArrayImage(array.T, affine=np.asarray(data.affine, dtype=float)[:3], is_anatomical=True)


def _from_simpleitk(data: Any) -> ArrayImage:
    """Takes spacing, direction and origin; ITK's axes lead to the left and to the back."""
    import SimpleITK

    if data.GetDimension() != 3:
        raise InvalidArgument(f"expected an image of 3 dimensions, found {data.GetDimension()}; extract a part of it")
    direction = np.asarray(data.GetDirection(), dtype=float).reshape(3, 3)
    affine = np.column_stack([direction * np.asarray(data.GetSpacing()), data.GetOrigin()])
    affine[:2] *= -1.0
    return ArrayImage(SimpleITK.GetArrayViewFromImage(data), affine=affine, is_anatomical=True)


def _from_vtk(data: Any) -> ArrayImage:
    """Takes the scalars of the points, spacing, direction and origin."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    scalars = data.GetPointData().GetScalars()
    if scalars is None:
        raise InvalidArgument("the image has no scalars at its points; set them with GetPointData().SetScalars")
    dims = data.GetDimensions()
    matrix = data.GetDirectionMatrix() if hasattr(data, "GetDirectionMatrix") else None
    direction = np.array([[matrix.GetElement(r, c) for c in range(3)] for r in range(3)]) if matrix else np.eye(3)
    affine = np.column_stack([direction * np.asarray(data.GetSpacing()), data.GetOrigin()])
    components = scalars.GetNumberOfComponents()
    shape = (dims[2], dims[1], dims[0]) + ((components,) if components > 1 else ())
    return ArrayImage(vtk_to_numpy(scalars).reshape(shape), affine=affine)


def three_dimensional(array: Any) -> Any:
    """Returns an array of three dimensions, without further ones of length 1."""
    shape = tuple(array.shape)
    if len(shape) > 3:
        extra = [axis for axis, n in enumerate(shape) if n == 1][: len(shape) - 3]
        if len(shape) - len(extra) != 3:
            raise InvalidArgument(
                f"array: expected 3 dimensions (z, y, x), found shape {shape}; choose a time step, or name the axis of "
                "channels by channel_axis="
            )
        return array[tuple(0 if axis in extra else slice(None) for axis in range(len(shape)))]
    if len(shape) != 3:
        raise InvalidArgument(f"array: expected 3 dimensions (z, y, x), found shape {shape}")
    return array


def voxel_type(array: Any) -> str:
    """Returns the type in which the values of an array are drawn."""
    dtype = np.dtype(array.dtype)
    if dtype.name in VOXEL_TYPES:
        return dtype.name
    if dtype.kind == "b":
        return "uint8"
    if dtype.name == "float16":
        return "float32"
    if dtype.kind in "iu":
        if isinstance(array, np.ndarray) and array.size > 0:
            limits = np.iinfo(np.int32)
            if limits.min <= array.min() and array.max() <= limits.max:
                return "int32"
        return "float64"
    if dtype.kind == "f":
        return "float64"
    raise InvalidArgument(f"array: expected real numbers, found {dtype}; take a part, or an absolute value")


def voxels_of(array: Any) -> _native.VoxelBuffer:
    """Takes the voxels of an array of three dimensions: all at once, or a lazy array slab by slab."""
    shape = tuple(int(n) for n in array.shape)
    if 0 in shape:
        raise InvalidArgument(f"array: expected at least one voxel, found shape {shape}")
    dtype = voxel_type(array)
    voxels = _native.VoxelBuffer(dtype, shape[0] * shape[1] * shape[2])
    if isinstance(array, np.ndarray):
        voxels.append(array.astype(dtype, copy=False))
        return voxels
    slices = _slices_at_once(array, shape, np.dtype(dtype).itemsize)
    for first in range(0, shape[0], slices):
        slab = np.asarray(array[first : first + slices])
        voxels.append(slab.astype(dtype, copy=False))
    return voxels


def _slices_at_once(array: Any, shape: tuple[int, ...], item_bytes: int) -> int:
    """Returns the number of slices to read at a time: whole chunks, of about `BLOCK_BYTES`."""
    wanted = max(1, BLOCK_BYTES // max(1, shape[1] * shape[2] * item_bytes))
    chunks = getattr(array, "chunks", None)
    if not chunks:
        return wanted
    depth = chunks[0][0] if isinstance(chunks[0], tuple) else int(chunks[0])
    return max(depth, wanted // max(1, depth) * depth)


def facts_of(
    image: ArrayImage,
    shape: tuple[int, int, int],
    *,
    scale: Any = None,
    translate: Any = None,
    units: str | None = None,
    name: str | None = None,
    are_labels: bool = False,
) -> dict[str, Any]:
    """Returns the facts about an array that its voxels do not say; arguments win over those of the object."""
    units = units if units is not None else image.units
    if units is not None and units not in UNITS_MM:
        raise InvalidArgument(f"units: expected one of nm, um, mm, cm, m, found {units!r}")
    is_known = units is not None or image.affine is not None or scale is not None or image.scale is not None
    unit_mm = UNITS_MM.get(units or "mm", 1.0)
    if scale is None and translate is None and image.affine is not None:
        affine = image.affine
    else:
        scale = _triple("scale", scale if scale is not None else image.scale, 1.0)
        translate = _triple("translate", translate if translate is not None else image.translate, 0.0)
        if any(step == 0.0 or not np.isfinite(step) for step in scale):
            raise InvalidArgument(f"scale: expected three numbers other than 0, found {tuple(scale)}")
        affine = np.column_stack([np.diag(scale[::-1]), translate[::-1]]) * unit_mm
    return {
        "name": name or image.name or "array",
        "shape": list(shape),
        "world_from_index": np.asarray(affine, dtype=float).tolist(),
        "unit_mm": unit_mm if is_known else None,
        "is_anatomical": image.is_anatomical and translate is None and scale is None,
        "are_labels": are_labels,
        "value_unit": image.value_unit,
    }


def _triple(what: str, numbers: Any, default: float) -> np.ndarray:
    """Returns three numbers, for z, y and x; of more, the last three."""
    if numbers is None:
        return np.full(3, default)
    values = np.atleast_1d(np.asarray(numbers, dtype=float))
    if values.size == 1:
        return np.full(3, values[0])
    if values.ndim != 1 or values.size < 3:
        raise InvalidArgument(f"{what}: expected one number, or three in the order z, y, x, found {numbers!r}")
    return values[-3:]
