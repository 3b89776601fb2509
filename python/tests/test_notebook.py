"""The widget of notebooks: events of the pointer change the look and the picture."""

import asyncio

import numpy as np
import pytest

import chiaroscuro as ch

pytest.importorskip("jupyter_rfb")

SIZE = (160, 120)


@pytest.fixture
def viewer(chair, chair_look, renderer):
    seen = []
    viewer = ch.Viewer(chair, chair_look, window=False, size=SIZE, renderer=renderer, on_change=seen.append)
    viewer.seen = seen
    return viewer


def send(viewer, kind, **event):
    viewer.picture.handle_event({"event_type": kind, **event})


async def drag(viewer, start, end):
    send(viewer, "pointer_down", x=start[0], y=start[1], button=1)
    for share in (0.5, 1.0):
        x, y = (a + share * (b - a) for a, b in zip(start, end, strict=True))
        send(viewer, "pointer_move", x=x, y=y)
        assert viewer.picture.get_frame().shape[0] < SIZE[1], "a preview has fewer pixels"
    send(viewer, "pointer_up", x=end[0], y=end[1], button=1)
    await asyncio.sleep(0.5)


def test_a_drag_turns_and_comes_to_rest(viewer, chair_look):
    before = viewer.picture.get_frame()
    assert before.shape == (120, 160, 3)
    asyncio.run(drag(viewer, (5, 5), (55, 15)))
    camera, turned = chair_look["camera"], viewer.look["camera"]
    assert turned["azimuth_deg"] == pytest.approx((camera["azimuth_deg"] - 20) % 360)
    assert turned["elevation_deg"] == pytest.approx(camera["elevation_deg"] + 4)
    after = viewer.picture.get_frame()
    assert after.shape == before.shape
    assert not np.array_equal(after, before)
    assert viewer.seen == [viewer.look]
    assert viewer.picture.previews == 2


def test_a_light_follows_the_pointer(viewer, chair_look):
    x, y, side = viewer.picture.disc(0)
    asyncio.run(drag(viewer, (x + 3, y - 2), (100, 40)))
    assert viewer.look["camera"] == chair_look["camera"], "the volume stays"
    assert viewer.picture.disc(0) == pytest.approx((100, 40, side))
    # Beyond the sphere it stays on its edge.
    asyncio.run(drag(viewer, (100, 40), (160, 60)))
    x, y, _ = viewer.picture.disc(0)
    assert (x - 80) ** 2 + (y - 60) ** 2 == pytest.approx((0.42 * 120) ** 2)


def test_the_wheel_moves_the_camera(viewer, chair_look):
    async def turn():
        send(viewer, "wheel", x=1, y=1, dx=0, dy=100)
        for _ in range(200):
            send(viewer, "wheel", x=1, y=1, dx=0, dy=-100)
        await asyncio.sleep(0.5)

    distance = chair_look["camera.distance"]
    asyncio.run(turn())
    assert viewer.look["camera.distance"] == 0.05 < distance


def test_sliders_change_the_look(viewer):
    _, sliders = viewer._widget.children
    exposure, shadows = sliders.children

    async def slide():
        exposure.value, shadows.value = 0.5, 0.25
        await asyncio.sleep(0.5)

    asyncio.run(slide())
    assert viewer.look["output.exposure"] == pytest.approx(0.5)
    assert viewer.look["shadows.strength"] == pytest.approx(0.25)


def test_the_snapshot_has_no_discs(viewer, chair, renderer):
    picture = viewer.snapshot(SIZE)
    np.testing.assert_array_equal(picture, renderer.render(chair, viewer.look, size=SIZE))
    assert not np.array_equal(picture[..., :3], viewer.picture.get_frame())
