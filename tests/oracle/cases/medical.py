"""Reference files of NRRD by pynrrd and SimpleITK, NIfTI and Analyze by nibabel, MetaImage by SimpleITK."""

import re

import nibabel
import nrrd
import numpy as np
import SimpleITK

from cases.sources import FLOATS, INTEGERS, ORIENTATIONS, ORIGIN, STRAIGHT, WIDE, affine, small, source

LPS = np.diag([-1.0, -1.0, 1.0])


def cases(folder):
    """Yields file names, choices and the voxels that were written."""
    return [*of_nrrd(folder), *of_nifti(folder), *of_metaimage(folder)]


def of_nrrd(folder):
    """Writes types, byte orders, encodings, spaces and other axes."""

    def write(name, data, header=None, choice="", expected=None, **options):
        nrrd.write(str(folder / name), data, header or {}, index_order="C", **options)
        undated(folder / name)
        return name, choice, data if expected is None else expected

    raw = {"encoding": "raw", "spacings": [1.0, 2.0, 3.0]}
    for kind in INTEGERS + WIDE + FLOATS:
        yield write(f"nrrd_{kind}.nrrd", source(kind), raw)
    for kind in ("uint16", "int32", "float32", "float64", "int64"):
        data = source(kind)
        yield write(f"nrrd_{kind}_big.nrrd", data.astype(data.dtype.newbyteorder(">")), raw)
    for encoding in ("gzip", "bzip2", "ascii"):
        for kind in ("int16", "float32"):
            data = np.round(source(kind), 2)
            yield write(f"nrrd_{kind}_{encoding}.nrrd", data, {"encoding": encoding, "spacings": [1.0, 1.0, 2.0]})
        # pynrrd reads text beside a detached header as if it were attached.
        if encoding != "ascii":
            header = {"encoding": encoding, "spacings": [0.5, 0.5, 2.0]}
            yield write(f"nrrd_detached_{encoding}.nhdr", source("int16"), header, detached_header=True)
    yield write("nrrd_detached_raw.nhdr", source("float32"), raw, detached_header=True)
    flips = {"right-anterior-superior": np.eye(3), "left-posterior-superior": LPS}
    flips["left-anterior-superior"] = np.diag([-1.0, 1.0, 1.0])
    for space, flip in flips.items():
        short = "".join(word[0] for word in space.split("-"))
        for name, steps in ORIENTATIONS.items():
            header = {"encoding": "gzip", "space": space, "space directions": (flip @ steps).T}
            header["space origin"] = flip @ ORIGIN
            yield write(f"nrrd_{short}_{name}.nrrd", source("int16"), header)
    yield write("nrrd_nothing_said.nrrd", source("uint8"), {"encoding": "raw"})
    picture = source("uint16", (4, 5))
    yield write("nrrd_picture.nrrd", picture, {"encoding": "raw", "spacings": [0.5, 2.0]}, expected=picture[None])
    colors = small("uint8", (3, 4, 5, 3))
    header = {"encoding": "raw", "kinds": ["RGB-color", "domain", "domain", "domain"]}
    header["spacings"] = [np.nan, 1.0, 1.0, 1.0]
    yield write("nrrd_colors_green.nrrd", colors, header, "--component 1", colors[..., 1])
    yield (*write("nrrd_colors.nrrd", colors, header)[:2], None)
    vectors = source("float32", (3, 4, 5, 3))
    header = {"encoding": "gzip", "kinds": ["vector", "domain", "domain", "domain"], "space": "left-posterior-superior"}
    header["space directions"] = np.vstack([np.full(3, np.nan), (LPS @ STRAIGHT).T])
    header["space origin"] = LPS @ ORIGIN
    yield write("nrrd_vectors.nrrd", vectors, header, expected=np.linalg.norm(vectors.astype(float), axis=-1).astype("f4"))
    times = source("int16", (2, 3, 4, 5))
    header = {"encoding": "gzip", "kinds": ["domain", "domain", "domain", "time"], "spacings": [1, 1, 1, np.nan]}
    yield write("nrrd_times.nrrd", times, header, "--frame 1", times[1])
    gaps = source("float32")
    gaps.flat[3] = np.nan
    yield write("nrrd_not_a_number.nrrd", gaps, {"encoding": "raw", "spacings": [1, 1, 1]})
    for name, steps in ORIENTATIONS.items():
        image = itk(source("float64"), steps)
        SimpleITK.WriteImage(image, str(folder / f"nrrd_itk_{name}.nrrd"), useCompression=True)
        yield f"nrrd_itk_{name}.nrrd", "", source("float64")


