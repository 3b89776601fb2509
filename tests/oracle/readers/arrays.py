"""Reader of HDF5 files by h5py and netCDF4, with the conventions of programs as docs/FORMATS.md describes them."""

import h5py

# Registers filters; before netCDF4, which brings a second HDF5 library.
import hdf5plugin  # noqa: F401
import netCDF4
import numpy as np

from table import WORLD, Reading, components, rescaled, spaced, unknown

UNITS = {"m": 1e3, "mm": 1.0, "um": 1e-3}


def read_hdf5(path, choice):
    """Reads HDF5 by the convention that its groups show."""
    if path.suffix == ".xml":
        path = path.with_suffix(".h5")
    if path.suffix == ".nc":
        return read_netcdf(path, choice)
    with h5py.File(path) as file:
        if "DataSetInfo" in file:
            return read_imaris(file, choice)
        if "t00000" in file:
            return read_big_data_viewer(file, choice)
        found = []
        file.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None)
        volumes = [name for name in found if file[name].ndim > 2]
        if "default" in file.attrs:
            group = file[file.attrs["default"]]
            group = group[group.attrs["default"]]
            steps = [np.diff(group[name])[0] * UNITS[group[name].attrs["units"]] for name in reversed(group.attrs["axes"])]
            return Reading(group[group.attrs["signal"]][()], *spaced(steps))
        array = file[choice.get("array", volumes[0])]
        data = array[()]
        if "MATLAB_class" in array.attrs:
            # MATLAB's rows and columns are y and x; it has the slowest dimension last.
            data = data.T.transpose(2, 0, 1)
        place = unknown()
        if "element_size_um" in array.attrs:
            place = spaced(array.attrs["element_size_um"][::-1] * 1e-3)
    if data.dtype == np.uint8 and data.ndim > 3 and data.shape[-1] in (3, 4):
        data = components(data, choice, True)
    for name in ("frame", "channel")[: max(data.ndim - 3, 0)]:
        data = data[int(choice.get(name, 0))]
    return Reading(data, *place)


def text(group, name):
    """Attribute of Imaris: a list of letters."""
    return b"".join(group.attrs[name]).decode()


def read_imaris(file, choice):
    """Volume of an Imaris file, without its padding."""
    level, frame, channel = (choice.get(name, "0") for name in ("level", "frame", "channel"))
    group = file[f"DataSet/ResolutionLevel {level}/TimePoint {frame}/Channel {channel}"]
    x, y, z = (int(text(group, f"ImageSize{axis}")) for axis in "XYZ")
    image = file["DataSetInfo/Image"]
    ends = np.array([[float(text(image, f"Ext{end}{axis}")) for end in ("Min", "Max")] for axis in range(3)])
    steps = (ends[:, 1] - ends[:, 0]) / [x, y, z] * UNITS[text(image, "Unit")]
    affine, _ = spaced(steps)
    affine[:, 3] = ends[:, 0] * UNITS[text(image, "Unit")] + steps / 2
    return Reading(group["Data"][:z, :y, :x], affine, WORLD)


def read_big_data_viewer(file, choice):
    """Volume of BigDataViewer, of unsigned numbers, with the voxel size that the files of `cases/` state."""
    level, frame, setup = (int(choice.get(name, 0)) for name in ("level", "frame", "channel"))
    factors = file[f"s{setup:02}/resolutions"][level]
    data = file[f"t{frame:05}/s{setup:02}/{level}/cells"][()].view("uint16")
    return Reading(data, *spaced(np.array([0.5, 0.25, 2.0]) * factors * 1e-3))


def read_netcdf(path, choice):
    """Variable of a NetCDF file with its coordinates."""
    with netCDF4.Dataset(path) as file:
        variable = next(found for found in file.variables.values() if found.ndim > 2)
        variable.set_auto_maskandscale(False)
        data = variable[int(choice.get("frame", 0))]
        steps = [abs(float(file[name][1] - file[name][0])) * UNITS[file[name].units] for name in variable.dimensions[:0:-1]]
        data = rescaled(np.asarray(data), float(variable.scale_factor), float(variable.add_offset))
    return Reading(data, *spaced(steps))
