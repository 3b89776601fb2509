"""Readers of MGH files by nibabel, and of FITS files by astropy."""

import nibabel
import numpy as np
from astropy.io import fits

from table import BODY, VOXELS, WORLD, Reading, columns, rescaled, unknown


def read_mgh(path, choice):
    """Reads MGH by nibabel."""
    image = nibabel.load(str(path))
    data = np.asanyarray(image.dataobj)
    if data.ndim > 3:
        data = data[..., int(choice.get("frame", 0))]
    if path.suffix == ".mgz" or path.read_bytes()[28:30] != b"\0\0":
        return Reading(data.T, image.affine[:3], BODY)
    # If the header has no axes, FreeSurfer assumes left, inferior, anterior; nibabel reverses two of them.
    steps = np.array([[-1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    return Reading(data.T, columns(*steps.T, -steps @ (np.array(data.shape[:3]) / 2)), VOXELS)


def read_fits(path, choice):
    """Reads FITS by astropy. The first row is the lowest: it comes last here, in its original position."""
    with fits.open(path, do_not_scale_image_data=True) as units:
        images = [number for number, unit in enumerate(units) if unit.is_image and unit.data is not None]
        unit = units[int(choice.get("array", images[0]))]
        header, data = unit.header, np.array(unit.data)
    axes = list(range(data.ndim, 0, -1))
    while data.ndim > 3 and 1 in data.shape:
        # The slowest axis first, as the program drops them.
        at = data.shape.index(1)
        data, axes = np.squeeze(data, at), axes[:at] + axes[at + 1 :]
    if data.ndim > 3:
        data, axes = data[int(choice.get("frame", 0))], axes[1:]
    data = data.reshape((1,) * (3 - data.ndim) + data.shape)[:, ::-1]
    data = rescaled(data, float(header.get("BSCALE", 1)), float(header.get("BZERO", 0)))
    spacing, space = spacing_of(header, axes[::-1])
    if spacing is None:
        affine, space = unknown()
        spacing = [1.0, 1.0, 1.0]
    x, y, z = np.diag(spacing)
    return Reading(data, columns(x, -y, z, (data.shape[1] - 1) * y), space)


def spacing_of(header, axes):
    """Steps along three axes in one unit; an axis in another unit gets the shortest step."""
    matrix = any(f"CD{i}_{j}" in header for i in range(1, 4) for j in range(1, 4))
    steps, units = [], []
    for axis in axes:
        if matrix:
            steps.append(np.sqrt(sum(header.get(f"CD{i}_{axis}", 0.0) ** 2 for i in range(1, 4))))
        else:
            steps.append(abs(header.get(f"CDELT{axis}", 0.0)))
        kind = header.get(f"CTYPE{axis}", "")[:4]
        on_sky = kind in ("RA--", "DEC-", "GLON", "GLAT")
        units.append(header.get(f"CUNIT{axis}", "deg" if on_sky else kind))
    if not any(steps):
        return None, VOXELS
    shortest = min(step for step, unit in zip(steps, units) if step and unit == units[0])
    one = 1.0 if units[0] == "mm" else shortest
    spacing = [(step if step and unit == units[0] else shortest) / one for step, unit in zip(steps, units)]
    spacing += [min(spacing)] * (3 - len(spacing))
    return spacing, WORLD if units[0] == "mm" else VOXELS
