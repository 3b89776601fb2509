"""Readers of VTK images and Gaussian cubes by vtk; of PVM and RAW descriptions, which no library reads, by
definition.
"""

import re
import xml.etree.ElementTree as xml

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from table import VOXELS, WORLD, Reading, columns, length, luminance, spaced, unknown

ANGSTROM = 1e-7
BOHR = 5.29177210903e-8


def read_vtk(path, choice):
    """Reads both forms of VTK images by vtk."""
    reader = vtk.vtkXMLImageDataReader() if path.suffix == ".vti" else vtk.vtkStructuredPointsReader()
    reader.SetFileName(str(path))
    if path.suffix == ".vtk":
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
        reader.ReadAllVectorsOn()
    reader.Update()
    image = reader.GetOutput()
    found = []
    parts = [(image.GetPointData(), False), (image.GetCellData(), True)]
    content = path.read_bytes()
    # Choices count arrays in the order of the file.
    if content.find(b"CELL_DATA") < content.find(b"POINT_DATA"):
        parts.reverse()
    for data, of_cells in parts:
        arrays = [data.GetArray(at) for at in range(data.GetNumberOfArrays())]
        found += [(array, of_cells) for array in arrays if array is not None]
    wanted = choice.get("array", "0")
    named = [pair for pair in found if pair[0].GetName() == wanted]
    array, of_cells = named[0] if named else found[int(wanted)]
    dims = [max(n - 1, 1) if of_cells else n for n in image.GetDimensions()]
    voxels = vtk_to_numpy(array)
    voxels = voxels.reshape(tuple(reversed(dims)) + voxels.shape[1:])
    if voxels.ndim == 4 and "component" in choice:
        voxels = voxels[..., int(choice["component"])]
    elif voxels.ndim == 4:
        voxels = luminance(voxels) if voxels.dtype == np.uint8 and voxels.shape[-1] in (3, 4) else length(voxels)
    matrix = image.GetDirectionMatrix()
    direction = np.array([[matrix.GetElement(row, column) for column in range(3)] for row in range(3)])
    steps = (direction @ np.diag(image.GetSpacing())).T
    # Cell values are at the centres of cells.
    first = np.array(image.GetExtent()[::2], dtype=float)
    first += [0.5 if of_cells and n > 1 else 0.0 for n in image.GetDimensions()]
    return Reading(voxels, columns(*steps, np.array(image.GetOrigin()) + first @ steps), WORLD)


def read_cube(path, choice):
    """Reads a cube from its text, and checks the values by vtk where that can read the file; vtk supports orthogonal
    steps only.
    """
    lines = path.read_text().splitlines()
    table = [[float(word) for word in line.split()[:4]] for line in lines[2:6]]
    count, origin = table[0][0], np.array(table[0][1:])
    unit = ANGSTROM if table[1][0] < 0 else BOHR
    steps = np.array([row[1:] for row in table[1:]])
    dims = [abs(int(row[0])) for row in table[1:]]
    words = " ".join(lines[6 + abs(int(count)) :]).split()
    orbitals = int(words[0]) if count < 0 else 1
    numbers = np.array([float(word) for word in words[orbitals + 1 if count < 0 else 0 :]], dtype=np.float32)
    voxels = numbers.reshape(dims + [orbitals])[..., int(choice.get("channel", 0))].T
    # vtk does not read negative voxel counts either, which mean Å.
    if orbitals == 1 and table[1][0] > 0:
        reader = vtk.vtkGaussianCubeReader2()
        reader.SetFileName(str(path))
        reader.Update()
        theirs = vtk_to_numpy(reader.GetGridOutput().GetPointData().GetArray(0)).reshape(voxels.shape)
        assert (theirs.astype(np.float32) == voxels).all(), path
    return Reading(voxels, columns(*steps, origin) * unit, WORLD)


