"""Measures a folder of test data: python measure.py FOLDER, which writes data.tsv beside this file.

Each file below formats/, raw/ and first/ gets a row: what an independent library reads from it, or why it has no
volume.
"""

import sys
from pathlib import Path

import readers
from table import refusal, row, save

HERE = Path(__file__).parent

# Files of several volumes, with the choice of the measured one.
CHOICES = {
    "formats/nifti/example4d.nii.gz": "--frame 1",
    "formats/nifti/example_nifti2.nii.gz": "--frame 1",
    "formats/nifti/small/rgb_4D.nii": "--frame 1",
    "formats/nifti/small/rgba_4D.nii": "--frame 1",
    "formats/nifti/small_64D.nii": "--frame 63",
    "formats/vtk/uniform.vtk": "--array 1",
}

# Files without a volume of their own, with words of the error message.
REFUSED = {
    "formats/dat/bonsai.raw.dat": "there is no such file",
    "formats/dat/fuel.raw.dat": "there is no such file",
    "formats/dat/manix128.dat": "there is no such file",
    "formats/dat/tooth.raw.dat": "there is no such file",
    "formats/nrrd/blaze/credits.txt": "its format is not supported",
    # Voxel data of headers beside them.
    "formats/metaimage/frogtissue.zraw": "its format is not supported",
} | dict.fromkeys(
    (
        "formats/metaimage/HeadMRVolume.raw",
        "formats/nrrd/blaze/engine.raw",
        "formats/nrrd/blaze/tooth.raw",
        "formats/nrrd/fuel.raw.gz",
        "formats/nrrd/neghip.raw",
        "formats/nrrd/odd/BallBinary30x30x30.raw",
        "formats/nrrd/silicium.raw.gz",
    ),
    "does not state the dimensions and the type",
)


def measure(folder):
    """Returns a row for each file, and for the folder of a series."""
    found = []
    for top in ("formats", "raw", "first"):
        for path in sorted((folder / top).rglob("*")):
            name = path.relative_to(folder).as_posix()
            if path.is_dir():
                continue
            if name in REFUSED:
                found.append(refusal(name, REFUSED[name]))
                continue
            choice = CHOICES.get(name, "")
            try:
                found.append(row(name, choice, readers.read(path, choice)))
            except Exception as why:  # noqa: BLE001 - whatever a library says, the row shows it
                print(f"{name}: {type(why).__name__}: {why}", file=sys.stderr)
    return found


if __name__ == "__main__":
    save(HERE / "data.tsv", measure(Path(sys.argv[1])), ["The test data, measured by measure.py."])
