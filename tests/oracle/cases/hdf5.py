"""Reference files of HDF5, written by h5py and netCDF4: kinds of storage, filters, types, and conventions of programs.

Addresses of four bytes keep files of the oldest kind below the limit; `docs/decisions/` says what else was compared.
"""

import h5py
import hdf5plugin
import netCDF4
import numpy as np

from cases.sources import small, source

# Storage of an array: of the library's oldest kind, or of its newest. The newest has an index for each of these.
STORAGE = {
    "contiguous": {},
    "chunks": {"chunks": (2, 3, 2)},
    "single": {"chunks": (3, 4, 5)},
    "grows": {"chunks": (1, 2, 3), "maxshape": (None, 4, 5)},
    "grows_x": {"chunks": (1, 2, 3), "maxshape": (3, 8, None)},
    "grows_all": {"chunks": (2, 2, 2), "maxshape": (None, None, None)},
    "deflate": {"chunks": (2, 3, 2), "compression": "gzip"},
    "deflate_single": {"chunks": (3, 4, 5), "compression": "gzip"},
    "deflate_grows": {"chunks": (1, 2, 3), "maxshape": (None, 4, 5), "compression": "gzip"},
    "deflate_grows_all": {"chunks": (2, 2, 2), "maxshape": (None, None, None), "compression": "gzip"},
    "shuffle": {"chunks": (2, 3, 2), "compression": "gzip", "shuffle": True, "fletcher32": True},
    "lzf": {"chunks": (2, 3, 4), "compression": "lzf", "shuffle": True},
    "blosc_lz4": {"chunks": (2, 3, 4), **hdf5plugin.Blosc("lz4", 5, hdf5plugin.Blosc.SHUFFLE)},
    "blosc_zstd": {"chunks": (2, 3, 4), **hdf5plugin.Blosc("zstd", 5, hdf5plugin.Blosc.BITSHUFFLE)},
    "lz4": {"chunks": (2, 3, 4), **hdf5plugin.LZ4()},
    "zstd": {"chunks": (2, 3, 4), **hdf5plugin.Zstd()},
    "bzip2": {"chunks": (2, 3, 4), **hdf5plugin.BZip2()},
}
KINDS = ["uint8", ">u2", "int16", "float32", ">f4", "float64", ">i4", "uint64", "float16", "int8", "complex64", "int64"]


def opened(path, newest=False, userblock=0):
    """File to be written, with short addresses in the oldest kind of storage."""
    if newest:
        return h5py.File(path, "w", libver="latest")
    plan = h5py.h5p.create(h5py.h5p.FILE_CREATE)
    plan.set_userblock(userblock)
    plan.set_sizes(4, 4)
    access = h5py.h5p.create(h5py.h5p.FILE_ACCESS)
    access.set_libver_bounds(h5py.h5f.LIBVER_EARLIEST, h5py.h5f.LIBVER_LATEST)
    return h5py.File(h5py.h5f.create(str(path).encode(), fcpl=plan, fapl=access))


def letters(group, **values):
    """Attributes of Imaris: lists of letters."""
    for name, value in values.items():
        group.attrs[name] = np.array(list(value), dtype="S1")


def imaris(path):
    """Two channels and times at two levels, padded to chunks."""
    voxels = small("uint16", (2, 2, 3, 4, 5))
    with opened(path, newest=True) as file:
        for level in (0, 1):
            for time, channel in np.ndindex(2, 2):
                group = file.create_group(f"DataSet/ResolutionLevel {level}/TimePoint {time}/Channel {channel}")
                held = voxels[time, channel] if level == 0 else voxels[time, channel, :, ::2, ::2]
                padded = np.pad(held, [(0, -n % 4) for n in held.shape])
                group.create_dataset("Data", data=padded, chunks=(4, 4, 4), compression="gzip")
                depth, height, width = held.shape
                letters(group, ImageSizeX=str(width), ImageSizeY=str(height), ImageSizeZ=str(depth))
        ends = {"ExtMin0": "10", "ExtMax0": "12.5", "ExtMin1": "-4", "ExtMax1": "0", "ExtMin2": "0", "ExtMax2": "6"}
        letters(file.create_group("DataSetInfo/Image"), X="5", Y="4", Z="3", Unit="um", **ends)
        letters(file.create_group("DataSetInfo/Channel 0"), Name="DAPI", Color="0.000 0.000 1.000")
        letters(file.create_group("DataSetInfo/Channel 1"), Name="GFP", Color="0.000 1.000 0.000")
    return voxels


