"""Readers of each format by other libraries: `read(path, choice)`.

A choice has the form of the command line, as in `--frame 1`; `choice_of` parses it.
"""

import gzip
import shutil
import tempfile
import zlib
from pathlib import Path

import mrcfile
import nibabel
import nrrd
import numpy as np
import SimpleITK
import tifffile
from PIL import Image

from readers import arrays, dicoms, grids, research
from table import (
    BODY,
    VOXELS,
    WORLD,
    Reading,
    columns,
    components,
    from_lps,
    held,
    luminance,
    rescaled,
    spaced,
    unknown,
)


def choice_of(text):
    """Parses a choice such as `--frame 1 --channel 0` into names and numbers."""
    words = (text or "").split()
    return {name.removeprefix("--"): value for name, value in zip(words[::2], words[1::2])}


def read_nrrd(path, choice):
    """Reads NRRD by pynrrd."""
    data, header = nrrd.read(str(path), index_order="C")
    kinds = header.get("kinds", ["domain"] * data.ndim)
    spatial = [axis for axis, kind in enumerate(kinds) if kind in ("domain", "space", "???")]
    directions = header.get("space directions")
    if directions is not None:
        spatial = [axis for axis in spatial if np.isfinite(directions[axis]).all()]
    if data.ndim > 3 and len(spatial) > 3:
        spatial = spatial[:3]
    # pynrrd returns the slowest axis first.
    for axis in range(data.ndim - 1, max(spatial), -1):
        data = data[int(choice.get("frame", 0))]
    if min(spatial) > 0:
        is_color = "color" in kinds[0] or (data.dtype == np.uint8 and data.shape[-1] in (3, 4))
        data = components(data, choice, is_color)
    data = data.reshape((1,) * (3 - data.ndim) + data.shape)
    space = header.get("space", "")
    flips = {"left-posterior-superior": [-1, -1, 1], "left-anterior-superior": [-1, 1, 1]}.get(space, [1, 1, 1])
    is_body = space in ("left-posterior-superior", "left-anterior-superior", "right-anterior-superior")
    if directions is not None:
        steps = [np.asarray(directions[axis], dtype=float) for axis in spatial]
        origin = header.get("space origin", np.zeros(3))
        affine = np.diag(flips).astype(float) @ columns(*steps, np.nan_to_num(np.asarray(origin, dtype=float)))
        return Reading(data, affine, BODY if is_body else WORLD)
    spacings = [float(header["spacings"][axis]) for axis in spatial] if "spacings" in header else []
    if not spacings or not np.isfinite(spacings).all():
        return Reading(data, *unknown())
    # The only slice of a picture is as thick as its pixels are wide.
    spacings += [np.sqrt(np.prod(np.abs(spacings)))] * (3 - len(spacings))
    return Reading(data, *spaced(spacings))


def read_nifti(path, choice):
    """Reads NIfTI and Analyze by nibabel."""
    with tempfile.TemporaryDirectory() as folder:
        image = nibabel.load(str(beside_each_other(path, Path(folder))))
        data = np.asanyarray(image.dataobj.get_unscaled())
        slope, intercept = image.dataobj.slope, image.dataobj.inter
    frame = int(choice.get("frame", 0))
    data = data.reshape(data.shape + (1,) * (3 - data.ndim))
    if data.ndim > 3:
        data = data.reshape(data.shape[:3] + (-1,), order="F")[..., frame]
    data = data.T
    if data.dtype.names:
        data = components(np.stack([data[name] for name in data.dtype.names], axis=-1), choice, True)
    elif data.dtype.kind == "c":
        data = np.sqrt(data.real.astype(float) ** 2 + data.imag.astype(float) ** 2).astype(np.float32)
    else:
        data = rescaled(data, slope, intercept)
    header = image.header
    lengths = {1: 1e3, 2: 1.0, 3: 1e-3}
    unit = lengths.get(int(header["xyzt_units"]) & 7) if "xyzt_units" in header else None
    for kind in ("sform", "qform"):
        if f"{kind}_code" in header and int(header[f"{kind}_code"]) > 0:
            affine = header.get_sform() if kind == "sform" else header.get_qform()
            return Reading(data, affine[:3] * (unit or 1.0), BODY)
    pixdim = np.abs(np.asarray(header["pixdim"][1:4], dtype=float))
    if unit is None and set(pixdim) <= {0.0, 1.0}:
        return Reading(data, *unknown())
    other = next((step for step in pixdim if step > 0), 1.0)
    pixdim = [step if step > 0 else other for step in pixdim]
    return Reading(data, *spaced(np.array(pixdim) * (unit or 1.0)))


