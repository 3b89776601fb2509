"""Zarr and OME-Zarr as zarr-python writes them: voxels, spacing and choices are equal.

More than a hundred files: two versions of the format, all number types, all codecs, chunks that do not divide the
array, shards, orders of axes and bytes.
"""

import itertools
import shutil
import zipfile

import numpy as np
import pytest

import chiaroscuro as ch

zarr = pytest.importorskip("zarr")
numcodecs = pytest.importorskip("numcodecs")

SHAPE = (21, 34, 45)
CHUNKS = (8, 16, 20)
COMPRESSIONS = ("lz4", "lz4hc", "zstd", "zlib", "blosclz")


def voxels(dtype):
    z, y, x = np.indices(SHAPE)
    values = 60 + 40 * np.sin(z / 5) + 30 * np.cos(y / 7) + x + np.random.default_rng(1).normal(0, 2, SHAPE)
    return values.astype(dtype)


def assert_equal(path, array, **choice):
    volume = ch.Volume(path, **choice)
    np.testing.assert_array_equal(np.asarray(volume), array)
    return volume


def codecs_of_version_2():
    yield "none", None
    yield "zlib", numcodecs.Zlib(5)
    yield "gzip", numcodecs.GZip(5)
    yield "bz2", numcodecs.BZ2(5)
    yield "zstd", numcodecs.Zstd(3)
    yield "lz4", numcodecs.LZ4()
    for compression, shuffle in itertools.product(COMPRESSIONS, range(3)):
        yield f"blosc-{compression}-{shuffle}", numcodecs.Blosc(compression, 5, shuffle)


@pytest.mark.parametrize("dtype", ["u1", "<u2", ">f4"])
@pytest.mark.parametrize(("name", "codec"), list(codecs_of_version_2()))
def test_codecs_of_version_2(tmp_path, name, codec, dtype):
    array = voxels(dtype)
    order, separator = ("F", "/") if len(name) % 2 else ("C", ".")
    path = tmp_path / "a.zarr"
    zarr.create_array(
        path, data=array, chunks=CHUNKS, zarr_format=2, compressors=codec, order=order,
        chunk_key_encoding={"name": "v2", "separator": separator},
    )  # fmt: skip
    assert_equal(path, array)


def codecs_of_version_3():
    from zarr.codecs import BloscCodec, Crc32cCodec, GzipCodec, ZstdCodec

    yield "none", None
    yield "gzip", GzipCodec(level=5)
    yield "zstd", ZstdCodec(level=3)
    yield "zstd-checksum", ZstdCodec(level=3, checksum=True)
    yield "crc32c", [ZstdCodec(), Crc32cCodec()]
    for compression, shuffle in itertools.product(COMPRESSIONS, ("noshuffle", "shuffle", "bitshuffle")):
        yield f"blosc-{compression}-{shuffle}", BloscCodec(cname=compression, clevel=5, shuffle=shuffle)


@pytest.mark.parametrize("is_sharded", [False, True])
@pytest.mark.parametrize(("name", "codec"), list(codecs_of_version_3()))
def test_codecs_of_version_3(tmp_path, name, codec, is_sharded):
    from zarr.codecs import BytesCodec, TransposeCodec

    array = voxels("<f4" if len(name) % 2 else "<u2")
    path = tmp_path / "a.zarr"
    zarr.create_array(
        path, data=array, chunks=CHUNKS, zarr_format=3, compressors=codec,
        shards=(16, 32, 40) if is_sharded else None,
        filters=[TransposeCodec(order=(2, 0, 1))] if len(name) % 3 else None,
        serializer=BytesCodec(endian="big" if len(name) % 5 else "little"),
    )  # fmt: skip
    assert_equal(path, array)


@pytest.mark.parametrize("dtype", ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8"])
@pytest.mark.parametrize("version", [2, 3])
def test_number_types(tmp_path, dtype, version):
    array = voxels(dtype)
    path = tmp_path / "a.zarr"
    zarr.create_array(path, data=array, chunks=(21, 16, 45), zarr_format=version)
    volume = ch.Volume(path)
    np.testing.assert_array_equal(np.asarray(volume), array.astype(volume.dtype))


def axes(names, unit="micrometer"):
    kinds = {"t": "time", "c": "channel"}
    return [{"name": n, "type": kinds.get(n, "space")} | ({} if n in kinds else {"unit": unit}) for n in names]


def image(path, version):
    """Writes an image of two channels and three levels."""
    group = zarr.open_group(path, mode="w", zarr_format=version)
    base = np.stack([voxels("u2"), voxels("u2") // 2])
    levels = [base, base[:, ::2, ::2, ::2], base[:, ::4, ::4, ::4]]
    datasets = []
    for at, array in enumerate(levels):
        made = group.create_array(
            str(at), shape=array.shape, dtype=array.dtype, chunks=(1, 8, 16, 16), fill_value=0,
            **({"shards": (1, 16, 32, 32)} if version == 3 else {}),
        )  # fmt: skip
        made[:] = array
        factor = 2**at
        transforms = [{"type": "scale", "scale": [1, 2 * factor, 0.5 * factor, 0.5 * factor]}]
        datasets.append({"path": str(at), "coordinateTransformations": transforms})
    multiscales = [{"name": "cells", "axes": axes("czyx"), "datasets": datasets}]
    omero = {"channels": [{"label": "DAPI", "color": "0000FF"}, {"label": "GFP", "color": "00FF00"}]}
    if version == 3:
        group.attrs["ome"] = {"version": "0.5", "multiscales": multiscales, "omero": omero}
    else:
        group.attrs["multiscales"] = [multiscales[0] | {"version": "0.4"}]
        group.attrs["omero"] = omero
    return levels


@pytest.mark.parametrize("version", [2, 3])
def test_images_have_levels_and_channels(tmp_path, version):
    path = tmp_path / "cells.ome.zarr"
    levels = image(path, version)
    for at, array in enumerate(levels):
        volume = assert_equal(path, array[1], channel=1, level=at)
        factor = 2**at
        np.testing.assert_allclose(volume.spacing_mm, [2e-3 * factor, 0.5e-3 * factor, 0.5e-3 * factor])
    assert ch.Volume(path, channel=0).shape == SHAPE, "the finest level fits"
    with pytest.raises(ch.Error, match="2 channels.*DAPI"):
        ch.Volume(path)
    with pytest.raises(ch.Error, match="resolution levels"):
        ch.Volume(path, channel=0, level=7)


def test_archives_are_read(tmp_path):
    path = tmp_path / "cells.ome.zarr"
    levels = image(path, 3)
    archive = tmp_path / "cells.zarr.zip"
    with zipfile.ZipFile(archive, "w") as out:
        for file in sorted(path.rglob("*")):
            if file.is_file():
                out.write(file, file.relative_to(tmp_path), zipfile.ZIP_DEFLATED if "c" in file.parts else None)
    assert_equal(archive, levels[2][0], channel=0, level=2)


def test_other_levels_are_not_read(tmp_path):
    path = tmp_path / "cells.ome.zarr"
    levels = image(path, 3)
    shutil.rmtree(path / "0" / "c")
    shutil.rmtree(path / "1" / "c")
    assert_equal(path, levels[2][1], channel=1, level=2)
