"""Pictures without a screen: EGL where it works, else OSMesa, whatever was imported before.

MuJoCo reads ``MUJOCO_GL`` only when it is first imported, so the context is made here instead of by its renderer.
"""

from __future__ import annotations

import importlib
import os
from types import TracebackType
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.report.liquid import Eye, Picture
from prolepsis.terms.errors import MissingToolError

BACKENDS = ("egl", "osmesa")
_opened_by: int | None = None
"""The process that first opened OpenGL, if any has."""
ADVICE = "apt install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri"


def opened_by_parent() -> bool:
    """Return whether a process from which this one was forked has opened OpenGL: its threads are missing here."""
    return _opened_by not in (None, os.getpid())


def open_context(width: int, height: int) -> tuple[str, Any]:
    """Return the name of the first back end that works, and its OpenGL context, current.

    Raises:
        MissingToolError: If none works.
    """
    global _opened_by
    _opened_by = _opened_by or os.getpid()
    chosen = os.environ.get("MUJOCO_GL", "").strip().lower()
    reasons: list[str] = []
    for backend in sorted(BACKENDS, key=lambda name: name != chosen):
        try:
            # PyOpenGL binds itself to one back end; the first that works stays.
            os.environ["PYOPENGL_PLATFORM"] = backend
            context: Any = importlib.import_module(f"mujoco.{backend}").GLContext(width, height)
            context.make_current()
        # A missing library shows itself as any of these, depending on which one it is.
        except (ImportError, AttributeError, OSError, RuntimeError, TypeError) as error:
            reasons.append(f"{backend}: {(str(error) or type(error).__name__).splitlines()[0]}")
            continue
        return backend, context
    raise MissingToolError(f"no off-screen OpenGL ({'; '.join(reasons)}); {ADVICE}")


class Camera:
    """Takes pictures of a model off-screen. Use it as a context manager."""

    def __init__(self, model: Any, *, width: int, height: int, view: Any) -> None:
        """Open an OpenGL context for ``model`` (an MjModel), seen as ``view`` (an MjvCamera) tells."""
        self._process = os.getpid()
        # OpenGL first: importing MuJoCo with another back end would bind PyOpenGL to that.
        self.backend, self._context = open_context(width, height)
        mujoco: Any = importlib.import_module("mujoco")
        self._mujoco = mujoco
        self._model = model
        self._view = view
        self._scene = mujoco.MjvScene(model, maxgeom=10000)
        self._options = mujoco.MjvOption()
        self._rectangle = mujoco.MjrRect(0, 0, width, height)
        self._renderer = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_150.value)
        self._renderer.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR.value
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._renderer)
        self._pixels = np.zeros((height, width, 3), dtype=np.uint8)

    def take(self, data: Any) -> Picture:
        """Return a picture of the state ``data`` (an MjData)."""
        mujoco = self._mujoco
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, self._options, None, self._view, everything, self._scene)
        mujoco.mjr_render(self._rectangle, self._scene, self._renderer)
        mujoco.mjr_readPixels(self._pixels, None, self._rectangle, self._renderer)
        # OpenGL counts rows from below.
        return np.ascontiguousarray(self._pixels[::-1])

    def distances(self) -> FloatArray:
        """Return how far ahead what the last picture shows is in each pixel [m], shape (height, width)."""
        raw = np.zeros(self._pixels.shape[:2], dtype=np.float32)
        self._mujoco.mjr_readPixels(None, raw, self._rectangle, self._renderer)
        extent, clip = self._model.stat.extent, self._model.vis.map
        near, far = clip.znear * extent, clip.zfar * extent
        # Reversed depth: 1 at the near plane, 0 at the far one.
        return near * far / (near + raw[::-1].astype(np.float64) * (far - near))

    def eye(self) -> Eye:
        """Return the camera of the last picture."""
        left, right = self._scene.camera
        lens = (left.frustum_top - left.frustum_bottom) / left.frustum_near
        return Eye(
            position=(np.asarray(left.pos, dtype=np.float64) + np.asarray(right.pos)) / 2,
            forward=np.asarray(left.forward, dtype=np.float64),
            up=np.asarray(left.up, dtype=np.float64),
            focal=self._pixels.shape[0] / lens,
        )

    def __enter__(self) -> Camera:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process == os.getpid():
            self._renderer.free()
            self._context.free()
