"""The table of what independent libraries find in files, and the few conventions that turn it into voxels.

A library says which numbers a file holds and where they lie. What follows is what docs/FORMATS.md promises beyond
that: which type a volume has where it cannot have the file's own, what is shown of vectors and colours, and the world
in which axes are written down (right-anterior-superior millimetres; voxels where nobody knows how large they are).
"""

import zlib
from dataclasses import dataclass

import numpy as np

COLUMNS = ["file", "choice", "dims", "type", "space", "affine", "min", "max", "mean", "crc32", "tolerance"]

# The file says which way a body lies; how large voxels are, and no more; or not even that.
BODY, WORLD, VOXELS = "body", "world", "voxels"


@dataclass
class Reading:
    """What a library finds: voxels by [z, y, x], and the place of voxel (x, y, z) by three rows of four numbers."""

    voxels: np.ndarray
    affine: np.ndarray
    space: str
    # How far voxels may differ that were packed with loss, where decoders may round differently.
    tolerance: float = 0.0


def spaced(spacing, space=WORLD):
    """Voxels so far apart, of which no more is known."""
    return np.hstack([np.diag(np.asarray(spacing, dtype=float)), np.zeros((3, 1))]), space


def unknown():
    """Voxels of which nothing is known."""
    return spaced([1, 1, 1], VOXELS)


def from_lps(affine):
    """Left-posterior-superior to right-anterior-superior."""
    return np.diag([-1.0, -1.0, 1.0]) @ affine


def columns(x, y, z, origin):
    """The affine of three steps and the place of the first voxel."""
    return np.column_stack([x, y, z, origin]).astype(float)


def luminance(colors):
    """How light colours are (ITU-R BT.709); whole numbers stay whole."""
    light = colors[..., :3].astype(float) @ np.array([0.2126, 0.7152, 0.0722])
    if colors.dtype in (np.uint8, np.uint16):
        return np.floor(light + 0.5).astype(colors.dtype)
    return light.astype(np.float32)


def length(vectors):
    """How long vectors are."""
    return np.sqrt((vectors.astype(float) ** 2).sum(axis=-1)).astype(np.float32)


def held(voxels):
    """Voxels in one of the eight types that volumes have, little-endian."""
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
    """Times a slope, plus an intercept: whole where that is exact, in the smallest type that holds all."""
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
    """A number as text that is read back as the same."""
    value = float(value)
    return str(int(value)) if value.is_integer() and abs(value) < 2**53 else repr(value)


def row(name, choice, reading):
    """The columns of a file."""
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
        # Nothing is said by the sign of a zero.
        "affine": " ".join(number(value + 0.0) for value in reading.affine.flat),
        "min": number(finite.min()),
        "max": number(finite.max()),
        "mean": number(finite.mean()),
        "crc32": crc,
        "tolerance": number(reading.tolerance),
    }


def refusal(name, words):
    """The columns of a file that holds no volume: words that the message has."""
    return dict.fromkeys(COLUMNS, "-") | {"file": name, "type": "refused", "choice": words}


def save(path, rows, comment):
    """Writes a table."""
    lines = ["# " + line for line in comment] + ["\t".join(COLUMNS)]
    lines += ["\t".join(found[column] for column in COLUMNS) for found in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
