"""Phantom: a head with an L on its left, in each format with stored directions, and in axis order in the others.

One head in two orientations: along the axes of the body, with voxels of 1 mm, and oblique, with voxels of three
lengths. Files differ in the order and direction of the head's axes, and in how they store these.
"""

import gzip
import itertools
import shutil

import mrcfile
import nibabel
import nrrd
import numpy as np
import pydicom
import SimpleITK
import tifffile
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence

import readers
from cases import dicom, grids
from cases.medical import itk, undated
from cases.sources import affine
from table import held

# Voxels to the right, to the front and to the head: they fit into 4 KiB with a header.
SIZE = (14, 18, 15)
MARK = 120
STRAIGHT = np.eye(3)
_A, _B = 0.4, 0.25
ASLANT = (
    np.array([[1, 0, 0], [0, np.cos(_A), -np.sin(_A)], [0, np.sin(_A), np.cos(_A)]])
    @ np.array([[np.cos(_B), -np.sin(_B), 0], [np.sin(_B), np.cos(_B), 0], [0, 0, 1]])
    @ np.diag([1.2, 0.9, 1.1])
)
ORIGIN = np.array([3.0, -7.0, 11.0])


def head():
    """Voxels by [right, front, head]: an egg with a nose in front, a neck below, and an L on its left."""
    x, y, z = np.meshgrid(*[np.arange(n, dtype=float) for n in SIZE], indexing="ij")
    found = np.zeros(SIZE, dtype=np.uint8)
    found[((x - 7) / 5) ** 2 + ((y - 8) / 6.5) ** 2 + ((z - 8) / 5.5) ** 2 < 1] = 40
    found[(((x - 7) / 2.5) ** 2 + ((y - 7) / 2.5) ** 2 < 1) & (z < 4)] = 40
    found[6:9, 14:17, 7:9] = 80
    # Seen from its left the front is on the left: the foot of the L runs to the back.
    found[1:3, 10:12, 4:12] = MARK
    found[1:3, 5:10, 4:6] = MARK
    return found


def turned(order, flips, steps):
    """The head by [first, second, third axis of a file], with the affine of its voxels."""
    data, place = head(), affine(steps, ORIGIN)
    for axis in flips:
        data = np.flip(data, axis)
        place[:3, 3] += place[:3, axis] * (SIZE[axis] - 1)
        place[:3, axis] *= -1
    place[:3, :3] = place[:3, list(order)]
    return data.transpose(order), place


# Orders and directions of axes: some of the 48, by name.
RAS, LPS = ((0, 1, 2), ()), ((0, 1, 2), (0, 1))
SAGITTAL, CORONAL, BACKWARDS = ((1, 2, 0), (1, 2)), ((0, 2, 1), (2,)), ((2, 1, 0), (0, 2))
ORDERS = {"ras": RAS, "lps": LPS, "sagittal": SAGITTAL, "coronal": CORONAL, "backwards": BACKWARDS}


