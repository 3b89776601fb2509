"""Reference files of DICOM, written by pydicom: transfer syntaxes, number types, series, multi-frame files."""

import imagecodecs
import numpy as np
import pydicom
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.encaps import encapsulate
from pydicom.sequence import Sequence

from cases.sources import ORIENTATIONS, ORIGIN, STRAIGHT, small, source

UID = pydicom.uid
# UID root that is free for all uses, with fixed numbers, so that files are reproducible.
ROOT = "2.25."


def dataset(name, pixels, syntax=UID.ExplicitVRLittleEndian, stored=None, high=None):
    """Dataset of one or more pictures, indexed by [frame,] row, column[, colour]."""
    meta = FileMetaDataset()
    meta.TransferSyntaxUID = syntax
    meta.MediaStorageSOPClassUID = UID.SecondaryCaptureImageStorage
    number = sum(ord(letter) * 131**at for at, letter in enumerate(name)) % 10**15
    meta.MediaStorageSOPInstanceUID = ROOT + str(number)
    options = {"is_implicit_VR": syntax.is_implicit_VR, "is_little_endian": syntax.is_little_endian}
    found = FileDataset(name, {}, file_meta=meta, preamble=bytes(128), **options)
    found.SOPClassUID, found.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
    found.SeriesInstanceUID = ROOT + str(number + 1)
    found.Modality = "OT"
    is_color = pixels.shape[-1] == 3
    found.SamplesPerPixel = 3 if is_color else 1
    if is_color:
        found.PlanarConfiguration = 0
    found.PhotometricInterpretation = "RGB" if is_color else "MONOCHROME2"
    found.Rows, found.Columns = pixels.shape[-3:-1] if is_color else pixels.shape[-2:]
    bits = pixels.dtype.itemsize * 8
    found.BitsAllocated, found.BitsStored = bits, stored or bits
    found.HighBit = (high or stored or bits) - 1
    found.PixelRepresentation = int(pixels.dtype.kind == "i")
    if pixels.ndim - is_color == 3:
        found.NumberOfFrames = len(pixels)
    is_big = syntax == UID.ExplicitVRBigEndian
    turned = pixels.astype(pixels.dtype.newbyteorder(">")) if is_big else pixels
    found.PixelData = turned.tobytes()
    found["PixelData"].VR = "OW" if bits > 8 else "OB"
    return found


def lying(found, steps, at, origin=ORIGIN):
    """Adds the plane of a picture of a grid, from the grid's steps in right-anterior-superior millimetres."""
    lps = np.diag([-1.0, -1.0, 1.0])
    lengths = np.linalg.norm(steps, axis=0)
    along = lps @ steps / lengths
    found.ImageOrientationPatient = [f"{number:.10f}" for number in (*along[:, 0], *along[:, 1])]
    position = lps @ (origin + at * steps[:, 2])
    found.ImagePositionPatient = [f"{number:.8f}" for number in position]
    found.PixelSpacing = [f"{lengths[1]:.6f}", f"{lengths[0]:.6f}"]
    found.SliceThickness = f"{lengths[2]:.6f}"
    return found


def save(found, path):
    """Writes a dataset to a file."""
    found.save_as(path, enforce_file_format=True)


def packed(name, pixels, syntax, frames, **options):
    """Dataset of pictures that another library has compressed."""
    found = dataset(name, pixels, syntax, **options)
    found.PixelData = encapsulate([bytes(frame) for frame in frames])
    found["PixelData"].VR = "OB"
    return found


def cases(folder):
    """Yields file names, choices and the voxels that were written."""
    for kind in ("uint8", "uint16", "int16", "uint32", "int32"):
        pixels = source(kind)[0]
        save(lying(dataset(kind, pixels), STRAIGHT, 0), folder / f"dicom_{kind}.dcm")
        yield f"dicom_{kind}.dcm", "", pixels[None]
    for name, syntax in (("implicit", UID.ImplicitVRLittleEndian), ("big", UID.ExplicitVRBigEndian)):
        for kind in ("uint8", "int16"):
            save(lying(dataset(name + kind, source(kind)[0], syntax), STRAIGHT, 0), folder / f"dicom_{kind}_{name}.dcm")
            yield f"dicom_{kind}_{name}.dcm", "", source(kind)[:1]
    pixels = source("int16")
    save(dataset("deflated", pixels, UID.DeflatedExplicitVRLittleEndian), folder / "dicom_deflated.dcm")
    yield "dicom_deflated.dcm", "", pixels
    pixels = source("uint16") & 0x0FFF
    save(dataset("twelve", pixels, stored=12), folder / "dicom_12_bits.dcm")
    yield "dicom_12_bits.dcm", "", pixels
    signed = (source("int16") >> 4).astype("int16")
    # Signed numbers of twelve bits: the bits above them are zero in the file.
    found = dataset("signed", signed, stored=12)
    found.PixelData = (signed.view("uint16") & 0x0FFF).tobytes()
    save(found, folder / "dicom_12_bits_signed.dcm")
    yield "dicom_12_bits_signed.dcm", "", signed
    for name, slope, add in (("whole", 1, -1024), ("half", 0.5, 0), ("tall", 300, 7)):
        found = dataset(name, small("uint16"))
        found.RescaleSlope, found.RescaleIntercept = slope, add
        save(found, folder / f"dicom_scaled_{name}.dcm")
        yield f"dicom_scaled_{name}.dcm", "", small("uint16") * float(slope) + add
    colors = small("uint8", (3, 4, 6, 3))
    save(dataset("colors", colors), folder / "dicom_colors.dcm")
    yield "dicom_colors.dcm", "", None
    planar = dataset("planar", colors)
    planar.PlanarConfiguration, planar.PixelData = 1, np.moveaxis(colors, -1, 1).tobytes()
    save(planar, folder / "dicom_colors_planar.dcm")
    yield "dicom_colors_planar.dcm", "", None
    yield from of_codecs(folder)
    yield from of_places(folder)


