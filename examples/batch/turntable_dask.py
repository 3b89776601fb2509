"""Draws one turn with the workers of a Dask cluster: python turntable_dask.py VOLUME FOLDER [FRAMES]

Here the workers are processes of this machine. On a cluster with Slurm, only the lines of the cluster change:

    from dask_jobqueue import SLURMCluster
    cluster = SLURMCluster(cores=1, memory="16GB", walltime="02:00:00", job_extra_directives=["--gres=gpu:1"])
    cluster.scale(jobs=8)

With Ray, the same function is `draw = ray.remote(num_gpus=1)(ch.render_frame)`, the frames are
`ray.get([draw.remote(number, volume=source, look=look, frames=frames) for number in range(frames)])`.
"""

import pathlib
import sys

from dask.distributed import Client, LocalCluster, as_completed
from PIL import Image

import chiaroscuro as ch


def main(source: str, folder: pathlib.Path, frames: int) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    # Lights and brightness are found once, so that all workers draw the same look.
    look = ch.Look.auto(ch.Volume(source))
    # One picture at a time on a worker: it uses the whole card, or all cores.
    with LocalCluster(n_workers=2, threads_per_worker=1) as cluster, Client(cluster) as client:
        numbers = {
            client.submit(ch.render_frame, number, volume=source, look=look, frames=frames, retries=2): number
            for number in range(frames)
        }
        # A worker that ends loses the picture that it was drawing, which another one draws.
        for drawn, picture in as_completed(list(numbers), with_results=True):
            Image.fromarray(picture).save(folder / f"{numbers[drawn]:04}.png")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 72)