def unpacked(packed):
    """Decompresses DDS data, following the description of Stefan Röttger's V3 library."""
    block = bytearray()
    window, held, at = 0, 0, 0

    def take(count):
        nonlocal window, held, at
        while held < count:
            window = (window << 8) | (packed[at] if at < len(packed) else 0)
            at, held = at + 1, held + 8
        held -= count
        found = window >> held
        window &= (1 << held) - 1
        return found

    interleaved, strip = take(2) + 1, take(16) + 1
    last = 0
    while run := take(7):
        width = take(3)
        width += 1 if width else 0
        half = (1 << width) // 2
        for _ in range(run):
            last += take(width) - half
            if strip > 1 and len(block) > strip:
                last += block[-strip] - block[-strip - 1]
            last &= 255
            block.append(last)
    whole = len(block) // interleaved * interleaved
    parts = np.frombuffer(bytes(block[:whole]), dtype=np.uint8).reshape(interleaved, -1)
    return parts.T.tobytes() + bytes(block[whole:])


def read_pvm(path, _choice):
    """Reads PVM: lines of text, then one or two bytes for each voxel, big-endian."""
    content = path.read_bytes()
    if content.startswith(b"DDS v3d\n"):
        content = unpacked(content[8:])
    lines, at = [], 0
    while len(lines) < (3 if content.startswith(b"PVM\n") else 4):
        end = content.index(b"\n", at)
        lines.append(content[at:end].decode())
        at = end + 1
    dims = [int(word) for word in lines[1].split()]
    scale = [float(word) for word in lines[2].split()] if len(lines) == 4 else [1, 1, 1]
    number = np.dtype(">u2") if int(lines[-1]) == 2 else np.dtype("u1")
    voxels = np.frombuffer(content, dtype=number, count=int(np.prod(dims)), offset=at).reshape(dims[::-1])
    return Reading(voxels, *spaced(scale, VOXELS))


TYPES = {
    **{"uchar": "u1", "ushort": "u2", "short": "i2", "float": "f4", "double": "f8", "int": "i4", "uint": "u4"},
    **{"uint8": "u1", "int8": "i1", "uint16": "u2", "int16": "i2", "uint32": "u4", "int32": "i4"},
    **{"float32": "f4", "float64": "f8"},
}


def read_described(path, _choice):
    """Reads raw voxels by NumPy, with the layout from a file name or a short text."""
    place, offset, order = unknown(), 0, "<"
    if path.suffix == ".raw":
        data = path
        dims, kind = re.search(r"(\d+x\d+x\d+)_(\w+)\.raw$", path.name).groups()
        dims = [int(n) for n in dims.split("x")]
    elif path.suffix == ".ivf":
        root = xml.parse(path).getroot()
        data = path.with_name(root.find(".//RawFile").get("content"))
        dims = [int(root.find(".//Dimension").get(axis)) for axis in "xyz"]
        kind = root.find(".//Format").get("content")
    else:
        pairs = dict(re.split(r"\s*[:=]\s*", line, maxsplit=1) for line in path.read_text().splitlines())
        pairs = {key.lower(): said.strip() for key, said in pairs.items()}
        is_ini = path.suffix == ".ini"
        data = path.with_suffix("") if is_ini else path.with_name(pairs["objectfilename"])
        dims = [int(pairs[f"dim{axis}"]) for axis in "xyz"] if is_ini else [int(n) for n in pairs["resolution"].split()]
        kind, offset = pairs["format"], int(pairs.get("skip", 0))
        order = ">" if pairs.get("endianness", "LittleEndian") == "BigEndian" else "<"
        if "slicethickness" in pairs:
            steps = [float(n) for n in pairs["slicethickness"].split()]
            place = spaced(steps, VOXELS if steps[:2] == [1, 1] else WORLD)
    number = np.dtype(order + TYPES[kind.lower()])
    voxels = np.fromfile(data, dtype=number, count=int(np.prod(dims)), offset=offset).reshape(dims[::-1])
    return Reading(voxels, *place)
