"""Pictures: the same bytes as those of the program, and what the renderer tells."""

import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import chiaroscuro as ch

Image = pytest.importorskip("PIL.Image")

SIZE = (96, 72)


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_one_line_makes_the_bytes_of_the_program(program, renderer, tmp_path):
    picture = ch.render("builtin:chair:32", size=SIZE, renderer=renderer)
    run(program, "render", "builtin:chair:32", "-o", tmp_path / "a.png", "--size", "96x72")
    of_program = np.asarray(Image.open(tmp_path / "a.png").convert("RGBA"))
    assert picture.shape == (72, 96, 4)
    assert picture.dtype == np.uint8
    assert picture.std() > 5, "something is seen"
    np.testing.assert_array_equal(picture, of_program)


def test_a_saved_look_makes_the_bytes_of_the_program(program, chair, chair_look, renderer, tmp_path):
    look = chair_look.with_(chair, colormap="viridis", settings={"shadows.strength": 0.6, "camera.roll_deg": 20})
    look.lights[0].direction = (50, 40)
    look.save(tmp_path / "look.json")
    arguments = ["builtin:chair:32", "-o", tmp_path / "a.png", "--size", "96x72", "--session", tmp_path / "look.json"]
    run(program, "render", *arguments, "--transparent", "--samples", 2)
    picture = renderer.render(chair, look, size=SIZE, samples=2, transparent=True)
    of_program = np.asarray(Image.open(tmp_path / "a.png"))
    assert of_program.shape[-1] == 4
    np.testing.assert_array_equal(picture, of_program)
    # The picture carries the look.
    assert ch.Look.load(tmp_path / "a.png") == look
    # The comparison notices a small change.
    look["shadows.strength"] = 0.59
    assert not np.array_equal(renderer.render(chair, look, size=SIZE, samples=2, transparent=True), of_program)


def test_finer_levels_are_drawn_as_the_program_draws_them(program, renderer, tmp_path):
    image = tmp_path / "chair.ome.zarr"
    run(program, "convert", "builtin:chair:256", image)
    coarse = ch.Volume(image, level=1)
    assert coarse.shape == (128, 128, 128)
    look = ch.Look.auto(coarse, renderer=renderer)
    look.save(tmp_path / "look.json")
    # Pixels are finer than the voxels in memory.
    size = (320, 240)
    alone = renderer.render(coarse, look, size=size)
    np.testing.assert_array_equal(ch.render(image, level=1, look=look, size=size, renderer=renderer), alone)
    with ch.Renderer(memory="64 MiB") as paged:
        picture = paged.render(coarse, look, size=size)
        np.testing.assert_array_equal(paged.render(coarse, look, size=size), picture)
    arguments = [
        image,
        "--level",
        1,
        "-o",
        tmp_path / "a.png",
        "--size",
        "320x240",
        "--session",
        tmp_path / "look.json",
    ]
    run(program, "render", *arguments, "--pool", "64MiB", "--out-of-core")
    np.testing.assert_array_equal(picture, np.asarray(Image.open(tmp_path / "a.png").convert("RGBA")))
    assert np.abs(picture.astype(int) - alone).mean() > 0.1, "a level that was named is shown alone by default"
    for wrong in ("64 MB", "", 0, "-1"):
        with pytest.raises(ch.InvalidArgument, match="memory"):
            ch.Renderer(memory=wrong)


def test_a_turn_makes_the_frames_of_the_program(program, chair, chair_look, renderer, tmp_path):
    chair_look.save(tmp_path / "look.json")
    session = ["--session", tmp_path / "look.json"]
    run(program, "turntable", "builtin:chair:32", "-o", tmp_path / "f", "--frames", 3, "--size", "96x72", *session)
    of_program = [np.asarray(Image.open(path).convert("RGBA")) for path in sorted((tmp_path / "f").glob("*.png"))]
    frames = list(ch.turntable(chair, chair_look, frames=3, size=SIZE, renderer=renderer))
    assert len(frames) == len(of_program) == 3
    for number, (frame, expected) in enumerate(zip(frames, of_program, strict=True)):
        np.testing.assert_array_equal(frame, expected)
        alone = ch.render_frame(number, "builtin:chair:32", chair_look, frames=3, size=SIZE)
        np.testing.assert_array_equal(alone, expected)
    assert not np.array_equal(frames[0], frames[1])