def undated(path):
    """Removes the creation date from a file."""
    path.write_bytes(re.sub(rb"# on .*\n", b"", path.read_bytes(), count=1))


def itk(data, steps, origin=ORIGIN, **options):
    """Builds an image of SimpleITK. It refuses mirrored axes, which are therefore not tested."""
    image = SimpleITK.GetImageFromArray(data, **options)
    lengths = np.linalg.norm(steps, axis=0)
    image.SetSpacing([float(length) for length in lengths])
    image.SetDirection([float(number) for number in (LPS @ steps / lengths).flat])
    image.SetOrigin([float(number) for number in LPS @ origin])
    return image


def of_nifti(folder):
    """Writes types, byte orders, both versions, pairs, transforms, scales and time steps."""

    def write(name, image, choice="", expected=None):
        nibabel.save(image, str(folder / name))
        return name, choice, np.asanyarray(image.dataobj).T if expected is None else expected

    place = affine(STRAIGHT)
    for kind in INTEGERS + WIDE + FLOATS:
        yield write(f"nifti_{kind}.nii", nibabel.Nifti1Image(source(kind).T, place, dtype=kind))
    for kind in ("complex64", "complex128"):
        image = nibabel.Nifti1Image(source(kind).T, place, dtype=kind)
        yield write(f"nifti_{kind}.nii", image, expected=np.abs(source(kind).astype(complex)).astype("f4"))
    for kind in ("int16", "uint32", "float32", "float64"):
        header = nibabel.Nifti1Header(endianness=">")
        header.set_data_dtype(kind)
        yield write(f"nifti_{kind}_big.nii", nibabel.Nifti1Image(source(kind).T, place, header))
    for ending in ("nii", "nii.gz"):
        yield write(f"nifti2_int16.{ending}", nibabel.Nifti2Image(source("int16").T, place, dtype="int16"))
    header = nibabel.Nifti2Header(endianness=">")
    header.set_data_dtype("float64")
    yield write("nifti2_float64_big.nii", nibabel.Nifti2Image(source("float64").T, place, header))
    for name, steps in ORIENTATIONS.items():
        for kind in ("sform", "qform", "both"):
            image = nibabel.Nifti1Image(source("int16").T, affine(steps), dtype="int16")
            image.set_sform(affine(steps), code=0 if kind == "qform" else 1)
            # If both transforms are present, the first one counts.
            image.set_qform(affine(np.eye(3) if kind == "both" else steps), code=0 if kind == "sform" else 1)
            image.header.set_xyzt_units("mm")
            yield write(f"nifti_{kind}_{name}.nii.gz", image)
    for unit in ("meter", "micron"):
        image = nibabel.Nifti1Image(source("uint8").T, place, dtype="uint8")
        image.header.set_xyzt_units(unit)
        yield write(f"nifti_{unit}.nii", image)
    image = nibabel.Nifti1Image(source("uint8").T, None, dtype="uint8")
    image.header.set_zooms([1.5, 2.0, 2.5])
    image.header.set_xyzt_units("mm")
    yield write("nifti_distances_alone.nii", image)
    for name, ending in (("plain", ""), ("packed", ".gz")):
        pair = nibabel.Nifti1Pair(source("int16").T, affine(ORIENTATIONS["oblique"]), dtype="int16")
        yield write(f"nifti_pair_{name}.img{ending}", pair)
        yield f"nifti_pair_{name}.hdr{ending}", "", source("int16")
    for name, slope, add in (("whole", 2.0, -1024.0), ("half", 0.5, 0.25), ("wide", 1000.0, 0.0)):
        image = nibabel.Nifti1Image(small("int16").T, place, dtype="int16")
        image.header.set_slope_inter(slope, add)
        yield write(f"nifti_scaled_{name}.nii", image, expected=small("int16") * slope + add)
    colors = small("uint8", (3, 4, 5, 3)).view([("R", "u1"), ("G", "u1"), ("B", "u1")])[..., 0]
    yield write("nifti_colors.nii", nibabel.Nifti1Image(colors.T, place), "--component 2", colors["B"])
    times = source("int16", (2, 3, 4, 5))
    yield write("nifti_times.nii.gz", nibabel.Nifti1Image(times.T, place, dtype="int16"), "--frame 1", times[1])
    for kind in ("uint8", "int16", "int32", "float32"):
        image = nibabel.AnalyzeImage(source(kind).T, None)
        image.header.set_data_dtype(kind)
        image.header.set_zooms([1.5, 2.0, 2.5])
        yield write(f"analyze_{kind}.img", image)
    header = nibabel.AnalyzeHeader(endianness=">")
    header.set_data_dtype("int16")
    image = nibabel.AnalyzeImage(source("int16").T, None, header)
    image.header.set_zooms([1.5, 2.0, 2.5])
    yield write("analyze_int16_big.hdr", image)