def beside_each_other(path, folder):
    """Copies a header and its voxels as nibabel needs them: both compressed, or neither."""
    name = path.name.removesuffix(".gz")
    if not name.endswith((".hdr", ".img")):
        return path
    stem = name[:-4]
    for ending in (".hdr", ".img"):
        plain, packed = path.with_name(stem + ending), path.with_name(stem + ending + ".gz")
        target = folder / (stem + ending)
        # An explicitly named compressed file is preferred.
        if plain.exists() and not path.name.endswith(".gz"):
            shutil.copy(plain, target)
        elif packed.exists():
            target.write_bytes(gzip.decompress(packed.read_bytes()))
        elif plain.exists():
            shutil.copy(plain, target)
    return folder / (stem + ".img")


def read_metaimage(path, choice):
    """Reads MetaImage by SimpleITK. The fields that are present are read from the text."""
    image = SimpleITK.ReadImage(str(path))
    data = SimpleITK.GetArrayFromImage(image)
    text = path.read_bytes().split(b"ElementDataFile")[0].decode("latin-1")
    said = {line.split("=")[0].strip() for line in text.splitlines()}
    # SimpleITK reads only CompressedDataSize bytes, and fills the rest with zeros.
    whole = inflated(path, text)
    if len(whole) == data.nbytes:
        data = np.frombuffer(whole, dtype=data.dtype).reshape(data.shape)
    count = image.GetDimension()
    if count == 4:
        data = data[int(choice.get("frame", 0))]
    if image.GetNumberOfComponentsPerPixel() > 1:
        data = components(data, choice, data.dtype == np.uint8 and data.shape[-1] in (3, 4))
    spacing = list(image.GetSpacing()[:3])
    data = data.reshape((1,) * (3 - data.ndim) + data.shape)
    if not said & {"ElementSpacing", "ElementSize"}:
        return Reading(data, *unknown())
    if count < 3 or not said & {"TransformMatrix", "Rotation", "Orientation"}:
        return Reading(data, *spaced(spacing + [spacing[1]] * (3 - len(spacing))))
    direction = np.array(image.GetDirection()).reshape(count, count)[:3, :3]
    steps = direction @ np.diag(spacing)
    return Reading(data, from_lps(columns(*steps.T, image.GetOrigin()[:3])), BODY)


def inflated(path, text):
    """Decompressed contents of the data file beside a header; empty without one."""
    name = path.read_bytes().split(b"ElementDataFile = ")[-1].strip()
    if "CompressedData = True" not in text or not name.endswith(b".zraw"):
        return b""
    return zlib.decompress(path.with_name(name.decode()).read_bytes())


def read_tiff(path, choice):
    """Reads TIFF by tifffile."""
    channel, frame = (int(choice.get(name, 0)) for name in ("channel", "frame"))
    with tifffile.TiffFile(path) as file:
        series = file.series[int(choice.get("series", 0))]
        data, axes = series.asarray(), series.axes
        if file.is_imagej or file.is_ome:
            for axis, at in (("C", channel), ("T", frame)):
                if axis in axes:
                    data = np.take(data, at, axis=axes.index(axis))
                    axes = axes.replace(axis, "")
        elif not file.is_imagej and len(file.pages) > 1 and "S" not in axes:
            data, axes = np.stack([page.asarray() for page in file.pages]), "ZYX"
        if "S" in axes:
            data, axes = np.moveaxis(data, axes.index("S"), -1), axes.replace("S", "")
            is_color = file.pages[0].photometric in (tifffile.PHOTOMETRIC.RGB, tifffile.PHOTOMETRIC.YCBCR)
            data = components(data, choice, True) if is_color else data[..., channel]
        elif "component" in choice:
            raise ValueError("there are no components")
        data = data.reshape((-1,) + data.shape[-2:])
        # Decoders of JPEG may round differently, also in colours that are subsampled.
        tags = file.pages[0].tags
        is_halved = "YCbCrSubSampling" in tags and tags["YCbCrSubSampling"].value != (1, 1)
        is_jpeg = file.pages[0].compression == tifffile.COMPRESSION.JPEG
        tolerance = (2.0 if is_halved else 1.0) if is_jpeg else 0.0
        return Reading(data, *place_of_tiff(file), tolerance)


def place_of_tiff(file):
    """Affine from the spacing that ImageJ and OME store."""
    if file.is_imagej:
        found = file.imagej_metadata
        tags = file.pages[0].tags
        lengths = []
        for name in ("XResolution", "YResolution"):
            up, down = tags[name].value if name in tags else (1, 1)
            lengths.append(down / up)
        unit = {"mm": 1.0, "micron": 1e-3, "um": 1e-3, "\\u00B5m": 1e-3, "nm": 1e-6}.get(found.get("unit"))
        if unit is not None and "XResolution" in tags:
            return spaced(np.array(lengths + [found.get("spacing", 1.0)]) * unit)
        return spaced(lengths + [found["spacing"]], VOXELS) if "spacing" in found else unknown()
    if file.is_ome:
        pixels = tifffile.xml2dict(file.ome_metadata)["OME"]["Image"]
        pixels = (pixels[0] if isinstance(pixels, list) else pixels)["Pixels"]
        units = {"mm": 1.0, "µm": 1e-3, "nm": 1e-6}
        sizes = [
            pixels[f"PhysicalSize{axis}"] * units[pixels.get(f"PhysicalSize{axis}Unit", "µm")]
            for axis in "XYZ"
            if f"PhysicalSize{axis}" in pixels
        ]
        return spaced(sizes) if len(sizes) == 3 else unknown()
    return unknown()