def test_the_light_volume_is_that_of_the_program(program, chair, chair_look, renderer, tmp_path):
    chair_look.save(tmp_path / "look.json")
    session = ["--session", tmp_path / "look.json", "--light", 0]
    run(program, "light-volume", "builtin:chair:32", "-o", tmp_path / "light.nrrd", *session)
    light = renderer.light_volume(chair, chair_look)
    assert light.dtype == np.float32
    assert light.ndim == 3
    assert 0.0 <= light.min() < 0.1
    assert light.max() <= 1.0
    np.testing.assert_array_equal(light, np.asarray(ch.Volume(tmp_path / "light.nrrd")))
    with pytest.raises(ch.InvalidArgument, match="light 9"):
        renderer.light_volume(chair, chair_look, 9)


def test_linear_light_is_premultiplied(chair, chair_look, renderer):
    light = renderer.render(chair, chair_look, size=SIZE, transparent=True, dtype="float32")
    assert light.shape == (72, 96, 4)
    assert light.dtype == np.float32
    assert light[0, 0].tolist() == [0, 0, 0, 0]
    assert light[..., 3].max() > 0.9
    with pytest.raises(ch.InvalidArgument, match="uint8 or float32"):
        renderer.render(chair, chair_look, dtype="float64")


@pytest.mark.parametrize("wrong", [{"size": (0, 4)}, {"size": (40000, 4)}, {"size": 3}, {"samples": 9}])
def test_sizes_are_checked(chair, chair_look, renderer, wrong):
    with pytest.raises(ch.InvalidArgument, match=next(iter(wrong))):
        renderer.render(chair, chair_look, **{"size": SIZE, **wrong})


def test_arrays_are_drawn_like_files(chair, renderer):
    array = np.asarray(chair)
    again = ch.Volume(array, spacing=chair.spacing_mm, units="mm")
    one, other = (ch.Look.auto(volume, renderer=renderer, quality="fast") for volume in (chair, again))
    # The built-in scene knows its opacity unit, and is else the same.
    other["opacity_unit"], other["camera"] = one["opacity_unit"], one["camera"]
    assert one["range"] == other["range"]
    picture = renderer.render(again, one, size=SIZE)
    assert abs(picture.astype(int) - renderer.render(chair, one, size=SIZE)).max() <= 1


def test_the_camera_fills_no_light_volume(chair, chair_look, renderer):
    look = chair_look.copy()
    for light in range(len(look.lights)):
        look[f"lights.{light}.lock"] = "scene"
    renderer.render(chair, look, size=SIZE)
    before = renderer.stats()["light_volumes_filled"]
    look["camera.azimuth_deg"] = look["camera.azimuth_deg"] + 10
    renderer.render(chair, look, size=SIZE)
    assert renderer.stats()["light_volumes_filled"] == before
    look.lights[0].direction = (0, 60)
    renderer.render(chair, look, size=SIZE)
    assert renderer.stats()["light_volumes_filled"] != before


def test_what_is_seen_is_told(chair, chair_look, renderer):
    size = (640, 480)
    found = renderer.pick(chair, chair_look, (320, 240), size)
    assert found is not None
    index = np.round(found["index"]).astype(int)
    assert np.asarray(chair)[tuple(index)] > 0
    assert all(0 <= share <= 1 for share in found["lights"])
    assert len(found["lights"]) == len(chair_look.lights)
    assert renderer.pick(chair, chair_look, (0, 0), size) is None


