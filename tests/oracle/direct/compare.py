"""Compares direct light of the program, at each level of quality, with pictures computed by brute force.

Usage: python compare.py PROGRAM [FOLDER] > direct.tsv   (FOLDER keeps volumes and the oracle's pictures)

Four volumes that are hard to light: a sheet folded as a gyroid, thin shells with holes, opaque tubes over a plate,
and foam of uneven voxels. Needs numpy, scipy, OpenEXR, and a C compiler as `cc`.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import OpenEXR
from scipy import ndimage

HERE = pathlib.Path(__file__).parent
# Pixels along an edge of a picture; the oracle computes every third in the middle of it.
SIZE, FIRST, END, STRIDE = 400, 136, 264, 3
AZIMUTH_DEG, ELEVATION_DEG, FOV_DEG, DISTANCE = -55.0, 24.0, 24.0, 5.0
LIGHT = [-2.2, -1.2, 1.6]
AMBIENT, INTENSITY, SURFACE_GRADIENT = 0.1, 0.9, 0.02
# Steps of the oracle in voxels: halving both changes its pictures by less than 0.1 of 255.
STEP, SHADOW_STEP = 0.08, 0.16


def axes(shape):
    """Coordinates of voxels around the middle, z first."""
    return np.meshgrid(*[np.arange(n) - (n - 1) / 2 for n in shape], indexing="ij")


def gyroid(_random):
    z, y, x = axes((96, 96, 96))
    k = 2 * np.pi / 24
    wave = np.sin(k * x) * np.cos(k * y) + np.sin(k * y) * np.cos(k * z) + np.sin(k * z) * np.cos(k * x)
    ball = np.clip((44 - np.sqrt(x * x + y * y + z * z)) / 2, 0, 1)
    return (255 * np.clip(1.6 - np.abs(wave) / 0.35, 0, 1) * ball).astype(np.uint8)


def shells(_random):
    z, y, x = axes((100, 100, 100))
    r = np.sqrt(x * x + y * y + z * z)
    hole = np.sin(6 * np.arctan2(y, x)) * np.sin(6 * np.arccos(z / r)) > 0.45
    density = np.zeros_like(r)
    for radius in (45, 34, 23):
        density = np.maximum(density, np.where(hole & (r > 25), 0, np.exp(-0.5 * ((r - radius) / 0.8) ** 2)))
    return (255 * density).astype(np.uint8)


def tubes(random):
    shape = (88, 104, 112)
    z, y, x = axes(shape)
    density = np.clip(4 - np.abs(z + 34), 0, 1) * (np.abs(x) < 52) * (np.abs(y) < 48)
    along = np.linspace(0, 1, 240)
    for _ in range(14):
        phase, turns = random.uniform(0, 2 * np.pi, 3), random.integers(1, 3, 2)
        path = [5 + 24 * np.sin(4 * np.pi * along + phase[2])]
        path += [reach * np.sin(2 * np.pi * along * n + p) for reach, n, p in zip((36, 40), turns, phase)]
        on_path = np.zeros(shape, bool)
        on_path[tuple(np.round(p + (n - 1) / 2).astype(int) for p, n in zip(path, shape))] = True
        distance = ndimage.distance_transform_edt(~on_path)
        density = np.maximum(density, np.clip(random.uniform(0.9, 3.2) + 0.9 - distance, 0, 1))
    return (255 * density).astype(np.uint8)


def foam(random):
    # Twice as many slices as are kept, so that bubbles are round in millimetres.
    noise = ndimage.gaussian_filter(random.standard_normal((88, 110, 110)), (3.2, 2.6, 2.6))[::2]
    walls = 1200 * np.clip((0.75 - np.abs(noise / noise.std())) / 0.5, 0, 1)
    walls += 60 * ndimage.gaussian_filter(random.standard_normal(walls.shape), 1)
    # Faces of the grid would be surfaces of their own.
    inside = np.zeros(walls.shape, bool)
    inside[4:-4, 4:-4, 4:-4] = True
    return np.where(inside, walls, walls.min()).astype(np.int16)


# Function, spacing along x, y, z, and control points of opacity per voxel.
VOLUMES = {
    "gyroid": (gyroid, (1, 1, 1), [(80, 0), (130, 0.6), (200, 0.95)]),
    "shells": (shells, (1, 1, 1), [(60, 0), (110, 0.5), (170, 0.9)]),
    "tubes": (tubes, (1, 1, 1), [(90, 0), (150, 0.9), (255, 0.97)]),
    "foam": (foam, (0.6, 0.6, 1.5), [(400, 0), (800, 0.3), (1200, 0.6)]),
}


def write_nrrd(path, values, spacing):
    kind = {"uint8": "uint8", "int16": "int16"}[values.dtype.name]
    sizes = " ".join(str(n) for n in values.shape[::-1])
    spacings = " ".join(str(s) for s in spacing)
    header = f"NRRD0004\ntype: {kind}\ndimension: 3\nsizes: {sizes}\nspacings: {spacings}\n"
    path.write_bytes((header + "encoding: raw\nendian: little\n\n").encode() + values.tobytes())


def oracle(binary, folder, values, spacing, points):
    """Columns x, y, radiance, alpha."""
    low, high = float(values.min()), float(values.max())
    mm_per_unit = max(n * s for n, s in zip(values.shape[::-1], spacing)) / 2
    edges = [s / mm_per_unit for s in spacing]
    a, e = np.radians(AZIMUTH_DEG), np.radians(ELEVATION_DEG)
    back = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0])
    densities = [n for value, opacity in points for n in ((value - low) / (high - low), opacity)]
    parameters = [*values.shape[::-1], *edges, low, high, np.prod(edges) ** (1 / 3), len(points), *densities]
    parameters += [AMBIENT, INTENSITY, SURFACE_GRADIENT, *(np.array(LIGHT) / np.linalg.norm(LIGHT))]
    parameters += [*right, *np.cross(back, right), *back, DISTANCE * np.tan(np.radians(FOV_DEG / 2))]
    parameters += [SIZE, FIRST, END, STRIDE, STEP, SHADOW_STEP]
    voxels = folder / "voxels.f32"
    values.astype("<f4").tofile(voxels)
    text = " ".join(repr(float(p)) if not isinstance(p, int) else str(p) for p in parameters)
    found = subprocess.run([binary, voxels], input=text, capture_output=True, text=True, check=True)
    return np.array([[float(n) for n in line.split()] for line in found.stdout.splitlines()])


def picture(program, volume, points, quality, folder):
    settings = {
        "range": "full",
        "opacity_unit": {"voxels": 1},
        "transfer": {"points": [{"value": v, "opacity": o, "color": [1, 1, 1]} for v, o in points]},
        "shadows.keep_balanced": False,
        "shadows.balance": 1,
        "shading.ambient": AMBIENT,
        "shading.diffuse": 1,
        "shading.specular": 0,
        "shading.surface_gradient": SURFACE_GRADIENT,
        "output.exposure": 1,
        "output.antialiasing": 1,
        "lights": [{"kind": "parallel", "position": LIGHT, "intensity": INTENSITY, "color": [1, 1, 1]}],
        "camera.projection": "orthographic",
        "camera.fit": "height",
        "camera.up": "plus_z",
        "camera.azimuth_deg": AZIMUTH_DEG,
        "camera.elevation_deg": ELEVATION_DEG,
        "camera.roll_deg": 0,
        "camera.fov_y_deg": FOV_DEG,
        "camera.distance": DISTANCE,
        "camera.target": [0, 0, 0],
    }
    out = folder / "picture.exr"
    command = [program, "render", volume, "--as", "scalar", "-o", out, "--transparent", "--size", f"{SIZE}x{SIZE}"]
    command += ["--quality", quality]
    for name, value in settings.items():
        command += ["--set", f"{name}={json.dumps(value)}"]
    subprocess.run(command, check=True, capture_output=True)
    return np.asarray(OpenEXR.File(str(out)).channels()["RGBA"].pixels, dtype=float)


def display(radiance):
    """Values of sRGB, of 255."""
    x = np.clip(radiance, 0, 1)
    return 255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def main(program, folder):
    binary = folder / "direct_light"
    flags = ["-O3", "-march=native", "-ffast-math"]
    subprocess.run(["cc", *flags, "-o", binary, HERE / "direct_light.c", "-lm"], check=True)
    print("volume\tquality\trms of 255\tmean %\t99th percentile\tworst")
    for name, (create, spacing, points) in VOLUMES.items():
        values = create(np.random.default_rng(20261126))
        volume = folder / f"{name}.nrrd"
        write_nrrd(volume, values, spacing)
        # Opacity ends at 0 and stays as it is beyond the last point.
        points = [(float(values.min()), 0), *points]
        if points[-1][0] < values.max():
            points.append((float(values.max()), points[-1][1]))
        right = oracle(binary, folder, values, spacing, points)
        right = right[right[:, 3] > 0.02]
        rows, columns = right[:, 1].astype(int), right[:, 0].astype(int)
        for quality in ("fast", "standard", "fine", "exact"):
            found = picture(program, volume, points, quality, folder)[rows, columns, 0]
            off = np.abs(display(found) - display(right[:, 2]))
            figures = [np.sqrt((off**2).mean()), 100 * (found.mean() / right[:, 2].mean() - 1)]
            figures += [np.percentile(off, 99), off.max()]
            print("\t".join([name, quality, *(f"{f:.2f}" for f in figures)]), flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 2:
        main(sys.argv[1], pathlib.Path(sys.argv[2]))
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(sys.argv[1], pathlib.Path(temporary))
