"""Reference files of MGH and MGZ, written by nibabel."""

import nibabel
import numpy as np

from cases.sources import ORIENTATIONS, STRAIGHT, affine, small, source


def cases(folder):
    """Writes types, positions, time steps, a header without a position, and both compressions."""

    def write(name, image, choice="", expected=None):
        nibabel.save(image, str(folder / name))
        return name, choice, np.asanyarray(image.dataobj).T if expected is None else expected

    place = affine(STRAIGHT)
    for kind in ("uint8", "int16", "int32", "float32"):
        yield write(f"mgh_{kind}.mgh", nibabel.MGHImage(source(kind).T, place))
    for name, steps in ORIENTATIONS.items():
        yield write(f"mgh_{name}.mgz", nibabel.MGHImage(source("int16").T, affine(steps)))
    times = source("int16", (2, 3, 4, 5))
    yield write("mgh_times.mgz", nibabel.MGHImage(times.T, place), "--frame 1", times[1])
    image = nibabel.MGHImage(small("uint8").T, place)
    nibabel.save(image, str(folder / "mgh_unplaced.mgh"))
    path = folder / "mgh_unplaced.mgh"
    # Clears goodRASFlag.
    path.write_bytes(path.read_bytes()[:28] + b"\0\0" + path.read_bytes()[30:])
    yield path.name, "", small("uint8")