def write(folder):
    """Writes all files, and checks by independent readers that the L is on the left in each."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for (name, (order, flips)), (lie, steps) in itertools.product(
        ORDERS.items(), {"straight": STRAIGHT, "aslant": ASLANT}.items()
    ):
        data, place = turned(order, flips, steps)
        of_bodies(folder, f"{lie}_{name}", data, place)
    in_their_order(folder)
    for path in sorted(folder.iterdir()):
        # RAW data are read through their description; no library reads gzipped cubes.
        if not path.name.endswith((".bin", ".cube.gz")):
            check(path, ASLANT if path.name.startswith("aslant") else STRAIGHT)


def check(path, steps):
    """Checks the position of the centre of the L."""
    reading = readers.read(path, "")
    z, y, x = np.nonzero(held(reading.voxels) == MARK)
    middle = reading.affine @ np.array([x.mean(), y.mean(), z.mean(), 1.0])
    marked = np.array([axis.mean() for axis in np.nonzero(head() == MARK)])
    whole = np.array([(n - 1) / 2 for n in SIZE])
    size = (np.array(reading.voxels.shape[::-1]) - 1) / 2
    # Relative to the centre of the grid: not every format stores its position.
    found = middle - reading.affine @ np.append(size, 1.0)
    if path.name.endswith(".mrc.gz"):
        found = found / 1e-7
    assert np.allclose(found, steps @ (marked - whole), atol=1e-4), f"{path.name}: {found}"


def of_bodies(folder, name, data, place):
    """Writes the formats that store anatomical directions."""
    lps = np.diag([-1.0, -1.0, 1.0])
    steps, origin = place[:3, :3], place[:3, 3]
    for space, flip in (("right-anterior-superior", np.eye(3)), ("left-posterior-superior", lps)):
        header = {"encoding": "gzip", "space": space, "space directions": (flip @ steps).T, "space origin": flip @ origin}
        path = folder / f"{name}_{space[0]}.nrrd"
        nrrd.write(str(path), data.T, header, index_order="C")
        undated(path)
    for kind in ("sform", "qform"):
        image = nibabel.Nifti1Image(data, place, dtype="uint8")
        image.set_sform(place, code=int(kind == "sform"))
        image.set_qform(place, code=int(kind == "qform"))
        image.header.set_xyzt_units("mm")
        nibabel.save(image, str(folder / f"{name}_{kind}.nii.gz"))
    SimpleITK.WriteImage(itk(data.T, steps, origin), str(folder / f"{name}.mha"), useCompression=True)
    grids.save(grids.image(data.T, steps, origin=origin), folder / f"{name}.vti")
    # Slices of a series proceed along their normal.
    if np.linalg.det(steps) > 0:
        frames(data.T, steps, origin, folder / f"{name}.dcm")


def frames(data, steps, origin, path):
    """Writes all slices as one multi-frame file of DICOM."""
    found = dicom.dataset(path.stem, data, pydicom.uid.DeflatedExplicitVRLittleEndian)
    shared, plane = Dataset(), dicom.lying(Dataset(), steps, 0, origin)
    orientation, measures = Dataset(), Dataset()
    orientation.ImageOrientationPatient = plane.ImageOrientationPatient
    measures.PixelSpacing, measures.SliceThickness = plane.PixelSpacing, plane.SliceThickness
    shared.PlaneOrientationSequence = Sequence([orientation])
    shared.PixelMeasuresSequence = Sequence([measures])
    found.SharedFunctionalGroupsSequence = Sequence([shared])
    groups = []
    for at in range(len(data)):
        group, position = Dataset(), Dataset()
        position.ImagePositionPatient = dicom.lying(Dataset(), steps, at, origin).ImagePositionPatient
        group.PlanePositionSequence = Sequence([position])
        groups.append(group)
    found.PerFrameFunctionalGroupsSequence = Sequence(groups)
    dicom.save(found, path)


def in_their_order(folder):
    """Writes the formats without anatomical directions, where x is right, y front and z head in the file's axis
    order.
    """
    data = np.ascontiguousarray(head().T)
    np.save(folder / "straight_numpy.npy", data)
    data.tofile(folder / "straight_bare_14x18x15_uint8.raw")
    data.tofile(folder / "straight_described.bin")
    text = "ObjectFileName: straight_described.bin\nResolution: 14 18 15\nSliceThickness: 1 1 1\nFormat: UCHAR\n"
    (folder / "straight_described.dat").write_text(text)
    (folder / "straight_packed.pvm").write_bytes(b"PVM2\n14 18 15\n1 1 1\n1\n" + data.tobytes())
    options = {"compression": "adobe_deflate", "software": False}
    tifffile.imwrite(folder / "straight_pages.tif", data, metadata=None, photometric="minisblack", **options)
    sizes = {f"PhysicalSize{axis}": 1.0 for axis in "XYZ"}
    sizes |= {f"PhysicalSize{axis}Unit": "mm" for axis in "XYZ"} | {"UUID": "6e0d8a2c-0000-1000-8000-000000000022"}
    tifffile.imwrite(
        folder / "straight_ome.ome.tif", data, ome=True, metadata={"axes": "ZYX", **sizes}, compression="adobe_deflate"
    )
    for order in itertools.permutations((0, 1, 2)):
        words = "".join(str(axis + 1) for axis in order)
        path = folder / f"straight_axes_{words}.mrc.gz"
        turned_data = np.ascontiguousarray(head().transpose(order).T).astype("int8")
        with mrcfile.new(path, data=turned_data, compression="gzip", overwrite=True) as file:
            header = file.header
            header.mapc, header.mapr, header.maps = (axis + 1 for axis in order)
            header.mx, header.my, header.mz = SIZE
            header.cella = tuple(float(n) for n in SIZE)
            header.label[:] = b""
            header.nlabl = 0
        path.write_bytes(gzip.compress(gzip.decompress(path.read_bytes()), mtime=0))
    lines = ["A head", "z fastest", "0 0 0 0", "-14 1 0 0", "18 0 1 0", "15 0 0 1"]
    lines += [str(number) for number in head().reshape(-1)]
    packed = gzip.compress(("\n".join(lines) + "\n").encode(), mtime=0)
    (folder / "straight_cube.cube.gz").write_bytes(packed)