def big_data_viewer(path):
    """Two setups at two times and two levels, with their description."""
    voxels = source("uint16", (2, 2, 3, 4, 5))
    with opened(path, newest=True) as file:
        for time, setup in np.ndindex(2, 2):
            for level, held in enumerate((voxels[time, setup], voxels[time, setup, :, ::2, ::2])):
                name = f"t{time:05}/s{setup:02}/{level}/cells"
                file.create_dataset(name, data=held.view("int16") if level == 0 else held.astype("int16"), chunks=(2, 2, 2))
            if time == 0:
                file[f"s{setup:02}/resolutions"] = np.array([[1.0, 1, 1], [2, 2, 1]])
    setups = "".join(
        f"<ViewSetup><id>{number}</id><name>{name}</name><size>5 4 3</size>"
        "<voxelSize><unit>um</unit><size>0.5 0.25 2.0</size></voxelSize></ViewSetup>"
        for number, name in enumerate(("green", "red"))
    )
    path.with_suffix(".xml").write_text(
        '<?xml version="1.0" encoding="UTF-8"?><SpimData version="0.2"><SequenceDescription>'
        f'<ImageLoader format="bdv.hdf5"><hdf5 type="relative">{path.name}</hdf5></ImageLoader>'
        f"<ViewSetups>{setups}</ViewSetups></SequenceDescription></SpimData>\n"
    )
    return voxels


def netcdf(path):
    """Packed numbers with times, coordinates and a fill value."""
    stored = small("int16", (2, 3, 4, 5))
    stored[:, 1, 2, 3] = -999
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        for name, values, unit in (
            ("time", [0.0, 1.0], "days since 2000-01-01"),
            ("z", [0.0, 2.0, 4.0], "m"),
            ("y", [3.0, 2.5, 2.0, 1.5], "m"),
            ("x", [0.0, 0.25, 0.5, 0.75, 1.0], "m"),
        ):
            file.createDimension(name, len(values))
            file.createVariable(name, "f8", (name,))[:] = values
            file[name].units = unit
        variable = file.createVariable("density", "i2", ("time", "z", "y", "x"), fill_value=-999)
        variable.set_auto_maskandscale(False)
        variable.scale_factor, variable.add_offset, variable.units = 0.5, 10.0, "kg m-3"
        variable[:] = stored
    return stored


def nexus(path):
    """Entry with two arrays, one of which is to be shown."""
    voxels = source("float32")
    with opened(path, newest=True) as file:
        file.attrs.update({"NX_class": "NXroot", "default": "entry"})
        entry = file.create_group("entry")
        entry.attrs.update({"NX_class": "NXentry", "default": "data"})
        data = entry.create_group("data")
        data.attrs.update({"NX_class": "NXdata", "signal": "counts", "axes": ["z", "y", "x"]})
        data["counts"] = voxels
        data["errors"] = voxels * 2
        for name, count, step in (("z", 3, 0.5), ("y", 4, 0.25), ("x", 5, 0.125)):
            data[name] = np.arange(count) * step
            data[name].attrs["units"] = "mm"
    return voxels


def matlab(path):
    """Variable of three dimensions as MATLAB stores it: rows are the fastest."""
    held = source("float64", (4, 5, 3))
    with opened(path, userblock=512) as file:
        variable = file.create_dataset("held", data=held.T)
        variable.attrs["MATLAB_class"] = np.bytes_("double")
        text = file.create_dataset("title", data=np.array([[65], [66]], dtype="u2"))
        text.attrs["MATLAB_class"] = np.bytes_("char")
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created by hand".ljust(512))
    return held


