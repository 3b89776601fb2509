"""Reference files of VTK images, NumPy arrays, Gaussian cubes, PVM, and RAW files with descriptions."""

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

from cases.sources import FLOATS, INTEGERS, ORIENTATIONS, ORIGIN, STRAIGHT, WIDE, small, source


def cases(folder):
    """Yields file names, choices and the voxels that were written."""
    return [*of_vti(folder), *of_vtk(folder), *of_numpy(folder), *of_cube(folder), *of_bytes(folder)]


def image(data, steps=STRAIGHT, of_cells=False, name="values", first=(0, 0, 0), origin=ORIGIN):
    """Builds an image of vtk from an array."""
    found = vtk.vtkImageData()
    dims = [n + of_cells for n in reversed(data.shape[:3])]
    found.SetExtent(*[number for n, start in zip(dims, first) for number in (start, start + n - 1)])
    lengths = np.linalg.norm(steps, axis=0)
    found.SetSpacing(*lengths)
    found.SetDirectionMatrix(*(steps / lengths).flat)
    found.SetOrigin(*origin)
    array = numpy_to_vtk(np.ascontiguousarray(data).reshape((-1,) + data.shape[3:]), deep=True)
    array.SetName(name)
    (found.GetCellData() if of_cells else found.GetPointData()).AddArray(array)
    return found


def save(found, path, mode="appended", packing="zlib", big=False, base64=True, wide=True):
    """Writes an image of vtk as XML."""
    writer = vtk.vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(found)
    {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary}.get(mode, writer.SetDataModeToAppended)()
    writer.SetCompressorType({None: 0, "zlib": 1, "lz4": 2}[packing])
    writer.SetEncodeAppendedData(base64)
    writer.SetByteOrder(0 if big else 1)
    (writer.SetHeaderTypeToUInt64 if wide else writer.SetHeaderTypeToUInt32)()
    assert writer.Write() == 1, path


def of_vti(folder):
    """Writes types, encodings, compressions, byte orders and directions."""

    def write(name, found, expected, choice="", mode="appended", packing=None, big=False, base64=True, wide=True):
        save(found, folder / name, mode, packing, big, base64, wide)
        return name, choice, expected

    for kind in INTEGERS + WIDE + FLOATS:
        yield write(f"vti_{kind}.vti", image(source(kind)), source(kind))
    for mode in ("ascii", "binary", "appended"):
        for packing in (None, "zlib", "lz4") if mode != "ascii" else (None,):
            for base64 in (True, False) if mode == "appended" else (True,):
                for wide in (True, False):
                    words = [mode, packing or "plain", "base64" if base64 else "raw", "64" if wide else "32"]
                    name = f"vti_{'_'.join(words)}.vti"
                    found = image(source("int16"))
                    yield write(name, found, source("int16"), "", mode, packing, False, base64, wide)
    for kind in ("int16", "float64"):
        for packing in (None, "zlib"):
            name = f"vti_{kind}_big_{packing or 'plain'}.vti"
            yield write(name, image(source(kind)), source(kind), packing=packing, big=True, base64=False)
    for name, steps in ORIENTATIONS.items():
        yield write(f"vti_{name}.vti", image(source("int16"), steps, first=(2, -1, 4)), source("int16"))
    yield write("vti_cells.vti", image(source("int16"), of_cells=True), source("int16"))
    colors = small("uint8", (3, 4, 5, 3))
    yield write("vti_colors.vti", image(colors), colors[..., 1], "--component 1")
    two = image(source("int16"), name="first")
    second = numpy_to_vtk(source("float32").reshape(-1), deep=True)
    second.SetName("second")
    two.GetPointData().AddArray(second)
    yield write("vti_two.vti", two, source("float32"), "--array second")


def of_vtk(folder):
    """Writes legacy VTK files as text and as bytes."""
    for kind in ("uint8", "int16", "int32", "float32", "float64"):
        for is_text in (True, False):
            writer = vtk.vtkStructuredPointsWriter()
            name = f"vtk_{kind}_{'text' if is_text else 'bytes'}.vtk"
            writer.SetFileName(str(folder / name))
            points = vtk.vtkStructuredPoints()
            points.DeepCopy(image(source(kind)))
            points.GetPointData().SetActiveScalars("values")
            writer.SetInputData(points)
            (writer.SetFileTypeToASCII if is_text else writer.SetFileTypeToBinary)()
            writer.Write()
            # The writer decides the number of digits in text.
            yield name, "", None if is_text and kind.startswith("float") else source(kind)


