"""Arrays become voxels: order, strides, types, spacing."""

import numpy as np
import pytest

import chiaroscuro as ch


def voxels(array, **options):
    return np.asarray(ch.Volume(array, **options))


def test_order_is_z_y_x(ball):
    volume = ch.Volume(ball, scale=(3, 2, 1), units="mm")
    assert volume.shape == (12, 16, 20)
    assert volume.spacing_mm == (3.0, 2.0, 1.0)
    np.testing.assert_array_equal(np.asarray(volume), ball)


@pytest.mark.parametrize("dtype", ["u1", "i1", "u2", "i2", "u4", "i4", "f4", "f8"])
def test_types_stay(ball, dtype):
    array = ball.astype(dtype)
    assert ch.Volume(array).dtype == array.dtype
    np.testing.assert_array_equal(voxels(array), array)


def test_strides_byte_order_and_protection_do_not_matter(ball):
    protected = ball.copy()
    protected.flags.writeable = False
    for array in [
        np.asfortranarray(ball),
        ball[::2, ::-1, 1::3],
        ball.transpose(2, 0, 1),
        ball.astype(">u2"),
        ball.astype(">f4")[::-1],
        protected,
        np.broadcast_to(ball[0], (5, 16, 20)),
    ]:
        np.testing.assert_array_equal(voxels(array), array)


def test_other_types_become_the_nearest(ball):
    assert ch.Volume(ball > 0).dtype == np.uint8
    assert ch.Volume(ball.astype(np.float16)).dtype == np.float32
    assert ch.Volume(ball.astype(np.int64)).dtype == np.int32
    large = ball.astype(np.int64) + (1 << 40)
    assert ch.Volume(large).dtype == np.float64
    np.testing.assert_array_equal(voxels(large), large)
    with pytest.raises(ch.InvalidArgument, match="real numbers"):
        ch.Volume(ball.astype(complex))


def test_the_volume_does_not_follow_the_array(ball):
    volume = ch.Volume(ball)
    before = ball.copy()
    ball[:] = 7
    np.testing.assert_array_equal(np.asarray(volume), before)


def test_axes_of_length_one_are_left_out(ball):
    assert ch.Volume(ball[None, :, None]).shape == (12, 16, 20)
    for shape in [(4, 4), (2, 4, 4, 4), (4,)]:
        with pytest.raises(ch.InvalidArgument, match="3 dimensions"):
            ch.Volume(np.zeros(shape))
    with pytest.raises(ch.InvalidArgument, match="at least one voxel"):
        ch.Volume(np.zeros((0, 4, 4)))


class LazyArray:
    """Array of which pieces are read when they are asked for, as those of Zarr and Dask."""

    def __init__(self, array, chunks=None):
        self.array, self.reads, self.shape, self.dtype = array, [], array.shape, array.dtype
        if chunks:
            self.chunks = chunks

    def __getitem__(self, index):
        piece = self.array[index]
        self.reads.append(piece.nbytes)
        return piece


def test_lazy_arrays_are_read_slab_by_slab(ball, monkeypatch):
    monkeypatch.setattr("chiaroscuro._arrays.BLOCK_BYTES", 4 * ball[0].nbytes)
    plain, chunked = LazyArray(ball), LazyArray(ball, chunks=(5, 16, 20))
    for lazy in [plain, chunked]:
        np.testing.assert_array_equal(voxels(lazy), ball)
    assert plain.reads == [4 * ball[0].nbytes] * 3
    assert chunked.reads == [5 * ball[0].nbytes] * 2 + [2 * ball[0].nbytes]


def test_scale_has_a_unit_and_array_order(ball):
    volume = ch.Volume(ball, scale=(2, 0.5, 0.25), units="um", translate=(10, 20, 30))
    np.testing.assert_allclose(volume.spacing_mm, (2e-3, 5e-4, 2.5e-4))
    np.testing.assert_allclose(volume.affine[:3, 3], (30e-3, 20e-3, 10e-3))
    assert "2 × 0.5 × 0.25 um" in repr(volume)
    assert ch.Volume(ball, spacing=2).spacing_mm == (2.0, 2.0, 2.0)
    assert "voxels" in repr(ch.Volume(ball))
    for wrong in [{"scale": 0}, {"scale": (1, 2)}, {"units": "parsec"}, {"scale": 1, "spacing": 1}, {"kind": "x"}]:
        with pytest.raises(ch.InvalidArgument):
            ch.Volume(ball, **wrong)


