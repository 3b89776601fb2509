"""Window of the program, opened on a volume, whose look comes back when it is closed."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable
from typing import Any

import numpy as np

from ._errors import Error
from ._look import Look
from ._renderer import default_renderer
from ._volume import Scene, Volume

#: Name of the program, which the package `chiaroscuro-app` brings.
PROGRAM = "chiaroscuro.exe" if sys.platform == "win32" else "chiaroscuro"


class Viewer:
    """Window of the program on a volume, in a process of its own.

    The window shows a temporary copy of an array, or the file that the volume was read from. The look that it had when
    it was closed is then the viewer's.

    Args:
        volume: a `Volume`, or what a `Volume` is made of, with its arguments as ``options``.
        look: look to begin with; by default the automatic one.
        on_change: function that is called with the look when the window was closed.
        wait: waits until the window is closed; else `wait` does so later.

    Raises:
        Error: the program is not installed, or could not open a window.
    """

    def __init__(
        self,
        volume: Any,
        look: Look | None = None,
        *,
        on_change: Callable[[Look], object] | None = None,
        wait: bool = True,
        **options: Any,
    ) -> None:
        self.volume = volume if isinstance(volume, Volume) else Volume(volume, **options)
        if isinstance(self.volume, Scene):
            raise Error("the window opens single volumes; save the layers, and open them with --layer")
        #: Look of the picture: that of the window after it was closed.
        self.look = look.copy() if look is not None else Look.auto(self.volume)
        self._on_change = on_change
        self._folder = tempfile.TemporaryDirectory(prefix="chiaroscuro-")
        folder = pathlib.Path(self._folder.name)
        self._session = folder / "look.json"
        self.look.save(self._session)
        source = self.volume._source
        path = source[0] if source is not None and not any(source[1].values()) else None
        if path is None:
            path = str(folder / f"{_file_name(self.volume.name)}.nrrd")
            self.volume.save(path)
        command = [program(), path, "--session", str(self._session), "--save-on-close"]
        self._process: subprocess.Popen[str] | None = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        if wait:
            self.wait()

    def wait(self) -> Look:
        """Waits until the window is closed, and returns its look."""
        if self._process is not None:
            _, said = self._process.communicate()
            code, self._process = self._process.returncode, None
            if code != 0:
                raise Error(f"the window ended with an error: {said.strip() or code}")
            # The record may have corrections of the volume, which belong to the file.
            self.look = Look.load(self._session, self.volume)
            self._folder.cleanup()
            if self._on_change is not None:
                self._on_change(self.look)
        return self.look

    @property
    def is_open(self) -> bool:
        """True while the window is open."""
        return self._process is not None and self._process.poll() is None

    def snapshot(self, size: tuple[int, int] = (1280, 960), **options: Any) -> np.ndarray:
        """Draws the volume with the viewer's look: an array of shape (height, width, 4)."""
        return default_renderer().render(self.volume, self.look, size=size, **options)

    def __repr__(self) -> str:
        return f"<chiaroscuro.Viewer of {self.volume.name!r}, {'open' if self.is_open else 'closed'}>"


def program() -> str:
    """Returns the path of the program: beside this Python, or in the search path.

    Raises:
        Error: it is not installed; the message says how to.
    """
    named = os.environ.get("CHIAROSCURO_PROGRAM")
    beside = os.path.join(sysconfig.get_path("scripts"), PROGRAM)
    found = named or (beside if os.path.exists(beside) else shutil.which(PROGRAM))
    if not found:
        raise Error("the program is not installed; pip install chiaroscuro-app, or a package of it, brings the window")
    return found


def _file_name(name: str) -> str:
    """Returns a name without what files cannot have in theirs."""
    kept = "".join(letter if letter.isalnum() or letter in "-_" else "-" for letter in name)
    return kept[:60] or "array"
