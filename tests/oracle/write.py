"""Writes the small files in written/ with other libraries, and written.tsv with what these read back: python write.py

Each file is read by an independent reader (`readers/`), which must find the numbers that were written.
"""

import shutil
import sys
from pathlib import Path

import numpy as np

import readers
from cases import astronomy, dicom, freesurfer, grids, hdf5, medical, microscopy, phantom
from table import row, save

HERE = Path(__file__).parent
WRITTEN = HERE / "written"

# Size in bytes of the largest file that is committed; HDF5 keeps metadata in blocks of about 2 KiB.
MOST_BYTES = 4096
MOST_HDF5_BYTES = 11 * 1024


def main():
    """Writes all files and tables from scratch."""
    shutil.rmtree(WRITTEN, ignore_errors=True)
    WRITTEN.mkdir()
    cases = [
        case
        for module in (medical, dicom, microscopy, grids, freesurfer, astronomy, hdf5)
        for case in module.cases(WRITTEN)
    ]
    rows = []
    for name, choice, expected in cases:
        reading = readers.read(WRITTEN / name, choice)
        found = reading.voxels
        if expected is not None:
            expected = np.asarray(expected)
            assert found.shape == expected.shape, f"{name}: {found.shape}, {expected.shape} was written"
            off = np.abs(found.astype(complex) - expected.astype(complex)).max()
            assert off <= reading.tolerance * 4 or np.isnan(off), f"{name}: off by {off}"
        rows.append(row(name, choice, reading))
    save(HERE / "written.tsv", rows, ["Written by write.py, and read by the libraries that readers/ uses."])
    phantom.write(HERE / "phantom")
    shutil.rmtree(HERE / "refused", ignore_errors=True)
    (HERE / "refused").mkdir()
    hdf5.refused(HERE / "refused")
    most = lambda path: MOST_HDF5_BYTES if path.name.startswith("hdf5_") or path.parent.name == "refused" else MOST_BYTES
    large = [path.name for path in HERE.rglob("*/*") if path.is_file() and path.stat().st_size > most(path)]
    large = [name for name in large if not name.endswith((".py", ".pyc"))]
    if large:
        sys.exit(f"larger than {MOST_BYTES} bytes: {large}")
    print(len(rows), "files")


if __name__ == "__main__":
    main()
