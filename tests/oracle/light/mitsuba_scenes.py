"""Renders clouds and slabs with Mitsuba 3, by path tracing, and prints the means of squares of the pictures.

Usage: python mitsuba_scenes.py [SAMPLES] > mitsuba.tsv

Radiometry: a light of intensity 1 gives a white surface that faces it the radiance 1, so its irradiance is π; a sky of
intensity 1 has the radiance 1 everywhere. Matter scatters in all directions alike (phase function 1/4π).
"""

import sys

import mitsuba
import numpy as np

mitsuba.set_variant("scalar_rgb")

# Voxels along each edge of the volumes, which fill the cube from −1 to 1.
N = 24
# The kernel's densities are sampled this many times per voxel, and interpolated linearly between.
FINER = 4
# Pixels along an edge of a picture, and those of the squares of which means are printed.
PIXELS, SQUARE = 32, 8
# Half of the width of what pictures show.
HALF_WIDTH = 1.1
# Directions to the eye, and to the light.
AZIMUTH, ELEVATION = np.radians(35.0), np.radians(25.0)
TO_LIGHT = np.array([1.0, 0.3, 2.0])


def voxels(kind):
    """Densities of 8 bits, x first; the same numbers are computed in tests/rendering/closed_form/outside_renderer.rs."""
    at = np.arange(N)
    x, y, z = np.meshgrid(at, at, at, indexing="ij")
    if kind in ("slab", "hard"):
        thick = 16 if kind == "slab" else 8
        inside = (np.minimum(x, y) >= 3) & (np.maximum(x, y) < N - 3) & (abs(2 * z + 1 - N) < thick)
        return np.where(inside, 1.0, 0.0)
    centred = [(2 * c + 1 - N) / N for c in (x, y, z)]
    falloff = 1.3 * (1.0 - sum(c * c for c in centred))
    waves = 0.6 + 0.4 * np.sin(0.9 * x + 1.0) * np.sin(0.8 * y + 2.0) + 0.3 * np.sin(0.7 * z + 0.2 * x + 3.0)
    return np.floor(255.0 * np.clip(falloff * waves, 0.0, 1.0) + 0.5) / 255.0


def kernel_densities(values):
    """Densities of the cubic B-spline kernel at the middles of finer voxels."""
    place = (np.arange(N * FINER) + 0.5) / FINER - 0.5
    away = np.abs(place[:, None] - np.arange(N)[None, :])
    near = 2.0 / 3.0 - away**2 + away**3 / 2.0
    far = np.clip(2.0 - away, 0.0, None) ** 3 / 6.0
    weights = np.where(away < 1.0, near, far)
    return np.einsum("ai,bj,ck,ijk->cba", weights, weights, weights, values, optimize=True)


def scene(kind, per_voxel, albedo, light):
    """Scene of a medium in a cube, seen by an orthographic camera."""
    transform = mitsuba.ScalarTransform4f
    to_cube = transform().translate([-1, -1, -1]).scale([2, 2, 2])
    grid = kernel_densities(voxels(kind)).astype(np.float32)[..., None]
    eye = np.array([np.cos(ELEVATION) * np.cos(AZIMUTH), np.cos(ELEVATION) * np.sin(AZIMUTH), np.sin(ELEVATION)])
    to_world = transform().look_at(origin=list(4 * eye), target=[0, 0, 0], up=[0, 0, 1])
    emitter = {"type": "constant", "radiance": {"type": "rgb", "value": 1.0}}
    if light == "sun":
        away = list(-TO_LIGHT / np.linalg.norm(TO_LIGHT))
        emitter = {"type": "directional", "direction": away, "irradiance": {"type": "rgb", "value": float(np.pi)}}
    return mitsuba.load_dict({
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": 64, "rr_depth": 1000, "hide_emitters": True},
        "sensor": {
            "type": "orthographic",
            "to_world": to_world @ transform().scale([HALF_WIDTH, HALF_WIDTH, 1]),
            "film": {
                "type": "hdrfilm", "width": PIXELS, "height": PIXELS, "pixel_format": "rgb",
                "rfilter": {"type": "box"},
            },
        },
        "emitter": emitter,
        "cube": {
            "type": "cube",
            "bsdf": {"type": "null"},
            "interior": {
                "type": "heterogeneous",
                "albedo": {"type": "constvolume", "value": {"type": "rgb", "value": albedo}},
                "sigma_t": {
                    "type": "gridvolume", "grid": mitsuba.VolumeGrid(grid), "to_world": to_cube, "raw": True,
                },
                # Voxels per unit of the scene.
                "scale": per_voxel * N / 2,
                "phase": {"type": "isotropic"},
            },
        },
    })


SCENES = [
    ("cloud-sun-50", "cloud", 0.6, [0.5, 0.5, 0.5], "sun"),
    ("cloud-sun-90", "cloud", 0.6, [0.9, 0.9, 0.9], "sun"),
    ("cloud-sun-99", "cloud", 0.6, [0.99, 0.99, 0.99], "sun"),
    ("cloud-sky-90", "cloud", 0.6, [0.9, 0.9, 0.9], "sky"),
    ("cloud-sun-color", "cloud", 0.6, [0.95, 0.76, 0.38], "sun"),
    ("slab-sun-90", "slab", 0.2, [0.9, 0.9, 0.9], "sun"),
    ("slab-sun-99", "slab", 0.2, [0.99, 0.99, 0.99], "sun"),
    ("slab-sky-99", "slab", 0.2, [0.99, 0.99, 0.99], "sky"),
    ("hard-sun-99", "hard", 1.0, [0.99, 0.99, 0.99], "sun"),
    ("hard-sky-99", "hard", 1.0, [0.99, 0.99, 0.99], "sky"),
]


def main():
    samples = int(sys.argv[1]) if len(sys.argv) > 1 else 512
    only = sys.argv[2:]
    print("# Mitsuba", mitsuba.__version__, "volpath, max_depth 64,", samples, "samples per pixel")
    print("# scene, channel, mean, standard error of the mean, means of 4 by 4 squares, row by row from the top left")
    for name, kind, per_voxel, albedo, light in SCENES:
        if only and name not in only:
            continue
        halves = [
            np.array(mitsuba.render(scene(kind, per_voxel, albedo, light), spp=samples // 2, seed=seed))
            for seed in (1, 2)
        ]
        light = 0.5 * (halves[0] + halves[1])
        count = PIXELS // SQUARE
        for channel, color in enumerate("rgb" if len(set(albedo)) > 1 else "r"):
            squares = light[..., channel].reshape(count, SQUARE, count, SQUARE).mean((1, 3))
            apart = (halves[0] - halves[1])[..., channel]
            error = 0.5 * np.sqrt((apart**2).sum()) / apart.size
            numbers = [light[..., channel].mean(), error, *squares.ravel()]
            print("\t".join([name, color] + [f"{number:.5f}" for number in numbers]), flush=True)


main()
