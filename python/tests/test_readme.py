"""Scripts of README.md run as they are."""

import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

README = pathlib.Path(__file__).parent.parent / "README.md"
SCRIPTS = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)

#: Packages that scripts need besides Pillow.
PACKAGES = ["skimage", "dask.distributed"]


def test_there_are_six_scripts():
    assert len(SCRIPTS) == 6


@pytest.mark.parametrize("number", range(len(SCRIPTS)))
def test_a_script_runs(number, tmp_path):
    script = SCRIPTS[number]
    for package in PACKAGES:
        if package in script:
            pytest.importorskip(package)
    image = pytest.importorskip("PIL.Image")
    slices = tmp_path / "slices"
    slices.mkdir()
    z, y, x = np.mgrid[-1:1:24j, -1:1:32j, -1:1:32j]
    ball = np.where(x**2 + y**2 + z**2 < 0.6, 1200, 0).astype(np.uint16)
    for at, plane in enumerate(ball):
        image.fromarray(plane).save(slices / f"{at:03}.png")
    (tmp_path / "script.py").write_text(script, encoding="utf-8")
    done = subprocess.run([sys.executable, "script.py"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    made = [path for path in tmp_path.iterdir() if path.suffix in {".png", ".gif", ".npy"}]
    assert made, "the script wrote nothing"
    for path in made:
        if path.suffix == ".png":
            assert np.asarray(image.open(path).convert("RGB")).std() > 3, f"nothing is seen in {path.name}"
