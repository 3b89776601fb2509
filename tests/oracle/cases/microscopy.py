"""Reference files of TIFF, ImageJ and OME by tifffile, folders of pictures by Pillow, MRC by mrcfile."""

import gzip

import mrcfile
import numpy as np
import tifffile
from PIL import Image

from cases.sources import FLOATS, INTEGERS, small, source


# Fixed, so that files are reproducible.
MARK = {"UUID": "6e0d8a2c-0000-1000-8000-000000000021"}


def cases(folder):
    """Yields file names, choices and the voxels that were written."""
    return [*of_tiff(folder), *of_imagej(folder), *of_ome(folder), *of_pictures(folder), *of_mrc(folder)]


def write(folder, name, data, choice="", expected=None, **options):
    """Writes a file by tifffile, without its own metadata."""
    options = {"photometric": "minisblack", "metadata": None, "software": False} | options
    tifffile.imwrite(folder / name, data, **options)
    return name, choice, data if expected is None else expected


def of_tiff(folder):
    """Writes types, byte orders, compressions, tiles and colours."""
    for kind in INTEGERS + FLOATS + ["float16"]:
        yield write(folder, f"tiff_{kind}.tif", source(kind))
    for kind in ("uint16", "int32", "float32"):
        yield write(folder, f"tiff_{kind}_big.tif", source(kind), byteorder=">")
        yield write(folder, f"tiff_{kind}_64.tif", source(kind), bigtiff=True)
    for packing in ("lzw", "adobe_deflate", "packbits", "zstd"):
        for kind in ("uint8", "int16"):
            yield write(folder, f"tiff_{kind}_{packing}.tif", source(kind), compression=packing)
    for packing in ("lzw", "adobe_deflate", "zstd"):
        for kind in ("uint8", "uint16"):
            name = f"tiff_{kind}_{packing}_differences.tif"
            yield write(folder, name, source(kind), compression=packing, predictor=2)
    for kind in ("float32", "float64"):
        name = f"tiff_{kind}_differences.tif"
        yield write(folder, name, source(kind), compression="adobe_deflate", predictor=3)
    tiled = source("uint8", (2, 20, 25))
    yield write(folder, "tiff_tiles.tif", tiled, tile=(16, 16))
    yield write(folder, "tiff_tiles_lzw.tif", source("int16", (2, 20, 25)) >> 8, tile=(16, 16), compression="lzw")
    yield write(folder, "tiff_strips.tif", source("uint16", (2, 9, 7)), rowsperstrip=2)
    colors = small("uint8", (3, 4, 5, 3))
    yield (*write(folder, "tiff_colors.tif", colors, photometric="rgb")[:2], None)
    planar = np.moveaxis(colors, -1, 1)
    options = {"photometric": "rgb", "planarconfig": "separate"}
    yield (*write(folder, "tiff_colors_planar.tif", planar, "--component 0", colors[..., 0], **options)[:2], None)
    bits = source("uint8", (2, 9, 11)) > 127
    yield write(folder, "tiff_1_bit.tif", bits)
    yield from of_jpeg(folder)
    # With a palette: the indices are the measured values or labels.
    colors = (np.arange(3 * 256).reshape(3, 256) * 83).astype("uint16")
    yield write(folder, "tiff_palette.tif", source("uint8", (2, 5, 7)), photometric="palette", colormap=colors)


def of_jpeg(folder):
    """Writes JPEG in strips and tiles, with tables per strip by tifffile, and with shared tables by Pillow."""
    at = np.arange(2 * 20 * 25).reshape(2, 20, 25)
    # Smooth, as suits lossy compression.
    grey = (128 + 90 * np.sin(at / 60)).astype("uint8")
    options = {"compression": "jpeg", "compressionargs": {"level": 90}}
    for name, layout in (("strips", {"rowsperstrip": 8}), ("tiles", {"tile": (16, 16)}), ("whole", {})):
        yield (*write(folder, f"tiff_jpeg_{name}.tif", grey, **options, **layout)[:2], None)
    across, down = np.meshgrid(np.arange(16), np.arange(13))
    colors = np.stack([5 * across + 60, 255 - 9 * down, 4 * across + 6 * down], axis=-1)[np.newaxis].astype("uint8")
    for name, kind, subsampling in (("rgb", "rgb", (1, 1)), ("ycbcr", "ycbcr", (1, 1)), ("halved", "ycbcr", (2, 2))):
        options["compressionargs"] = {"level": 90, "outcolorspace": kind}
        more = {"photometric": "rgb", "subsampling": subsampling, **options}
        yield (*write(folder, f"tiff_jpeg_{name}.tif", colors, **more)[:2], None)
    for name, pages in (("tables", grey), ("tables_rgb", colors)):
        first, *others = [Image.fromarray(page) for page in pages]
        options = {"compression": "jpeg", "quality": 90, "save_all": True, "append_images": others}
        name = f"tiff_jpeg_{name}.tif"
        first.save(folder / name, **options)
        yield name, "", None