def test_several_fields_are_drawn_together(ball, renderer):
    labels = (ball > 0).astype(np.uint8) * (1 + (np.arange(20) > 9).astype(np.uint8))
    plain = ch.Volume(ball)
    scene = ch.Scene(plain, labels=labels)
    look = ch.Look.auto(scene, renderer=renderer, quality="fast")
    assert look["layers.1.blend"] == "tint"
    tinted = renderer.render(scene, look, size=SIZE)
    look["layers.1.visibility"] = "hidden"
    assert not np.array_equal(renderer.render(scene, look, size=SIZE), tinted)
    with pytest.raises(ch.InvalidArgument, match="do not meet"):
        ch.Scene(ch.Volume(ball, scale=1), overlay=ch.Volume(ball, scale=1, translate=(1000, 0, 0)))


def test_a_table_is_hidden():
    z, y, x = np.mgrid[0:24, 0:48, 0:48]
    body = (x - 24) ** 2 + (y - 18) ** 2 < 140
    table = (abs(y - 38) < 2) & (abs(x - 24) < 20)
    ct = np.where(body, 40, np.where(table, 200, -1000)).astype(np.int16)
    volume = ch.Volume(ct, scale=4, kind="ct")
    assert ch.remove_table(volume).shape == volume.shape
    with pytest.warns(UserWarning, match="no table"):
        ch.remove_table(np.where(body, 40, -1000).astype(np.int16), scale=4, kind="ct")


def test_threads_draw_side_by_side(chair, chair_look, renderer):
    expected = renderer.render(chair, chair_look, size=SIZE)
    pictures = {}

    def draw(name, own):
        pictures[name] = own.render(chair, chair_look, size=SIZE)

    with ch.Renderer() as second:
        threads = [threading.Thread(target=draw, args=(at, own)) for at, own in enumerate([renderer, second, renderer])]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert len(pictures) == 3
    for picture in pictures.values():
        np.testing.assert_array_equal(picture, expected)


def test_a_closed_renderer_says_so(chair, chair_look):
    with ch.Renderer() as renderer:
        assert renderer.adapter in repr(renderer)
    with pytest.raises(ch.Error, match="closed"):
        renderer.render(chair, chair_look, size=SIZE)
    with pytest.raises(ch.NoAdapter):
        ch.Renderer(adapter=99)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this system")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_fork_is_told(chair, chair_look, renderer):
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            renderer.render(chair, chair_look, size=SIZE)
            os.write(write, b"drawn")
        except ch.ForkedProcess as error:
            os.write(write, str(error).encode())
        os._exit(0)
    os.waitpid(child, 0)
    assert "spawn" in os.read(read, 1000).decode()


LONG_PICTURE = """
import time
import chiaroscuro as ch
volume = ch.Volume("builtin:cloud:96")
look = ch.Look.auto(volume, settings={"lights": [{"position": [1, 1, 3]}], "output.exposure": 1.0}, quality="fast")
renderer = ch.Renderer()
renderer.render(volume, look, size=(8, 8))
print("drawing", flush=True)
try:
    renderer.render(volume, look, size=(16000, 16000), samples=4)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def test_ctrl_c_ends_a_picture():
    child = subprocess.Popen([sys.executable, "-c", LONG_PICTURE], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "drawing\n"
    threading.Event().wait(0.5)
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline() == "interrupted\n"
    child.wait()


def resident_bytes():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is read from /proc")
def test_pictures_and_volumes_leave_nothing_behind(ball, chair, chair_look, renderer):
    count = int(os.environ.get("CHIAROSCURO_REPEATS", "40"))

    look = chair_look.copy()

    def draw(number):
        look["camera.azimuth_deg"] = float(number)
        look.lights[0].direction = (number % 90, 30)
        renderer.render(chair, look, size=(32, 24))
        ch.Volume(ball)

    for number in range(40):
        draw(number)
    before = resident_bytes()
    for number in range(count):
        draw(number)
    assert resident_bytes() - before < 1 << 20, f"memory grew in {count} pictures and volumes"
