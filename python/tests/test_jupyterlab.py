"""In JupyterLab, in a browser, a drag of the pointer turns the picture, and a drag of a disc moves the light."""

import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time
import urllib.request

import numpy as np
import pytest

pytest.importorskip("jupyterlab")
pytest.importorskip("jupyter_rfb")
playwright = pytest.importorskip("playwright.sync_api")
Image = pytest.importorskip("PIL.Image")

BROWSER = os.environ.get("CHIAROSCURO_BROWSER") or shutil.which("chromium") or shutil.which("google-chrome")

CELL = """
import json, pathlib
import chiaroscuro as ch

def note(look):
    facts = {"azimuth": look["camera.azimuth_deg"], "light": look.lights[0].direction,
             "previews": viewer.picture.previews, "preview_s": viewer.picture.preview_s,
             "disc": viewer.picture.disc(0)}
    pathlib.Path("changed.part").write_text(json.dumps(facts))
    pathlib.Path("changed.part").rename("changed.json")

viewer = ch.Viewer("builtin:chair:64", on_change=note, size=(640, 480))
note(viewer.look)
viewer
"""

#: Longest wait in seconds for the server, the kernel and the first picture on a slow machine.
PATIENCE_S = 120


def wait_for(condition, what, patience_s=PATIENCE_S, is_needed=True):
    """Waits until a condition returns more than None or False, and returns it; None if it is not needed after all."""
    end = time.monotonic() + patience_s
    while time.monotonic() < end:
        found = condition()
        if found is not None and found is not False:
            return found
        time.sleep(0.1)
    assert not is_needed, f"{what} did not appear"
    return None


@pytest.fixture
def server(tmp_path):
    cell = {"cell_type": "code", "source": CELL, "metadata": {}, "outputs": [], "execution_count": None, "id": "a"}
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    notebook = {"cells": [cell], "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    (tmp_path / "picture.ipynb").write_text(json.dumps(notebook))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    options = [f"--ServerApp.port={port}", "--ServerApp.port_retries=0", "--IdentityProvider.token="]
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", *options]
    with open(tmp_path / "server.log", "w") as log:
        running = subprocess.Popen(command, cwd=tmp_path, stdout=log, stderr=log)
    address = f"http://127.0.0.1:{port}"

    def answers():
        try:
            return urllib.request.urlopen(f"{address}/api/status").status == 200
        except OSError:
            return False

    wait_for(answers, "the server")
    yield address
    running.terminate()
    running.wait()


@pytest.mark.skipif(BROWSER is None, reason="there is no Chromium")
def test_a_drag_in_the_browser_changes_look_and_picture(server, tmp_path):
    def facts():
        path = tmp_path / "changed.json"
        return json.loads(path.read_text()) if path.exists() else None

    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1200, "height": 900})
        page.goto(f"{server}/lab/tree/picture.ipynb")
        page.wait_for_selector(".jp-CodeCell .cm-content", timeout=1000 * PATIENCE_S)
        # The page shows cells before it has a kernel to run them.
        page.wait_for_selector(".jp-Notebook-ExecutionIndicator[data-status='idle']", timeout=1000 * PATIENCE_S)
        # A key that is pressed while the page is still being built is lost.
        for _ in range(5):
            page.click(".jp-CodeCell .cm-content")
            page.keyboard.press("Control+Enter")
            if wait_for(facts, "the first look", PATIENCE_S / 5, is_needed=False):
                break
        picture = page.wait_for_selector(".renderview-wrapper, .jupyter-rfb", timeout=1000 * PATIENCE_S)
        picture.scroll_into_view_if_needed()

        def shown():
            path = tmp_path / "shown.png"
            picture.screenshot(path=path)
            return np.asarray(Image.open(path).convert("RGB")).astype(int)

        first = wait_for(lambda: seen if (seen := shown()).std() > 12 else None, "the picture")
        box = picture.bounding_box()
        before = facts()

        def drag(start, end):
            page.mouse.move(box["x"] + start[0], box["y"] + start[1])
            page.mouse.down()
            for step in range(1, 31):
                x, y = (a + step / 30 * (b - a) for a, b in zip(start, end, strict=True))
                page.mouse.move(box["x"] + x, box["y"] + y)
                time.sleep(0.04)
            page.mouse.up()

        drag((40, 40), (240, 60))

        def turned_by_80():
            now = facts()
            return now if (before["azimuth"] - now["azimuth"]) % 360 == pytest.approx(80, abs=2) else None

        turned = wait_for(turned_by_80, "the turned look")
        time.sleep(2)
        assert abs(shown() - first).mean() > 2, "another picture"
        x, y, _ = turned["disc"]
        drag((x, y), (420, 100))
        lit = wait_for(lambda: (now := facts())["light"] != turned["light"] and now, "the moved light")
        assert lit["azimuth"] == turned["azimuth"]
        if folder := os.environ.get("CHIAROSCURO_SCREENSHOTS"):
            time.sleep(2)
            page.screenshot(path=pathlib.Path(folder) / "jupyterlab.png")
        for name, end, start in [("turning", turned, before), ("lighting", lit, turned)]:
            count, seconds = end["previews"] - start["previews"], end["preview_s"] - start["preview_s"]
            print(f"{name}: {count} previews, {count / seconds:.1f} a second of drawing")
        browser.close()