def of_codecs(folder):
    """Writes pictures in compressed transfer syntaxes."""
    for kind in ("uint8", "int16", "uint16"):
        found = dataset("rle" + kind, source(kind))
        found.compress(UID.RLELossless, generate_instance_uid=False)
        save(found, folder / f"dicom_rle_{kind}.dcm")
        yield f"dicom_rle_{kind}.dcm", "", source(kind)
    for kind in ("uint8", "uint16"):
        pixels = source(kind, (2, 12, 16))
        for name, syntax, pack in (
            ("jpegls", UID.JPEGLSLossless, imagecodecs.jpegls_encode),
            ("jpeg_lossless", UID.JPEGLosslessSV1, imagecodecs.ljpeg_encode),
            ("jpeg2000", UID.JPEG2000Lossless, lambda p: imagecodecs.jpeg2k_encode(p, codecformat="j2k", level=0)),
        ):
            frames = [pack(np.ascontiguousarray(frame)) for frame in pixels]
            save(packed(name + kind, pixels, syntax, frames), folder / f"dicom_{name}_{kind}.dcm")
            yield f"dicom_{name}_{kind}.dcm", "", pixels
    smooth = np.fromfunction(lambda z, y, x: 20 + 9 * x + 5 * y + 10 * z, (2, 16, 16)).astype("uint8")
    frames = [imagecodecs.jpeg8_encode(frame, level=95) for frame in smooth]
    save(packed("jpeg", smooth, UID.JPEGBaseline8Bit, frames), folder / "dicom_jpeg.dcm")
    yield "dicom_jpeg.dcm", "", smooth
    frames = [imagecodecs.jpeg2k_encode(frame, codecformat="j2k", level=45, reversible=False) for frame in smooth]
    save(packed("j2k", smooth, UID.JPEG2000, frames), folder / "dicom_jpeg2000_lossy.dcm")
    # The error exceeds the difference between decoders.
    yield "dicom_jpeg2000_lossy.dcm", "", None


def of_places(folder):
    """Writes series of slices, each in a folder of its own, and multi-frame files."""
    for name, steps in ORIENTATIONS.items():
        # A series cannot be mirrored: its slices proceed along the normal.
        if np.linalg.det(steps) < 0:
            steps = steps @ np.diag([1.0, 1.0, -1.0])
        series = folder / f"dicom_{name}.dicom-series"
        series.mkdir()
        for at, pixels in enumerate(source("int16")):
            found = lying(dataset(f"{name}{at}", pixels), steps, at)
            found.SeriesInstanceUID = ROOT + "77"
            # Neither file names nor instance numbers are in spatial order.
            found.InstanceNumber = (at * 2) % 3
            save(found, series / f"{(at + 1) % 3}.dcm")
        yield series.name, "", source("int16")
        found = dataset("frames" + name, source("int16"))
        found.SOPClassUID = found.file_meta.MediaStorageSOPClassUID = UID.EnhancedMRImageStorage
        shared, plane = Dataset(), lying(Dataset(), steps, 0)
        orientation, measures = Dataset(), Dataset()
        orientation.ImageOrientationPatient = plane.ImageOrientationPatient
        measures.PixelSpacing, measures.SliceThickness = plane.PixelSpacing, plane.SliceThickness
        shared.PlaneOrientationSequence = Sequence([orientation])
        shared.PixelMeasuresSequence = Sequence([measures])
        found.SharedFunctionalGroupsSequence = Sequence([shared])
        groups = []
        for at in range(3):
            group, position = Dataset(), Dataset()
            position.ImagePositionPatient = lying(Dataset(), steps, at).ImagePositionPatient
            group.PlanePositionSequence = Sequence([position])
            groups.append(group)
        found.PerFrameFunctionalGroupsSequence = Sequence(groups)
        save(found, folder / f"dicom_frames_{name}.dcm")
        yield f"dicom_frames_{name}.dcm", "", source("int16")