def of_numpy(folder):
    """Writes types, byte orders, archives and axis orders."""
    for kind in INTEGERS + WIDE + FLOATS + ["float16", "complex64", "complex128"]:
        np.save(folder / f"numpy_{kind}.npy", source(kind))
        yield f"numpy_{kind}.npy", "", np.abs(source(kind).astype(complex)).astype("f4") if kind.startswith("complex") else source(kind)
    np.save(folder / "numpy_bool.npy", source("uint8") > 127)
    yield "numpy_bool.npy", "", source("uint8") > 127
    for kind in ("uint16", "float64"):
        # In an array [x, y, z] in Fortran order, x is fastest.
        np.save(folder / f"numpy_{kind}_fortran.npy", np.asfortranarray(source(kind).T))
        yield f"numpy_{kind}_fortran.npy", "", source(kind)
        np.save(folder / f"numpy_{kind}_big.npy", source(kind).astype(np.dtype(kind).newbyteorder(">")))
        yield f"numpy_{kind}_big.npy", "", source(kind)
    times = source("int16", (2, 3, 4, 5))
    np.save(folder / "numpy_times.npy", times)
    yield "numpy_times.npy", "--frame 1", times[1]
    np.save(folder / "numpy_picture.npy", source("uint16", (4, 5)))
    yield "numpy_picture.npy", "", source("uint16", (1, 4, 5))
    for name, write in (("stored", np.savez), ("deflated", np.savez_compressed)):
        write(folder / f"numpy_{name}.npz", first=source("uint8"), second=source("float32"))
        for array, kind in (("first", "uint8"), ("second", "float32")):
            yield f"numpy_{name}.npz", f"--array {array}", source(kind)


def of_cube(folder):
    """Writes cubes in Bohr and in Å, with oblique steps, and with orbitals."""

    def write(name, data, steps, sign=1, orbitals=None):
        lines = ["A density", "z fastest", f"{-2 if orbitals else 2} 1.5 -2.25 3.125"]
        counts = reversed(data.shape[-3:])
        lines += [f"{sign * n} " + " ".join(f"{number:.6f}" for number in step) for n, step in zip(counts, steps.T)]
        lines += ["6 6.0 0.0 0.0 0.0", "8 8.0 1.0 0.5 0.25"]
        if orbitals:
            lines.append(" ".join(str(number) for number in (len(orbitals), *orbitals)))
        slowest_first = np.moveaxis(data.T, -1, -1).reshape(-1) if orbitals is None else np.stack(data, -1).transpose(2, 1, 0, 3)
        lines += [f"{number:.5E}" for number in slowest_first.reshape(-1)]
        (folder / name).write_text("\n".join(lines) + "\n")

    data = source("float32")
    written = np.array([float(f"{number:.5E}") for number in data.flat], dtype="f4").reshape(data.shape)
    for name, steps, sign in (("bohr", STRAIGHT, 1), ("angstrom", STRAIGHT, -1), ("aslant", ORIENTATIONS["oblique"], 1)):
        write(f"cube_{name}.cube", data, steps, sign)
        yield f"cube_{name}.cube", "", written
    two = np.stack([data, data[::-1]])
    write("cube_orbitals.cube", two, STRAIGHT, orbitals=(4, 7))
    yield "cube_orbitals.cube", "--channel 1", written[::-1]


def of_bytes(folder):
    """Writes PVM files of three versions, and RAW files without a header or with a description."""
    for version, kind in ((1, "u1"), (2, ">u2"), (3, "u1")):
        data = small("uint16" if kind == ">u2" else "uint8")
        mark = "PVM" + (str(version) if version > 1 else "")
        scale = "" if version == 1 else "1 1 2.5\n"
        header = f"{mark}\n5 4 3\n{scale}{np.dtype(kind).itemsize}\n".encode()
        after = b"A box\0nobody\0none\0none\0" if version == 3 else b""
        (folder / f"pvm_{version}.pvm").write_bytes(header + data.astype(kind).tobytes() + after)
        yield f"pvm_{version}.pvm", "", data
    for kind in INTEGERS + FLOATS:
        source(kind).tofile(folder / f"bare_5x4x3_{kind}.raw")
        yield f"bare_5x4x3_{kind}.raw", "", source(kind)
    for name, format_, kind, steps in (("spaced", "USHORT", "uint16", "0.5 0.5 2"), ("shape", "UCHAR", "uint8", "1 1 2")):
        source(kind).tofile(folder / f"dat_{name}.bin")
        text = f"ObjectFileName: dat_{name}.bin\nResolution: 5 4 3\nSliceThickness: {steps}\nFormat: {format_}\n"
        (folder / f"dat_{name}.dat").write_text(text)
        yield f"dat_{name}.dat", "", source(kind)
    big = source("int16")
    (folder / "ini_big.raw").write_bytes(b"skipped!" + big.astype(">i2").tobytes())
    text = "dimx:5\ndimy:4\ndimz:3\nskip:8\nformat:int16\nendianness:BigEndian\n"
    (folder / "ini_big.raw.ini").write_text(text)
    yield "ini_big.raw.ini", "", big
    source("float32").tofile(folder / "ivf_plain.bin")
    text = (
        '<?xml version="1.0"?><InviwoTreeData><RawFile content="ivf_plain.bin"/><Format content="FLOAT32"/>'
        '<Dimension x="5" y="4" z="3"/></InviwoTreeData>'
    )
    (folder / "ivf_plain.ivf").write_text(text)
    yield "ivf_plain.ivf", "", source("float32")