def of_imagej(folder):
    """Writes stacks of ImageJ, with spacing, channels and time steps."""
    for kind in ("uint8", "uint16", "float32"):
        options = {"imagej": True, "resolution": (2.0, 4.0), "metadata": {"axes": "ZYX", "spacing": 3.0, "unit": "um"}}
        yield write(folder, f"imagej_{kind}.tif", source(kind), **options)
    options = {"imagej": True, "resolution": (2.0, 2.0), "metadata": {"axes": "ZYX", "spacing": 0.75}}
    yield write(folder, "imagej_without_unit.tif", source("uint8"), **options)
    many = source("uint16", (2, 3, 2, 4, 5))
    for frame, channel in ((0, 1), (1, 0)):
        options = {"imagej": True, "metadata": {"axes": "TZCYX"}}
        choice = f"--channel {channel} --frame {frame}"
        name = f"imagej_times_{frame}_channels_{channel}.tif"
        yield write(folder, name, many, choice, many[frame, :, channel], **options)


def of_ome(folder):
    """Writes stacks of OME, with spacing, channels and time steps."""
    sizes = {"PhysicalSizeX": 0.5, "PhysicalSizeY": 0.25, "PhysicalSizeZ": 3.0}
    units = {f"PhysicalSize{axis}Unit": "nm" for axis in "XYZ"}
    for kind in ("uint8", "int16", "uint32", "float32"):
        metadata = {"axes": "ZYX", **MARK, **sizes, **(units if kind == "int16" else {})}
        yield write(folder, f"ome_{kind}.ome.tif", source(kind), ome=True, metadata=metadata)
    many = source("uint16", (2, 2, 3, 4, 5))
    for axes in ("TCZYX", "CTZYX"):
        choice = "--channel 1 --frame 0"
        expected = many[0, 1] if axes[0] == "T" else many[1, 0]
        yield write(folder, f"ome_{axes}.ome.tif", many, choice, expected, ome=True, metadata={"axes": axes, **MARK})
    yield write(folder, "ome_big.ome.tif", source("uint16"), ome=True, byteorder=">", metadata={"axes": "ZYX", **MARK})


def of_pictures(folder):
    """Writes slices as separate picture files."""
    for kind, ending in (("uint8", "png"), ("uint16", "png"), ("uint8", "bmp")):
        pile = folder / f"{ending}_{kind}.slices"
        pile.mkdir()
        for at, pixels in enumerate(source(kind, (3, 6, 7))):
            Image.fromarray(pixels).save(pile / f"slice_{at}.{ending}")
        yield pile.name, "", source(kind, (3, 6, 7))


def of_mrc(folder):
    """Writes modes, axis orders, byte orders, cells, origins and stacks."""

    def save(name, data, expected=None, choice="", change=None, size=0.5, stack=False):
        with mrcfile.new(folder / name, data=data, overwrite=True) as file:
            if size:
                file.voxel_size = (size, 2 * size, 3 * size)
            if stack:
                file.set_image_stack()
            if change:
                change(file.header)
            # Removes the creation date, which would change the file in every run.
            file.header.label[:] = b""
            file.header.nlabl = 0
        return name, choice, data if expected is None else expected

    for kind in ("int8", "int16", "float32", "uint16", "float16"):
        yield save(f"mrc_{kind}.mrc", source(kind))
        if kind != "int8":
            data = source(kind)
            yield save(f"mrc_{kind}_big.mrc", data.astype(data.dtype.newbyteorder(">")))
    yield save("mrc_complex64.mrc", source("complex64"), np.abs(source("complex64").astype(complex)).astype("f4"))
    for order in ((1, 2, 3), (1, 3, 2), (2, 1, 3), (2, 3, 1), (3, 1, 2), (3, 2, 1)):

        def change(header, order=order):
            header.mapc, header.mapr, header.maps = order
            header.nxstart, header.nystart, header.nzstart = -2, 3, 5
            # Intervals and lengths belong to the axes of the cell, not to columns, rows and sections.
            header.mx, header.my, header.mz = 10, 12, 14
            header.cella = (5.0, 12.0, 21.0)

        yield save(f"mrc_axes_{''.join(map(str, order))}.map", source("int16"), change=change, size=0)

    def placed(header):
        header.origin = (10.0, -20.0, 30.0)

    yield save("mrc_origin.mrc", source("float32"), change=placed)

    def aslant(header):
        header.cellb = (80.0, 100.0, 110.0)
        header.nxstart, header.nystart, header.nzstart = 1, 2, 3

    yield save("mrc_cell_aslant.mrc", source("int16"), change=aslant)

    def unsaid(header):
        header.cella = (0, 0, 0)

    yield save("mrc_without_cell.mrc", source("int16"), change=unsaid, size=0)
    stack = source("int16", (2, 3, 4, 5))
    yield save("mrc_volumes.mrc", stack, stack[1], "--frame 1")
    with mrcfile.new(folder / "mrc_packed.mrc.gz", data=source("int16"), compression="gzip", overwrite=True) as file:
        file.voxel_size = 1.25
        file.header.label[:] = b""
        file.header.nlabl = 0
    packed = folder / "mrc_packed.mrc.gz"
    packed.write_bytes(gzip.compress(gzip.decompress(packed.read_bytes()), mtime=0))
    yield "mrc_packed.mrc.gz", "", source("int16")
