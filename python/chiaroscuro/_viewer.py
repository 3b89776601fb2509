"""Interactive view of a volume, whose look comes back: a widget in notebooks, elsewhere the window of the program."""

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
from ._renderer import Renderer, default_renderer
from ._volume import Scene, Volume

#: Name of the program, which the package `chiaroscuro-app` brings.
PROGRAM = "chiaroscuro.exe" if sys.platform == "win32" else "chiaroscuro"


class Viewer:
    """Interactive view of a volume: a widget in a notebook, the window of the program elsewhere.

    In the widget a drag turns the volume, a drag of a disc moves that light, and the wheel moves the camera. The window
    runs in a process of its own, on the file of the volume or on a temporary copy of an array. `look` is the look that
    the picture has, or that the window had when it was closed.

    Args:
        volume: a `Volume`, or what a `Volume` is made of, with its arguments as ``options``.
        look: look to begin with; by default the automatic one.
        on_change: function that is called with the look when a movement ends, or when the window was closed.
        window: true for the window, false for the widget; by default the widget in notebooks.
        wait: waits until the window is closed; else `wait` does so later.
        size: width and height of the widget in pixels.
        renderer: renderer that draws the widget; by default a common one.

    Raises:
        Error: the program or the extra ``notebook`` is not installed, or no window could be opened.
    """

    def __init__(
        self,
        volume: Any,
        look: Look | None = None,
        *,
        on_change: Callable[[Look], object] | None = None,
        window: bool | None = None,
        wait: bool = True,
        size: tuple[int, int] = (640, 480),
        renderer: Renderer | None = None,
        **options: Any,
    ) -> None:
        self.volume = volume if isinstance(volume, Volume) else Volume(volume, **options)
        self._renderer = renderer
        #: Look of the picture: that of the window after it was closed.
        self.look = look.copy() if look is not None else Look.auto(self.volume, renderer=renderer)
        self._on_change = on_change
        self._process: subprocess.Popen[str] | None = None
        self._widget: Any = None
        #: Picture in a notebook; None for a window.
        self.picture: Any = None
        if _is_notebook() if window is None else not window:
            self._make_widget(size)
        else:
            self._open_window()
            if wait:
                self.wait()

    def _make_widget(self, size: tuple[int, int]) -> None:
        try:
            from ._notebook import PictureWidget, controls
        except ImportError as error:
            raise Error(f"{error}; pip install 'chiaroscuro[notebook]' brings what the widget needs") from error
        renderer = self._renderer if self._renderer is not None else default_renderer()
        self.picture = PictureWidget(self, renderer, size)
        self._widget = controls(self, self.picture)

    def _repr_mimebundle_(self, **options: Any) -> Any:
        if self._widget is None:
            return {"text/plain": repr(self)}
        return self._widget._repr_mimebundle_(**options)

    def note_look(self) -> None:
        """Calls the function that was given for changes."""
        if self._on_change is not None:
            self._on_change(self.look)

    def _open_window(self) -> None:
        if isinstance(self.volume, Scene):
            raise Error("the window opens single volumes; save the layers, and open them with --layer")
        self._folder = tempfile.TemporaryDirectory(prefix="chiaroscuro-")
        folder = pathlib.Path(self._folder.name)
        self._session = folder / "look.json"
        self.look.save(self._session)
        source = self.volume._source
        path = source[0] if source is not None and not any(source[1].values()) else None
        is_copy = path is None
        if path is None:
            path = str(folder / f"{_file_name(self.volume.name)}.nrrd")
            self.volume.save(path)
        command = [program(), path, "--session", str(self._session), "--save-on-close"]
        if is_copy:
            # It is deleted with the folder, and must not stay in the list of recent files.
            command.append("--temporary")
        self._process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)

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
            self.note_look()
        return self.look

    @property
    def is_open(self) -> bool:
        """True while the window is open."""
        return self._process is not None and self._process.poll() is None

    def snapshot(self, size: tuple[int, int] = (1280, 960), **options: Any) -> np.ndarray:
        """Draws the volume with the viewer's look: an array of shape (height, width, 4)."""
        renderer = self._renderer if self._renderer is not None else default_renderer()
        return renderer.render(self.volume, self.look, size=size, **options)

    def __repr__(self) -> str:
        state = "in a notebook" if self._widget is not None else "open" if self.is_open else "closed"
        return f"<chiaroscuro.Viewer of {self.volume.name!r}, {state}>"


def _is_notebook() -> bool:
    """Returns true if this code runs in the kernel of a notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return hasattr(shell, "kernel")


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
