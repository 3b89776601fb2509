"""Table of what independent libraries read from files, and the conventions that turn it into voxels.

A library returns the numbers of a file and their positions. The rest implements docs/FORMATS.md: the type of a volume
that cannot have the file's own, the displayed values of vectors and colours, and the world of the affine
(right-anterior-superior millimetres; voxels if their size is unknown).
"""

import zlib
from dataclasses import dataclass

import numpy as np

COLUMNS = ["file", "choice", "dims", "type", "space", "affine", "min", "max", "mean", "crc32", "tolerance"]

# Space of the affine: anatomical; known voxel size only; or unknown.
BODY, WORLD, VOXELS = "body", "world", "voxels"


@dataclass
class Reading:
    """Result of a library: voxels by [z, y, x], and the affine of voxel (x, y, z) by three rows of four numbers."""

    voxels: np.ndarray
    affine: np.ndarray
    space: str
    # Tolerance of voxels after lossy compression, where decoders may round differently.
    tolerance: float = 0.0


def spaced(spacing, space=WORLD):
    """Affine and space of voxels of which only the spacing is known."""
    return np.hstack([np.diag(np.asarray(spacing, dtype=float)), np.zeros((3, 1))]), space


def unknown():
    """Affine and space of voxels without metadata."""
    return spaced([1, 1, 1], VOXELS)


def from_lps(affine):
    """Converts an affine from left-posterior-superior to right-anterior-superior."""
    return np.diag([-1.0, -1.0, 1.0]) @ affine


def columns(x, y, z, origin):
    """Affine of three steps and the position of the first voxel."""
    return np.column_stack([x, y, z, origin]).astype(float)


def luminance(colors):
    """Luminance of colours (ITU-R BT.709); integers stay integers."""
    light = colors[..., :3].astype(float) @ np.array([0.2126, 0.7152, 0.0722])
    if colors.dtype in (np.uint8, np.uint16):
        return np.floor(light + 0.5).astype(colors.dtype)
    return light.astype(np.float32)


def length(vectors):
    """Length of vectors."""
    return np.sqrt((vectors.astype(float) ** 2).sum(axis=-1)).astype(np.float32)


def components(voxels, choice, is_color):
    """Reduces voxels of several components to the displayed values."""
    if "component" in choice:
        return voxels[..., int(choice["component"])]
    if voxels.shape[-1] == 1:
        return voxels[..., 0]
    return luminance(voxels) if is_color else length(voxels)


def held(voxels):
    """Converts voxels to one of the eight types of volumes, little-endian."""
    voxels = np.asarray(voxels)
    kind, size = voxels.dtype.kind, voxels.dtype.itemsize
    if kind == "b":
        return voxels.astype(np.uint8)
    if kind == "c":
        return np.abs(voxels.astype(complex)).astype(np.float32)
    if kind == "f" and size == 2:
        return voxels.astype(np.float32)
    if kind in "iu" and size == 8:
        for narrow in (np.int32, np.uint32):
            limits = np.iinfo(narrow)
            if limits.min <= voxels.min() and voxels.max() <= limits.max:
                return voxels.astype(narrow)
        return voxels.astype(np.float64)
    return voxels.astype(voxels.dtype.newbyteorder("<"))


def rescaled(voxels, slope, intercept):
    """Applies a slope and an intercept: to integers if exact, in the smallest type that holds all values."""
    voxels = held(voxels)
    if not (np.isfinite(slope) and np.isfinite(intercept)) or slope == 0 or (slope, intercept) == (1, 0):
        return voxels
    values = voxels.astype(float) * slope + intercept
    if voxels.dtype.kind in "iu" and float(slope).is_integer() and float(intercept).is_integer():
        for narrow in (np.uint8, np.int16, np.uint16, np.int32):
            limits = np.iinfo(narrow)
            if limits.min <= values.min() and values.max() <= limits.max:
                return values.astype(narrow)
    is_wide = voxels.dtype.itemsize > 2 and voxels.dtype != np.float32
    return values.astype(np.float64 if is_wide else np.float32)


def number(value):
    """Formats a number as text that is parsed to the same value."""
    value = float(value)
    return str(int(value)) if value.is_integer() and abs(value) < 2**53 else repr(value)


def row(name, choice, reading):
    """Columns of a row for a file."""
    voxels = held(reading.voxels)
    finite = voxels[np.isfinite(voxels)].astype(float)
    bytes_of_voxels = np.ascontiguousarray(voxels).tobytes()
    crc = "-" if reading.tolerance else f"{zlib.crc32(bytes_of_voxels):08x}"
    return {
        "file": name,
        "choice": choice or "-",
        "dims": " ".join(str(n) for n in reversed(voxels.shape)),
        "type": voxels.dtype.name,
        "space": reading.space,
        # Removes the sign of zeros.
        "affine": " ".join(number(value + 0.0) for value in reading.affine.flat),
        "min": number(finite.min()),
        "max": number(finite.max()),
        "mean": number(finite.mean()),
        "crc32": crc,
        "tolerance": number(reading.tolerance),
    }


def refusal(name, words):
    """Columns of a row for a file without a volume, with words of the error message."""
    return dict.fromkeys(COLUMNS, "-") | {"file": name, "type": "refused", "choice": words}


def save(path, rows, comment):
    """Writes a table to a file."""
    lines = ["# " + line for line in comment] + ["\t".join(COLUMNS)]
    lines += ["\t".join(found[column] for column in COLUMNS) for found in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
