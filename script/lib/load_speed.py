"""Benchmark of reading and decoding files of common formats, by this program and by others: see script/load-speed.

python load_speed.py FOLDER PROGRAM [ROUNDS]
"""

import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import imagecodecs
import numpy as np
import pydicom
import pydicom.dataset
import pydicom.encaps
import pydicom.uid
import tifffile

EDGE = 512
SLICES = 400
PAGES = 256

PLAIN = pydicom.uid.ExplicitVRLittleEndian
LOSSLESS = pydicom.uid.JPEGLosslessSV1


def field(depth, bits):
    """Yields slices of a ball of material in air, smooth with noise in the low bits, as in measured scans."""
    random = np.random.default_rng(1)
    axis = np.linspace(-1, 1, EDGE, dtype=np.float32)
    x, y = axis[None, :], axis[:, None]
    most = 2**bits - 1
    for z in np.linspace(-1, 1, depth, dtype=np.float32):
        waves = np.sin(5 * x + 3 * z) * np.cos(4 * y - 2 * z) + np.sin(9 * x * y + 4 * z)
        inside = x * x + y * y + z * z < 0.8
        smooth = np.where(inside, 0.5 + 0.17 * waves, 0.02)
        # Standard deviation of the noise as a fraction of the range: 0.01 in material, 0.004 in air.
        noise = random.standard_normal((EDGE, EDGE), dtype=np.float32) * np.where(inside, 0.01, 0.004)
        yield np.clip((smooth + noise) * most, 0, most).astype(np.uint8 if bits == 8 else np.uint16)


def make_raw(folder):
    """Writes bytes, the same compressed by gzip at its default level, also as NRRD, and big-endian 16-bit words."""
    raw = folder / f"field_{EDGE}x{EDGE}x{EDGE}_uint8.raw"
    with raw.open("wb") as out:
        for part in field(EDGE, 8):
            out.write(part.tobytes())
    packed = folder / f"packed_{EDGE}x{EDGE}x{EDGE}_uint8.raw.gz"
    with packed.open("wb") as out:
        subprocess.run(["gzip", "-nc", raw], stdout=out, check=True)
    header = f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {EDGE} {EDGE} {EDGE}\nencoding: gzip\n\n"
    (folder / "field.nrrd").write_bytes(header.encode() + packed.read_bytes())
    big = folder / f"words_{EDGE}x{EDGE}x{PAGES}_uint16.raw"
    with big.open("wb") as out:
        for part in field(PAGES, 16):
            out.write(part.astype(">u2").tobytes())


def make_dicom(folder, syntax):
    """Writes a series of 12 bits as a CT scanner does, with an intercept of −1024."""
    folder.mkdir()
    series, study, frame = (pydicom.uid.generate_uid() for _ in range(3))
    for number, pixels in enumerate(field(SLICES, 12)):
        meta = pydicom.dataset.FileMetaDataset()
        meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
        meta.MediaStorageSOPInstanceUID = pydicom.uid.generate_uid()
        meta.TransferSyntaxUID = syntax
        slice_ = pydicom.dataset.Dataset()
        slice_.file_meta = meta
        slice_.SOPClassUID, slice_.SOPInstanceUID = pydicom.uid.CTImageStorage, meta.MediaStorageSOPInstanceUID
        slice_.StudyInstanceUID, slice_.SeriesInstanceUID, slice_.FrameOfReferenceUID = study, series, frame
        slice_.Modality, slice_.SeriesNumber, slice_.InstanceNumber = "CT", 1, number + 1
        slice_.ImagePositionPatient, slice_.ImageOrientationPatient = [0, 0, 0.7 * number], [1, 0, 0, 0, 1, 0]
        slice_.PixelSpacing = [0.7, 0.7]
        slice_.Rows, slice_.Columns, slice_.SamplesPerPixel = EDGE, EDGE, 1
        slice_.PhotometricInterpretation, slice_.PixelRepresentation = "MONOCHROME2", 0
        slice_.BitsAllocated, slice_.BitsStored, slice_.HighBit = 16, 12, 11
        slice_.RescaleSlope, slice_.RescaleIntercept = 1, -1024
        if syntax == PLAIN:
            slice_.PixelData = pixels.tobytes()
        else:
            packed = imagecodecs.jpeg8_encode(pixels, lossless=True, predictor=1, bitspersample=12)
            slice_.PixelData = pydicom.encaps.encapsulate([packed])
            slice_["PixelData"].is_undefined_length = True
        slice_.save_as(folder / f"{number:04}.dcm", enforce_file_format=True)


def make_tiff(path, predictor):
    """Writes pages in strips of 64 rows, as most programs do."""
    pages = np.stack(list(field(PAGES, 16)))
    tifffile.imwrite(
        path, pages, compression="zlib", predictor=predictor, rowsperstrip=64, photometric="minisblack", metadata=None
    )


