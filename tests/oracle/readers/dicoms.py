"""Reader of DICOM by pydicom, with the decoders of pylibjpeg: slices in spatial order, and their affine."""

import numpy as np
import pydicom

from table import BODY, Reading, columns, from_lps, luminance, rescaled, spaced, unknown


def value(frame, name):
    """Field of a picture, from its functional groups or from the file."""
    for found in frame:
        if name in found:
            return found[name].value
    return None


def frames_of(dataset):
    """Datasets that describe each picture, the most specific first."""
    count = int(dataset.get("NumberOfFrames", 1))
    shared = [item for group in dataset.get("SharedFunctionalGroupsSequence", []) for item in inner(group)]
    groups = dataset.get("PerFrameFunctionalGroupsSequence", [])
    own = [inner(groups[at]) if at < len(groups) else [] for at in range(count)]
    return [found + shared + [dataset] for found in own]


def inner(group):
    """Items of the sequences of a functional group."""
    return [item for element in group if element.VR == "SQ" for item in element.value]


def along(frame):
    """Position of a picture along the normal of the slices."""
    position, orientation = value(frame, "ImagePositionPatient"), value(frame, "ImageOrientationPatient")
    if position is None or orientation is None:
        return None
    row, column = np.array(orientation[:3], dtype=float), np.array(orientation[3:], dtype=float)
    return float(np.dot(np.array(position, dtype=float), np.cross(row, column)))


def pictures(datasets):
    """Pictures of files, each with the datasets that describe it."""
    found = []
    for dataset in datasets:
        voxels = dataset.pixel_array
        frames = frames_of(dataset)
        voxels = voxels if len(frames) > 1 else voxels[None]
        found += list(zip(frames, voxels))
    return found


def read_dicom(path, _choice):
    """Reads a file, or a folder of slices; one slice opens its series."""
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    datasets = [pydicom.dcmread(file) for file in files]
    if not path.is_dir() and int(datasets[0].get("NumberOfFrames", 1)) == 1:
        series = datasets[0].get("SeriesInstanceUID")
        others = [pydicom.dcmread(file) for file in path.parent.glob("*.dcm") if file != path]
        datasets += [other for other in others if series and other.get("SeriesInstanceUID") == series]
    for dataset in datasets:
        # A missing transfer syntax is the default of the standard.
        if "TransferSyntaxUID" not in dataset.file_meta:
            dataset.file_meta.TransferSyntaxUID = pydicom.uid.ImplicitVRLittleEndian
    found = pictures(datasets)
    places = [along(frame) for frame, _ in found]
    is_placed = None not in places and (len(found) == 1 or max(places) - min(places) > 1e-6)
    if is_placed:
        found = [found[at] for at in np.argsort(places, kind="stable")]
    frame, voxels = found[0][0], np.stack([voxels for _, voxels in found])
    if voxels.ndim == 4:
        voxels = luminance(voxels)
    else:
        voxels = scaled(voxels, [frame for frame, _ in found])
    # Decoders of lossy compression may differ in the last bit.
    is_lossy = datasets[0].file_meta.TransferSyntaxUID in LOSSY
    return Reading(voxels, *place([frame for frame, _ in found], is_placed), 1.0 if is_lossy else 0.0)


LOSSY = (pydicom.uid.JPEGBaseline8Bit, pydicom.uid.JPEGExtended12Bit, pydicom.uid.JPEG2000)


def scaled(voxels, frames):
    """Values after the slope and intercept of each picture."""
    scales = [(float(value(f, "RescaleSlope") or 1), float(value(f, "RescaleIntercept") or 0)) for f in frames]
    if len(set(scales)) == 1:
        return rescaled(voxels, *scales[0])
    each = [picture.astype(float) * slope + add for picture, (slope, add) in zip(voxels, scales)]
    return np.stack(each).astype(np.float64 if voxels.dtype.itemsize > 2 else np.float32)


def place(frames, is_placed):
    """Affine of pictures in spatial order."""
    first, last = frames[0], frames[-1]
    spacing = value(first, "PixelSpacing")
    between = value(first, "SpacingBetweenSlices")
    thickness = between or value(first, "SliceThickness")
    if spacing is None:
        return unknown()
    rows, across = (float(length) for length in spacing)
    depth = float(thickness) if thickness else rows
    if not is_placed:
        if len(frames) > 1 and not between:
            return unknown()
        return spaced([across, rows, float(between) if len(frames) > 1 else depth])
    orientation = np.array(value(first, "ImageOrientationPatient"), dtype=float)
    begin, end = (np.array(value(frame, "ImagePositionPatient"), dtype=float) for frame in (first, last))
    normal = np.cross(orientation[:3], orientation[3:])
    step = (end - begin) / (len(frames) - 1) if len(frames) > 1 else normal * depth
    return from_lps(columns(orientation[:3] * across, orientation[3:] * rows, step, begin)), BODY