def read_mrc(path, choice):
    """Reads MRC by mrcfile. Lengths are in Å."""
    with mrcfile.open(path, permissive=True) as file:
        data, header = np.array(file.data), file.header
        data = data.reshape((1,) * (3 - data.ndim) + data.shape)
        if data.ndim == 4:
            data = data[int(choice.get("frame", 0))]
        cell = np.array([header.cella.x, header.cella.y, header.cella.z], dtype=float)
        intervals = np.array([header.mx, header.my, header.mz], dtype=float)
        order = [int(axis) - 1 for axis in (header.mapc, header.mapr, header.maps)]
        origin = np.array([header.origin.x, header.origin.y, header.origin.z], dtype=float)
        starts = np.array([header.nxstart, header.nystart, header.nzstart], dtype=float)
        angles = np.radians([float(header.cellb.alpha), float(header.cellb.beta), float(header.cellb.gamma)])
    if not cell.any():
        return Reading(data, *unknown())
    cosines = np.where(np.isclose(angles, np.pi / 2), 0.0, np.cos(angles))
    sine = np.sqrt(1 - cosines[2] ** 2)
    height = (cosines[0] - cosines[1] * cosines[2]) / sine
    axes = np.array([[1, 0, 0], [cosines[2], sine, 0], [cosines[1], height, np.sqrt(1 - cosines[1] ** 2 - height**2)]])
    steps = (axes * (cell / intervals)[:, None])[order]
    if not origin.any():
        origin = starts @ steps
    return Reading(data, columns(*steps, origin) * 1e-7, WORLD)


def read_numpy(path, choice):
    """Reads NumPy arrays by NumPy."""
    data = np.load(path)
    if path.suffix == ".npz":
        names = list(data.keys())
        data = data[choice.get("array", names[0])]
    # The fastest axis is x, whichever axis the array counts first.
    if data.flags.f_contiguous and not data.flags.c_contiguous:
        data = data.T
    if data.dtype == np.uint8 and data.ndim > 3 and data.shape[-1] in (3, 4):
        data = components(data, choice, True)
    for name in ("frame", "channel")[: max(data.ndim - 3, 0)]:
        data = data[int(choice.get(name, 0))]
    return Reading(data.reshape((1,) * (3 - data.ndim) + data.shape), *unknown())


def read_pictures(path, choice):
    """Reads a folder of slices by Pillow, sorted by name."""
    slices = [np.asarray(Image.open(file)) for file in sorted(path.iterdir())]
    return Reading(np.stack([luminance(voxels) if voxels.ndim == 3 else voxels for voxels in slices]), *unknown())


READERS = {
    (".nrrd", ".nhdr"): read_nrrd,
    (".nii", ".nii.gz", ".hdr", ".img", ".hdr.gz", ".img.gz"): read_nifti,
    (".dcm", ".dicom-series"): dicoms.read_dicom,
    (".mha", ".mhd"): read_metaimage,
    (".tif", ".tiff", ".btf"): read_tiff,
    (".vti", ".vtk"): grids.read_vtk,
    (".mrc", ".map", ".ccp4", ".mrc.gz", ".map.gz"): read_mrc,
    (".npy", ".npz"): read_numpy,
    (".mgh", ".mgz"): research.read_mgh,
    (".fits", ".fits.gz"): research.read_fits,
    (".h5", ".xml", ".ims", ".nc", ".nxs", ".mat"): arrays.read_hdf5,
    (".cube",): grids.read_cube,
    (".pvm",): grids.read_pvm,
    (".raw", ".dat", ".ini", ".ivf"): grids.read_described,
    (".slices",): read_pictures,
}


def read(path, choice=""):
    """Reads a file or folder by the library for its format."""
    if path.is_file():
        with path.open("rb") as file:
            # DICOM files may have any name.
            if file.read(132)[128:] == b"DICM":
                return dicoms.read_dicom(path, choice_of(choice))
    for endings, reader in READERS.items():
        if path.name.endswith(endings):
            reading = reader(path, choice_of(choice))
            return Reading(held(reading.voxels), reading.affine, reading.space, reading.tolerance)
    raise ValueError(f"no reader for {path}")