def cases(folder):
    """Writes all storage in both kinds, types in turn, and files as programs arrange them."""
    for at, (name, options) in enumerate(STORAGE.items()):
        for newest in (False, True):
            kind = KINDS[(at + 5 * newest) % len(KINDS)]
            voxels = source(kind.lstrip(">")).astype(kind)
            title = f"hdf5_{'new' if newest else 'old'}_{name}.h5"
            with opened(folder / title, newest) as file:
                file.create_dataset("group/voxels" if newest else "voxels", data=voxels, **options)
            yield title, "", None if kind == "complex64" else voxels

    voxels = source("uint16")
    for newest in (False, True):
        title = f"hdf5_{'new' if newest else 'old'}_gaps.h5"
        with opened(folder / title, newest) as file:
            array = file.create_dataset("voxels", shape=(3, 4, 5), dtype="u2", chunks=(2, 2, 2), fillvalue=77)
            array[1:, 2:, 1:3] = voxels[1:, 2:, 1:3]
            held = array[()]
        yield title, "", held
        title = f"hdf5_{'new' if newest else 'old'}_compact.h5"
        with opened(folder / title, newest) as file:
            plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            plan.set_layout(h5py.h5d.COMPACT)
            space = h5py.h5s.create_simple(voxels.shape)
            array = h5py.h5d.create(file.id, b"voxels", h5py.h5t.STD_U16BE, space, dcpl=plan)
            array.write(h5py.h5s.ALL, h5py.h5s.ALL, voxels)
        yield title, "", voxels
    with opened(folder / "hdf5_implicit.h5", newest=True) as file:
        plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        plan.set_chunk((2, 3, 2))
        plan.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
        space = h5py.h5s.create_simple(voxels.shape)
        array = h5py.h5d.create(file.id, b"voxels", h5py.h5t.STD_U16LE, space, dcpl=plan)
        array.write(h5py.h5s.ALL, h5py.h5s.ALL, voxels)
    yield "hdf5_implicit.h5", "", voxels
    times = source("int16", (2, 2, 3, 4, 5))
    with opened(folder / "hdf5_times.h5") as file:
        file["voxels"] = times
    yield "hdf5_times.h5", "--frame 1 --channel 0", times[1, 0]
    with opened(folder / "hdf5_arrays.h5", userblock=1024) as file:
        file["a/first"], file["a/second"], file["matrix"] = source("int16"), source("float32"), np.eye(4)
        file["a/second"].attrs["element_size_um"] = [3.0, 2.0, 1.5]
    yield "hdf5_arrays.h5", "--array a/second", source("float32")
    colors = small("uint8", (3, 4, 5, 3))
    with opened(folder / "hdf5_colors.h5") as file:
        file.create_dataset("voxels", data=colors, chunks=(2, 4, 2, 2))
    yield "hdf5_colors.h5", "--component 1", colors[..., 1]

    voxels = imaris(folder / "hdf5_imaris.ims")
    yield "hdf5_imaris.ims", "--frame 1 --channel 1", voxels[1, 1]
    yield "hdf5_imaris.ims", "--frame 0 --channel 1 --level 1", voxels[0, 1, :, ::2, ::2]
    voxels = big_data_viewer(folder / "hdf5_bdv.h5")
    yield "hdf5_bdv.h5", "--frame 1 --channel 0", voxels[1, 0]
    yield "hdf5_bdv.xml", "--frame 0 --channel 1 --level 1", voxels[0, 1, :, ::2, ::2]
    netcdf(folder / "hdf5_netcdf.nc")
    yield "hdf5_netcdf.nc", "--frame 1", None
    yield "hdf5_nexus.nxs", "", nexus(folder / "hdf5_nexus.nxs")
    held = matlab(folder / "hdf5_matlab.mat")
    yield "hdf5_matlab.mat", "", held.transpose(2, 0, 1)


def refused(folder):
    """Writes files that are refused: what they hold lies elsewhere, or is packed in a way that is not read."""
    voxels = source("uint16", (4, 20, 20))
    with opened(folder / "other_file.h5") as file:
        file["voxels"] = h5py.ExternalLink("other.h5", "/voxels")
    with opened(folder / "bdv_parts.h5", newest=True) as file:
        file["s00/resolutions"] = np.array([[1.0, 1, 1]])
        file["t00000"] = h5py.ExternalLink("part.h5", "/t00000")
    with opened(folder / "other_storage.h5") as file:
        file.create_dataset("voxels", shape=(4, 5, 6), dtype="u1", external=[("../outside.raw", 0, 120)])
    with opened(folder / "virtual.h5", newest=True) as file:
        layout = h5py.VirtualLayout(shape=(4, 5, 6), dtype="u1")
        layout[:] = h5py.VirtualSource("other.h5", "voxels", shape=(4, 5, 6))
        file.create_virtual_dataset("voxels", layout)
    for name, options in (
        ("bitshuffle", hdf5plugin.Bitshuffle()),
        ("blosc2", hdf5plugin.Blosc2()),
    ):
        with opened(folder / f"{name}.h5", newest=True) as file:
            file.create_dataset("voxels", data=np.zeros_like(voxels), chunks=(4, 20, 20), **options)
    with opened(folder / "scale_offset.h5", newest=True) as file:
        file.create_dataset("voxels", data=np.zeros_like(voxels), chunks=(4, 20, 20), scaleoffset=4)
    with opened(folder / "text.h5") as file:
        file["names"], file["list"] = ["a", "b"], np.arange(9)
    with opened(folder / "empty.h5") as file:
        file.create_dataset("voxels", shape=(4, 5, 6), dtype="u2", chunks=(2, 2, 2))
    with opened(folder / "circle.h5") as file:
        group = file.create_group("a")
        group["b"], group["c"] = file, h5py.SoftLink("/a/c")
        file.attrs["default"] = "a/c"
    with opened(folder / "minc.mnc") as file:
        file["minc-2.0/image/0/image"] = voxels
