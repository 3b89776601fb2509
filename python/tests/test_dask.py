"""Frames that workers of Dask draw are those of one process, also if a worker is killed."""

import os
import pathlib
import signal
import subprocess
import sys

import numpy as np
import pytest

import chiaroscuro as ch

distributed = pytest.importorskip("dask.distributed")

SOURCE, FRAMES, SIZE = "builtin:chair:32", 6, (96, 72)
EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "batch" / "turntable_dask.py"


def frame_or_death(number, look, mark):
    """Draws a frame; the first worker that is given number 2 is killed."""
    if number == 2 and not os.path.exists(mark):
        pathlib.Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return ch.render_frame(number, volume=SOURCE, look=look, frames=FRAMES, size=SIZE)


def test_workers_draw_the_frames_of_one_process(chair, chair_look, renderer, tmp_path):
    expected = list(ch.turntable(chair, chair_look, frames=FRAMES, size=SIZE, renderer=renderer))
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        frames = client.map(
            frame_or_death, range(FRAMES), look=chair_look, mark=str(tmp_path / "killed"), retries=2, pure=False
        )
        for frame, one in zip(client.gather(frames), expected, strict=True):
            np.testing.assert_array_equal(frame, one)
    assert (tmp_path / "killed").exists()


def test_the_example_writes_all_frames(tmp_path):
    command = [sys.executable, EXAMPLE, SOURCE, tmp_path / "frames", "3"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (tmp_path / "frames").iterdir()) == ["0000.png", "0001.png", "0002.png"]