def of_metaimage(folder):
    """Writes types, compressions, detached files, orientations, channels and time steps."""

    def write(name, image, expected, choice="", packed=False):
        SimpleITK.WriteImage(image, str(folder / name), useCompression=packed)
        return name, choice, expected

    for kind in INTEGERS + WIDE + FLOATS:
        yield write(f"meta_{kind}.mha", itk(source(kind), STRAIGHT), source(kind))
    for kind in ("uint8", "int16", "float32"):
        yield write(f"meta_{kind}_packed.mha", itk(source(kind), STRAIGHT), source(kind), packed=True)
        yield write(f"meta_{kind}_packed.mhd", itk(source(kind), STRAIGHT), source(kind), packed=True)
        yield write(f"meta_{kind}.mhd", itk(source(kind), STRAIGHT), source(kind))
    for name, steps in ORIENTATIONS.items():
        yield write(f"meta_{name}.mha", itk(source("int16"), steps), source("int16"))
    vectors = source("float32", (3, 4, 5, 3))
    expected = np.linalg.norm(vectors.astype(float), axis=-1).astype("f4")
    yield write("meta_vectors.mha", itk(vectors, STRAIGHT, isVector=True), expected)
    colors = small("uint8", (3, 4, 5, 3))
    yield write("meta_colors.mha", itk(colors, STRAIGHT, isVector=True), colors[..., 1], "--component 1")
    times = SimpleITK.JoinSeries([itk(source(kind), STRAIGHT) for kind in ("int16", "int16")])
    yield write("meta_times.mha", times, source("int16"), "--frame 1")
    for kind in ("uint16", "float64"):
        data = source(kind)
        # SimpleITK writes the byte order of the machine that it runs on.
        image = itk(data, ORIENTATIONS["permuted"])
        SimpleITK.WriteImage(image, str(folder / "turned.mha"))
        written = (folder / "turned.mha").read_bytes()
        (folder / "turned.mha").unlink()
        header = written[: -data.nbytes].replace(b"MSB = False", b"MSB = True")
        turned = data.astype(data.dtype.newbyteorder(">")).tobytes()
        (folder / f"meta_{kind}_big.mha").write_bytes(header + turned)
        yield f"meta_{kind}_big.mha", "", data