def make(folder):
    """Creates the files that are missing. Folders are renamed when complete, so that interrupted ones are redone."""
    folder.mkdir(parents=True, exist_ok=True)
    kinds = {
        "raw": make_raw,
        "dicom": lambda to: make_dicom(to / "series", PLAIN),
        "jpeg": lambda to: make_dicom(to / "series", LOSSLESS),
        "tiff": lambda to: make_tiff(to / "pages.tif", None),
        "predicted": lambda to: make_tiff(to / "pages.tif", 2),
    }
    for name, maker in kinds.items():
        if not (folder / name).exists():
            print("making", folder / name, file=sys.stderr)
            unfinished = folder / f"{name}.{os.getpid()}"
            unfinished.mkdir()
            maker(unfinished)
            unfinished.rename(folder / name)


def piped(*command):
    """Runs a program and discards its output."""
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)


def with_pydicom(folder):
    """Reads and decodes a series with pydicom, in the order of its slices."""
    slices = [pydicom.dcmread(path) for path in folder.iterdir()]
    slices.sort(key=lambda slice_: slice_.ImagePositionPatient[2])
    voxels = np.empty((len(slices), EDGE, EDGE), np.uint16)
    for at, slice_ in enumerate(slices):
        voxels[at] = slice_.pixel_array


def cases(folder):
    """Yields name, file, options of this program, name and call of the other one, and the maximum ratio of times."""
    raw = folder / "raw" / f"field_{EDGE}x{EDGE}x{EDGE}_uint8.raw"
    big = folder / "raw" / f"words_{EDGE}x{EDGE}x{PAGES}_uint16.raw"
    packed = folder / "raw" / f"packed_{EDGE}x{EDGE}x{EDGE}_uint8.raw.gz"
    nrrd = folder / "raw" / "field.nrrd"
    yield "raw, 512³ bytes", raw, [], "cat", lambda: piped("cat", raw), 1.5
    swapped = ["--endian", "big"]
    yield "raw, 512² x 256 words, big-endian", big, swapped, "cat", lambda: piped("cat", big), 1.5
    yield "raw.gz, 512³ bytes", packed, [], "gzip -dc", lambda: piped("gzip", "-dc", packed), 1.2
    # gzip does not read NRRD, so it decodes the same data in a separate file.
    yield "NRRD with gzip, 512³ bytes", nrrd, [], "gzip -dc", lambda: piped("gzip", "-dc", packed), 1.2
    for name, what in [("dicom", "DICOM, 400 x 512²"), ("jpeg", "DICOM, JPEG lossless, 400 x 512²")]:
        series = folder / name / "series"
        yield what, series, [], "pydicom", lambda series=series: with_pydicom(series), 1.0
    for name, what in [("tiff", "TIFF, deflate, 256 x 512²"), ("predicted", "TIFF, deflate, predictor 2")]:
        pages = folder / name / "pages.tif"
        yield what, pages, [], "tifffile", lambda pages=pages: tifffile.imread(pages), 1.2


def ours(program, path, options):
    """Returns the milliseconds in which this program reads all voxels, after an untimed first run."""
    command = [program, "bench", "--only", "read", "--frames", "1", "--json", "--volume", path, *options]
    found = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return json.loads(found.stdout)["cases"][0]["load_ms"]["read"]["median"]


def theirs(call):
    """Returns the milliseconds of a call."""
    start = time.perf_counter()
    call()
    return (time.perf_counter() - start) * 1000


def main():
    """Creates the files and prints a line for each."""
    folder, program = Path(sys.argv[1]), sys.argv[2]
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    make(folder)
    versions = f"pydicom {pydicom.__version__} with pylibjpeg, tifffile {tifffile.__version__} with imagecodecs"
    print(f"{versions} {imagecodecs.__version__}, {os.cpu_count()} cores; medians of {rounds} alternating runs")
    print(f"{'file':<36} {'viewer ms':>9} {'other ms':>10} {'':<10} {'ratio':>6} {'limit':>6}")
    is_within = True
    for what, path, options, other, call, limit in cases(folder):
        call()
        pairs = [(ours(program, path, options), theirs(call)) for _ in range(rounds)]
        ratio = statistics.median(mine / other_ms for mine, other_ms in pairs)
        mine, other_ms = (statistics.median(column) for column in zip(*pairs))
        is_within &= ratio <= limit
        mark = "" if ratio <= limit else "  over"
        print(f"{what:<36} {mine:>9.0f} {other_ms:>10.0f} {other:<10} {ratio:>6.2f} {limit:>6.1f}{mark}", flush=True)
    sys.exit(0 if is_within else 1)


if __name__ == "__main__":
    main()
