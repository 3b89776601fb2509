"""Voxel values of the reference files: small volumes of every type in which no two axes can be confused."""

import numpy as np

# Number of voxels along x, y, z.
DIMS = (5, 4, 3)

INTEGERS = ["uint8", "int8", "uint16", "int16", "uint32", "int32"]
WIDE = ["uint64", "int64"]
FLOATS = ["float32", "float64"]


def source(name, shape=DIMS[::-1]):
    """Voxels of a type by [z, y, x], over its whole range; floats also below 1."""
    random = np.random.default_rng(abs(hash_of(name)))
    kind = np.dtype(name)
    if kind.kind in "iu":
        limits = np.iinfo(kind)
        # Integers beyond 53 bits do not fit into any voxel type of the program.
        low, high = max(limits.min, -(2**52)), min(limits.max, 2**52)
        found = random.integers(low, high, shape, dtype=np.int64).astype(kind)
        found.flat[0], found.flat[-1] = low, high
        return found
    if kind.kind == "c":
        return (random.normal(0, 10, shape) + 1j * random.normal(0, 10, shape)).astype(kind)
    return random.normal(0, 100, shape).astype(kind)


def hash_of(name):
    """Hash of a name that is the same in every run."""
    return sum(ord(letter) * 31**at for at, letter in enumerate(name)) % 2**32


def small(name, shape=DIMS[::-1]):
    """Whole numbers from 0 to 200 in a type, for scaling and lossy compression."""
    return np.random.default_rng(7).integers(0, 200, shape).astype(name)


# Three steps in right-anterior-superior millimetres: along the axes, permuted and reversed, and oblique by 0.3 and
# 0.2 radians.
STRAIGHT = np.diag([1.5, 2.0, 2.5])
PERMUTED = np.array([[0, 0, -2.5], [1.5, 0, 0], [0, -2.0, 0]])
_TURN = np.array([[1, 0, 0], [0, np.cos(0.3), -np.sin(0.3)], [0, np.sin(0.3), np.cos(0.3)]]) @ np.array(
    [[np.cos(0.2), -np.sin(0.2), 0], [np.sin(0.2), np.cos(0.2), 0], [0, 0, 1]]
)
OBLIQUE = _TURN @ STRAIGHT
MIRRORED = OBLIQUE @ np.diag([1.0, -1.0, 1.0])
ORIENTATIONS = {"straight": STRAIGHT, "permuted": PERMUTED, "oblique": OBLIQUE, "mirrored": MIRRORED}
ORIGIN = np.array([-10.0, 20.5, 7.25])


def affine(steps, origin=ORIGIN):
    """Affine matrix of four rows of four numbers."""
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = steps, origin
    return found
