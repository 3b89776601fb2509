"""Volumes for the thumbnails of presets, as NRRD: computed from formulas, so that no scans are needed.

python preset_scenes.py FOLDER
python preset_scenes.py strip PICTURE…      removes metadata from PNG pictures

Lengths are in millimetres, x to a body's right, y to its front, z to its head. See script/preset-pictures.
"""

import sys
from pathlib import Path

import numpy as np

SEED = 7


def grid(shape, spacing):
    """Coordinates of voxel centres relative to the centre of the grid, x fastest in the file."""
    axes = [(np.arange(n) - (n - 1) / 2) * spacing for n in shape]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    return x, y, z


def inside(distance, blur):
    """Coverage from the signed distance to a surface: 1 inside, 0 outside, with a ramp of width `blur` between."""
    return np.clip(0.5 - distance / blur, 0.0, 1.0)


def ellipsoid(point, middle, radii):
    """Approximate signed distance to an ellipsoid, exact for a sphere."""
    scaled = [(p - m) / r for p, m, r in zip(point, middle, radii)]
    return (np.sqrt(sum(s * s for s in scaled)) - 1.0) * min(radii)


def segment(point, start, end, radii):
    """Approximate signed distance to a cone with rounded ends."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    along = end - start
    offset = [p - s for p, s in zip(point, start)]
    share = sum(o * a for o, a in zip(offset, along)) / max(float(along @ along), 1e-9)
    share = np.clip(share, 0.0, 1.0)
    away = sum((o - share * a) ** 2 for o, a in zip(offset, along))
    return np.sqrt(away) - (radii[0] + share * (radii[1] - radii[0]))


def path(point, places, radii):
    """Signed distance to a chain of segments."""
    parts = zip(places, places[1:], radii, radii[1:])
    return np.minimum.reduce([segment(point, a, b, (r, s)) for a, b, r, s in parts])


def tree(random, start, towards, length, radius, depth):
    """Yields the segments of a tree with binary branching: (start, end, first radius, last radius)."""
    end = start + towards * length
    yield start, end, radius, radius * 0.8
    if depth == 0:
        return
    for sign in (-1.0, 1.0):
        side = np.cross(towards, random.normal(size=3))
        side /= np.linalg.norm(side)
        turned = towards + sign * side * random.uniform(0.45, 0.9)
        turned /= np.linalg.norm(turned)
        yield from tree(random, end, turned, length * random.uniform(0.7, 0.9), radius * 0.74, depth - 1)


def of_tree(point, segments):
    return np.minimum.reduce([segment(point, a, b, (r, s)) for a, b, r, s in segments])


def noise(random, shape, cells):
    """Smooth value noise with a number of cells along each axis, between −1 and 1."""
    from_cells = random.uniform(-1.0, 1.0, size=(cells + 1,) * 3)
    result = from_cells
    for axis, n in enumerate(reversed(shape)):
        at = np.linspace(0.0, cells - 1e-6, n)
        low = at.astype(int)
        share = at - low
        share = share * share * (3.0 - 2.0 * share)
        share = share.reshape([-1 if a == axis else 1 for a in range(3)])
        result = np.take(result, low, axis) * (1 - share) + np.take(result, low + 1, axis) * share
    return result


def write(folder, name, values, spacing, is_body=False, unit=None):
    kind = {"int16": "int16", "uint8": "uint8", "float32": "float"}[values.dtype.name]
    depth, height, width = values.shape
    lines = [
        "NRRD0005",
        f"type: {kind}",
        "dimension: 3",
        f"sizes: {width} {height} {depth}",
        "encoding: raw",
        "endian: little",
    ]
    if is_body:
        lines.append("space: right-anterior-superior")
        lines.append(f"space directions: ({spacing},0,0) (0,{spacing},0) (0,0,{spacing})")
    else:
        lines.append(f"spacings: {spacing} {spacing} {spacing}")
    if unit:
        lines.append(f'sample units: "{unit}"')
    (folder / f"{name}.nrrd").write_bytes(("\n".join(lines) + "\n\n").encode() + values.tobytes())


def thorax(random):
    """Chest in Hounsfield units: skin, fat, muscle, ribs, spine, lungs with vessels, heart, contrast-filled aorta."""
    shape, spacing = (136, 96, 120), 2.4
    point = x, y, z = grid(shape, spacing)
    # Trunk with rounded shoulders, and a neck.
    taper = np.sqrt(np.clip(1.0 - (np.clip(z - 30.0, 0.0, 104.0) / 105.0) ** 2.6, 0.0, 1.0)) + 1e-3
    wide, deep = 149.0 * taper, 100.0 * np.sqrt(taper)
    body = (np.sqrt((x / wide) ** 2 + (y / deep) ** 2) - 1.0) * np.minimum(wide, deep)
    shoulders = path(point, [(-122, -12, 66), (-60, -16, 98), (60, -16, 98), (122, -12, 66)], [36, 40, 40, 36])
    body = np.minimum(body, np.minimum(shoulders, segment(point, (0, -18, 90), (0, -10, 160), (50, 46))))
    blur = 1.5 * spacing
    hu = -1000.0 + inside(body, blur) * 900.0
    hu += inside(body + 10.0, blur) * 150.0
    lungs = np.minimum(
        ellipsoid(point, (70.0, 0.0, -8.0), (50.0, 66.0, 100.0)),
        ellipsoid(point, (-70.0, 0.0, -8.0), (50.0, 66.0, 100.0)),
    )
    within = inside(lungs, blur)
    hu = hu * (1 - within) - 860.0 * within
    for side in (-1.0, 1.0):
        start = np.array([side * 26.0, -8.0, 6.0])
        for up in (-0.9, -0.2, 0.6):
            towards = np.array([side * 0.8, random.uniform(-0.3, 0.3), up])
            towards /= np.linalg.norm(towards)
            vessels = of_tree(point, list(tree(random, start, towards, 32.0, 4.6, 4)))
            hu = np.maximum(hu, np.where(lungs < 4.0, -1000.0 + 1040.0 * inside(vessels, blur), -1000.0))
    heart = ellipsoid(point, (-18.0, 28.0, -42.0), (46.0, 38.0, 46.0))
    hu = np.maximum(hu, -1000.0 + inside(heart, blur) * 1080.0)
    arch = [(-4, 20, -20), (4, 22, 20), (2, 10, 46), (-8, -16, 52), (-14, -34, 36), (-12, -38, -60), (-8, -38, -144)]
    agent = path(point, arch, [14, 13, 12, 11, 11, 10, 9])
    for places in ([(2, 10, 46), (10, 8, 90), (16, 4, 144)], [(-8, -12, 52), (-14, -8, 95), (-18, -4, 144)],
                   [(2, 10, 46), (40, 4, 84), (96, -6, 92)], [(-8, -14, 52), (-46, -6, 84), (-100, -10, 90)]):
        agent = np.minimum(agent, path(point, places, [7, 6, 5]))
    agent = np.minimum(agent, ellipsoid(point, (-20.0, 30.0, -44.0), (28.0, 22.0, 30.0)))
    hu = np.maximum(hu, -1000.0 + inside(agent, blur) * 1330.0)
    # Vertebrae with discs between them, and processes behind them.
    column = np.sqrt(x**2 + ((y + 62.0) * 1.15) ** 2) - 17.0 + 1.5 * np.cos(2 * np.pi * z / 24.0)
    disc = inside(4.0 - np.abs(((z + 12.0) % 24.0) - 12.0), blur)
    bone = np.where(column < 4.0, inside(column, blur) * (0.25 + 0.75 * disc), 0.0)
    for level in np.arange(-132.0, 140.0, 24.0):
        bone = np.maximum(bone, inside(segment(point, (0, -72, level), (0, -94, level - 9), (4.5, 3.0)), blur))
        for side in (-1, 1):
            wing = segment(point, (0, -70, level), (side * 30, -80, level + 2), (4.5, 3.5))
            bone = np.maximum(bone, inside(wing, blur))
    # Ribs follow the chest wall, and are lower towards the front.
    for level in np.arange(-112.0, 92.0, 24.0):
        angles = np.linspace(-0.47 * np.pi, 0.42 * np.pi, 15)
        open_at = 0.84
        for side in (-1, 1):
            places = [
                (side * 128.0 * open_at * np.cos(a), 96.0 * open_at * np.sin(a), level + 20.0 - 44.0 * (a / np.pi + 0.5))
                for a in angles
            ]
            bone = np.maximum(bone, inside(path(point, places, [4.6] * len(places)), blur))
    bone = np.maximum(bone, inside(path(point, [(0, 82, 62), (0, 88, -46)], [8, 6]), blur))
    for side in (-1, 1):
        bone = np.maximum(bone, inside(path(point, [(side * 8, 74, 74), (side * 96, 30, 98)], [5, 5]), blur))
    hu = np.maximum(hu, -1000.0 + bone * 1650.0)
    hu += random.normal(scale=9.0, size=hu.shape)
    return np.clip(hu, -1024, 3000).astype("<i2"), spacing


def head(random):
    """Head as in a T1-weighted image: bright skin and fat, dark skull, and a brain with folds."""
    shape, spacing = (104, 124, 124), 1.9
    point = x, y, z = grid(shape, spacing)
    blur = 1.6 * spacing
    skin = ellipsoid(point, (0, 0, 12), (78, 96, 92))
    skin = np.minimum(skin, segment(point, (0, 46, -52), (0, 40, -60), (42, 40)))
    skin = np.minimum(skin, segment(point, (0, -14, -60), (0, -20, -130), (50, 54)))
    skin = np.minimum(skin, segment(point, (0, 92, 6), (0, 101, -16), (5, 10)))
    for side in (-1, 1):
        skin = np.minimum(skin, ellipsoid(point, (side * 79, -8, -6), (8, 14, 25)))
        skin = np.maximum(skin, -ellipsoid(point, (side * 32, 98, 12), (17, 13, 11)))
    radius = ellipsoid(point, (0, -2, 24), (68, 84, 70))
    folds = np.sin(0.21 * x + 1.7 * np.sin(0.11 * z)) * np.sin(0.2 * y + 1.5 * np.sin(0.12 * x)) * np.sin(
        0.22 * z + 1.6 * np.sin(0.1 * y)
    )
    brain = radius + 5.0 * np.abs(folds) ** 0.5 - 1.5
    # Fissure between the hemispheres.
    brain = np.maximum(brain, 3.0 - np.abs(x) - np.clip((20.0 - z) / 4.0, 0, 9))
    value = 30.0 * inside(skin, blur) + 170.0 * inside(skin, blur) * inside(-(radius - 16.0), blur)
    value *= 1.0 - 0.25 * inside(np.abs(skin + 12.0) - 6.0, blur)
    skull = inside(np.maximum(radius - 13.0, -(radius - 6.0)), blur)
    value = value * (1 - 0.85 * skull)
    matter = inside(brain, blur)
    value = value * (1 - matter) + matter * (118.0 + 34.0 * inside(radius + 13.0 + 5.0 * folds, 5.0))
    value += random.normal(scale=3.0, size=value.shape)
    return np.clip(value, 0, 255).astype("u1"), spacing


def vessels(random):
    """Arteries of a brain, brighter than its tissue."""
    shape, spacing = (104, 104, 104), 1.0
    point = grid(shape, spacing)
    segments = []
    for start, towards in (((14, 10, -46), (0.1, 0.1, 1)), ((-14, 10, -46), (-0.1, 0.1, 1)), ((0, -14, -46), (0, -0.2, 1))):
        towards = np.array(towards, float)
        segments += list(tree(random, np.array(start, float), towards / np.linalg.norm(towards), 22.0, 2.9, 6))
    tissue = inside(ellipsoid(point, (0, 0, 0), (48, 50, 50)), 4.0) * (60.0 + 12.0 * noise(random, shape, 12))
    value = np.maximum(tissue, 235.0 * inside(of_tree(point, segments), 1.8))
    return np.clip(value + random.normal(scale=3.0, size=value.shape), 0, 255).astype("u1"), spacing


def cells(random):
    """Cells with one dye: bright nuclei, and fibres around them."""
    shape, spacing = (136, 104, 64), 0.001
    point = x, y, z = grid(shape, 1.0)
    value = np.zeros(x.shape)
    for _ in range(11):
        middle = np.array([random.uniform(-52, 52), random.uniform(-38, 38), random.uniform(-14, 14)])
        radii = random.uniform(7, 11, size=3) * (1.2, 1.0, 0.7)
        value = np.maximum(value, inside(ellipsoid(point, middle, radii), 4.0) * random.uniform(150, 235))
        for _ in range(9):
            towards = random.normal(size=3) * (1, 1, 0.35)
            towards /= np.linalg.norm(towards)
            bend = middle + towards * 15 + random.normal(scale=3, size=3)
            thread = path(point, [middle, bend, bend + towards * 14 + random.normal(scale=5, size=3)], [1.3, 1.0, 0.6])
            value = np.maximum(value, inside(thread, 2.0) * random.uniform(70, 130))
    value += 6.0 * (1.0 + noise(random, shape, 9))
    return np.clip(value + random.normal(scale=2.0, size=value.shape), 0, 255).astype("u1"), spacing


def tissue(random):
    """Stained tissue: tubes with nuclei in their walls."""
    shape, spacing = (112, 112, 96), 0.001
    point = x, y, z = grid(shape, 1.0)
    value = 40.0 * (1.0 + 0.5 * noise(random, shape, 10)) * inside(ellipsoid(point, (0, 0, 0), (54, 54, 46)), 3.0)
    for _ in range(7):
        start = random.uniform(-34, 34, size=3)
        towards = random.normal(size=3)
        end = start + 34 * towards / np.linalg.norm(towards)
        tube = segment(point, start, end, (12.0, 12.0))
        value = np.where(tube < 0, np.maximum(value * 0.4, 120.0 * inside(np.abs(tube + 3.5) - 2.5, 2.0)), value)
        for _ in range(34):
            around = np.cross(end - start, random.normal(size=3))
            around *= 8.5 / np.linalg.norm(around)
            nucleus = ellipsoid(point, start + (end - start) * random.uniform() + around, (3.2, 3.2, 3.2))
            value = np.maximum(value, 240.0 * inside(nucleus, 1.5))
    value *= inside(ellipsoid(point, (0, 0, 0), (54, 54, 46)), 3.0)
    return np.clip(value + random.normal(scale=2.0, size=value.shape), 0, 255).astype("u1"), spacing


def spray(random):
    """Jet that widens and breaks up."""
    shape, spacing = (136, 88, 88), 1.0
    x, y, z = grid(shape, 1.0)
    rough = 0.6 * noise(random, shape, 8) + 0.35 * noise(random, shape, 17) + 0.2 * noise(random, shape, 34)
    along = (x + 66.0) / 132.0
    wide = 2.5 + 30.0 * np.clip(along, 0, 1) ** 0.9
    away = np.sqrt(y**2 + z**2) / wide * (1.0 + 0.75 * rough * np.clip(along * 2, 0, 1))
    value = np.exp(-(away**2) * 1.6) * (1.05 - 0.75 * np.clip(along, 0, 1)) * (1.0 + 0.8 * rough)
    value *= inside(-66.0 - x, 2.0) * inside(x - 50.0 - 14.0 * rough, 16.0)
    return np.clip(value * 230.0, 0, 255).astype("u1"), spacing


def orbital(_):
    """Signed field: the clover shape of a d orbital."""
    shape, spacing = (96, 96, 96), 1.0
    x, y, z = (c / 9.0 for c in grid(shape, 1.0))
    value = x * z * np.exp(-np.sqrt(x * x + y * y + z * z) * 1.2)
    return (value * 100.0).astype("<f4"), spacing


def shell(random):
    """Snail with a ribbed shell and dim flesh inside."""
    shape, spacing = (112, 96, 112), 1.0
    point = x, y, z = grid(shape, 1.0)
    distance = np.full(x.shape, 1e9)
    flesh = np.full(x.shape, 1e9)
    for turn in np.linspace(0.0, 3.15 * 2 * np.pi, 150):
        grown = np.exp(0.135 * (turn - 3.15 * 2 * np.pi))
        middle = (31.0 * grown * np.cos(turn), 26.0 * (1 - grown) - 12.0, 31.0 * grown * np.sin(turn))
        away = np.sqrt(sum((p - m) ** 2 for p, m in zip(point, middle)))
        rib = 1.0 + 0.055 * np.cos(turn * 9.0)
        distance = np.minimum(distance, away - 20.0 * grown * rib)
        flesh = np.minimum(flesh, away - 14.0 * grown)
    value = 45.0 * inside(flesh, 3.0)
    value = np.maximum(value, 200.0 * inside(np.abs(distance + 1.6) - 1.7, 1.8))
    value += 22.0 * noise(random, shape, 14) * inside(np.abs(distance + 1.6) - 1.7, 1.8)
    return np.clip(value, 0, 255).astype("u1"), spacing


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for make, is_body, unit in (
        (thorax, True, "HU"),
        (head, True, None),
        (vessels, True, None),
        (cells, False, None),
        (tissue, False, None),
        (spray, False, None),
        (orbital, False, None),
        (shell, False, None),
    ):
        values, spacing = make(np.random.default_rng(SEED))
        write(folder, make.__name__, values, spacing, is_body, unit)


def strip(picture):
    """Removes all chunks from a PNG that are not needed for its pixels, such as the settings of the program."""
    data = picture.read_bytes()
    kept, at = data[:8], 8
    while at < len(data):
        end = at + 12 + int.from_bytes(data[at : at + 4], "big")
        if data[at + 4 : at + 8] in (b"IHDR", b"PLTE", b"IDAT", b"IEND"):
            kept += data[at:end]
        at = end
    picture.write_bytes(kept)


if __name__ == "__main__":
    if sys.argv[1] == "strip":
        for name in sys.argv[2:]:
            strip(Path(name))
    else:
        main(Path(sys.argv[1]))