def test_channels_lie_along_an_axis(ball):
    stack = np.stack([ball, ball[::-1], ball.max() - ball])
    assert ch.Volume(stack, channel_axis=0).field_count == 3
    assert ch.Volume(np.moveaxis(stack, 0, -1), channel_axis=-1).field_count == 3
    with pytest.raises(ch.InvalidArgument, match="1 to 4 channels"):
        ch.Volume(np.stack([ball] * 5), channel_axis=0)
    with pytest.raises(ch.InvalidArgument, match="axis of shape"):
        ch.Volume(stack, channel_axis=4)


def test_files_say_what_is_wrong(tmp_path):
    with pytest.raises(ch.UnreadableFile, match="missing.nrrd"):
        ch.Volume(tmp_path / "missing.nrrd")
    broken = tmp_path / "broken.nrrd"
    broken.write_text("NRRD0004\ntype: uint8\n")
    with pytest.raises(ch.UnreadableFile, match="broken.nrrd"):
        ch.Volume(broken)
    with pytest.raises(ch.UnreadableFile):
        ch.Volume("builtin:nothing")
    with pytest.raises(ch.InvalidArgument, match="a file has its own"):
        ch.Volume("builtin:chair", scale=2)


def test_xarray_gives_coordinates_and_units(ball):
    xarray = pytest.importorskip("xarray")
    places = {
        "z": ("z", 2.0 * np.arange(12) + 5, {"units": "um"}),
        "y": ("y", 0.5 * np.arange(16), {"units": "um"}),
        "x": ("x", 0.5 * np.arange(20), {"units": "um"}),
    }
    data = xarray.DataArray(ball, dims=("z", "y", "x"), coords=places, name="actin")
    volume = ch.Volume(data)
    assert volume.name == "actin"
    np.testing.assert_allclose(volume.spacing_mm, (2e-3, 5e-4, 5e-4))
    np.testing.assert_allclose(volume.affine[2, 3], 5e-3)
    uneven = data.assign_coords(z=np.arange(12.0) ** 2)
    with pytest.raises(ch.InvalidArgument, match="evenly spaced"):
        ch.Volume(uneven)


def test_dask_and_zarr_are_read(ball, tmp_path):
    dask = pytest.importorskip("dask.array")
    zarr = pytest.importorskip("zarr")
    stored = zarr.create_array(tmp_path / "a.zarr", shape=ball.shape, chunks=(5, 8, 8), dtype=ball.dtype)
    stored[:] = ball
    for lazy in [dask.from_array(ball, chunks=(5, 7, 9)), stored]:
        np.testing.assert_array_equal(voxels(lazy), ball)


def test_nibabel_and_simpleitk_agree_on_the_place(ball):
    nibabel = pytest.importorskip("nibabel")
    itk = pytest.importorskip("SimpleITK")
    affine = np.array([[-0.8, 0, 0, 40], [0, 0.9, 0, -20], [0, 0, 2, 7], [0, 0, 0, 1]])
    of_nibabel = ch.Volume(nibabel.Nifti1Image(ball.T.astype(np.int16), affine))
    image = itk.GetImageFromArray(ball.astype(np.int16))
    image.SetSpacing((0.8, 0.9, 2))
    # To the left and to the back, where nibabel has right and front.
    image.SetDirection((1, 0, 0, 0, -1, 0, 0, 0, 1))
    image.SetOrigin((-40, 20, 7))
    of_itk = ch.Volume(image)
    for volume in [of_nibabel, of_itk]:
        np.testing.assert_array_equal(np.asarray(volume), ball)
        np.testing.assert_allclose(volume.affine, affine)


def test_tensors_are_taken(ball):
    torch = pytest.importorskip("torch")
    np.testing.assert_array_equal(voxels(torch.from_numpy(ball.astype(np.int16))), ball)
    bfloat16 = torch.from_numpy((ball > 0).astype(np.float32)).to(torch.bfloat16)
    np.testing.assert_array_equal(voxels(bfloat16), ball > 0)
    with pytest.raises(ch.InvalidArgument, match="tensor"):
        ch.Volume(torch.from_numpy(ball.astype(np.float32)).to_sparse())


def test_images_of_vtk_are_taken(ball):
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.ImageData(dimensions=ball.shape[::-1], spacing=(1, 2, 3), origin=(4, 5, 6))
    grid.point_data["values"] = ball.ravel()
    volume = ch.Volume(grid)
    np.testing.assert_array_equal(np.asarray(volume), ball)
    assert volume.spacing_mm == (3.0, 2.0, 1.0)
