"""The stage: a model for pictures only, made from a log; each thing is a puppet put at its logged pose."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, Geom
from prolepsis.log.log import Log
from prolepsis.log.things import Thing, falling_apart, own_solids
from prolepsis.report.droplets import Droplets, Wet
from prolepsis.report.framing import corners
from prolepsis.report.lathe import turned_surface
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError, brief

PLAIN = (0.7, 0.7, 0.7, 1.0)
COLOURS = {
    "Floor": (0.80, 0.80, 0.78, 1.0),
    "Table": (0.62, 0.45, 0.30, 1.0),
    "Piece": (0.90, 0.78, 0.66, 1.0),
}
"""Colours of things whose shape has none of its own, by class or role."""

MOVED = 1e-3
"""A thing that goes less far than this [m] is scenery and does not draw the camera."""

MARGIN = 1.04
"""How much farther the camera stands than what moves needs [1]."""

LIGHT_DISTANCE = 8.0
"""Distance of the lights from the middle of the scene, in its extents [1]."""

GLASS = (0.86, 0.91, 0.95, 0.2)
"""What vessels look like in a scene with liquids: one sees the level in them."""

DARKER_WHEN_WET = 0.45
"""Part of its brightness that a thing full of liquid has lost [1]."""

VIEW_ANGLE = 40.0
"""Vertical field of view [degree]."""


class Stage:
    """The model, its state and its camera for one log."""

    def __init__(self, log: Log, *, width: int = 640, height: int = 480) -> None:
        """Build the puppets of ``log`` for pictures of ``width`` x ``height`` pixels."""
        self.log = log
        self.width, self.height = width, height
        self._parents = {thing.name: thing.whole for thing in log.things}
        self._index = {thing.name: i for i, thing in enumerate(log.things)}
        self._ancestors = [self._chain(thing) for thing in log.things]
        self._falling_apart = falling_apart(log.things)
        self._appears = [thing.emerges for thing in log.things]
        self._own = own_solids(log.things)
        spec: Any = mujoco.MjSpec()
        _dress(spec, width, height)
        for i, thing in enumerate(log.things):
            if thing.shape.geoms:
                self._add(spec, i, thing)
        try:
            self.model: Any = spec.compile()
        except ValueError as error:
            raise InputError(f"the shapes of the log cannot be drawn: {brief(error, 160)}") from None
        self.data: Any = mujoco.MjData(self.model)
        names = [f"thing{i}" for i in range(len(log.things))]
        self._puppets = [
            (i, self.model.body(name).mocapid[0], self.model.body(name).id)
            for i, name in enumerate(names)
            if log.things[i].shape.geoms
        ]
        self._droplets = Droplets(log)
        self._colours: FloatArray = self.model.geom_rgba.copy()

    def visible(self, tick: int) -> BoolArray:
        """Return which things are seen at ``tick``, shape (n,)."""
        carrier = self.log.carrier[tick]
        # A broken whole has no body; a piece or blob is hidden while a whole of its own carries it.
        return np.array(
            [
                carrier[i] >= 0 and not (self._appears[i] and int(carrier[i]) in self._ancestors[i])
                for i in range(len(carrier))
            ]
        )

    def liquid(self, tick: int) -> Wet | None:
        """Return what there is of liquids to be painted at ``tick``, if anything."""
        return self._droplets.at(tick)

    def has_vessels(self, tick: int) -> bool:
        """Return whether any vessel is seen at ``tick``."""
        seen = self.visible(tick)
        return any(seen[i] and self._is_vessel(i) for i, _, _ in self._puppets)

    def show(self, tick: int, *, vessels: bool = True) -> Any:
        """Put every thing at its pose of ``tick`` and return the state; without ``vessels`` these are not seen."""
        seen = self.visible(tick)
        wetness = self._droplets.held_share(tick)
        for i, puppet, body in self._puppets:
            self.data.mocap_pos[puppet] = self.log.poses[tick, i, :3]
            self.data.mocap_quat[puppet] = self.log.poses[tick, i, 3:]
            first = self.model.body_geomadr[body]
            own = slice(first, first + self.model.body_geomnum[body])
            clear = self._droplets.present and self._is_vessel(i)
            shown = seen[i] and (vessels or not clear)
            self.model.geom_rgba[own] = self._colours[own]
            self.model.geom_rgba[own, :3] *= 1.0 - DARKER_WHEN_WET * wetness[i]
            if clear:
                self.model.geom_rgba[own] = GLASS
            self.model.geom_rgba[own, 3] *= 1.0 if shown else 0.0
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)
        return self.data

    def view(self, ticks: list[int], *, azimuth: float = 125.0, elevation: float = -18.0) -> Any:
        """Return a camera (MjvCamera) that has what moves during ``ticks`` in its frame."""
        low, high = self._bounds(ticks)
        radius = float(np.linalg.norm(high - low)) / 2
        self.model.stat.extent = max(radius, 0.2)
        self.model.stat.center = (low + high) / 2
        self.model.light_pos = self.model.stat.center - LIGHT_DISTANCE * self.model.stat.extent * self.model.light_dir
        camera: Any = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE.value
        camera.lookat = (low + high) / 2
        camera.distance = MARGIN * self._distance(low, high, azimuth, elevation)
        camera.azimuth, camera.elevation = azimuth, elevation
        return camera

    def _distance(self, low: FloatArray, high: FloatArray, azimuth: float, elevation: float) -> float:
        """Return from how far [m] the box from ``low`` to ``high`` just fills the picture."""
        yaw, tilt = np.radians(azimuth), np.radians(elevation)
        forward = np.array([np.cos(tilt) * np.cos(yaw), np.cos(tilt) * np.sin(yaw), np.sin(tilt)])
        right = np.array([np.sin(yaw), -np.cos(yaw), 0.0])
        signs = np.stack(np.meshgrid([-1, 1], [-1, 1], [-1, 1]), axis=-1).reshape(8, 3)
        edges = signs * (high - low) / 2
        half = np.tan(np.radians(VIEW_ANGLE / 2))
        across = np.abs(edges @ right) * self.height / self.width
        upward = np.abs(edges @ np.cross(right, forward))
        return float((np.maximum(across, upward) / half - edges @ forward).max())

    def _bounds(self, ticks: list[int]) -> tuple[FloatArray, FloatArray]:
        """Return the lower and upper corner of what moves [m]; a few far splinters are left out."""
        positions: list[FloatArray] = []
        bits: list[FloatArray] = []
        for i, thing in enumerate(self.log.things):
            seen = [tick for tick in ticks if self.visible(tick)[i]]
            if thing.fixed or not thing.shape.geoms or not seen:
                continue
            path = self.log.poses[seen, i, :3]
            vessel = self._droplets.present and self._is_vessel(i)
            if float(np.ptp(path, axis=0).max()) > MOVED or self._appears[i] or vessel:
                reached = corners(thing, self.log.poses[seen, i])
                (bits if self._appears[i] else positions).append(reached)
        bits.extend(self._droplets.at_large(ticks))
        if not positions and not bits:
            shown = [i for i, thing in enumerate(self.log.things) if thing.shape.geoms and not thing.fixed]
            path = self.log.poses[0, shown or [0], :3]
            positions = [path - 0.1, path + 0.1]
        ends = [
            np.percentile(np.concatenate(group), (cut, 100.0 - cut), axis=0)
            for group, cut in ((positions, 1.0), (bits, 15.0))
            if group
        ]
        return np.min(ends, axis=(0, 1)), np.max(ends, axis=(0, 1))

    def _is_vessel(self, i: int) -> bool:
        """Return whether a thing is an open container drawn as glass: none that may fall apart or is drawn by parts."""
        thing = self.log.things[i]
        whole = len(self._own[thing.name]) == len(thing.shape.geoms)
        return "Container" in thing.roles and thing.name not in self._falling_apart and whole

    def _chain(self, thing: Thing) -> frozenset[int]:
        chain: set[int] = set()
        whole = thing.whole
        while whole is not None and whole in self._index:
            chain.add(self._index[whole])
            whole = self._parents[whole]
        return frozenset(chain)

    def _add(self, spec: Any, i: int, thing: Thing) -> None:
        body = spec.worldbody.add_body(name=f"thing{i}", mocap=True)
        look = {"rgba": self._colour(thing), "contype": 0, "conaffinity": 0, "density": 0}
        # The inertia of a hollow mesh is defined for the thinnest piece; only the picture matters here.
        hollow = {"inertia": mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL}
        own = self._own[thing.name]
        if thing.shape.profile and len(own) == len(thing.shape.geoms):
            vertices, triangles = turned_surface(thing.shape)
            spec.add_mesh(name=f"mesh{i}", uservert=vertices.ravel(), userface=triangles.ravel(), **hollow)
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"mesh{i}", material="matt", **look)
            return
        for k in own:
            geom = thing.shape.geoms[k]
            solid = body.add_geom(
                type=getattr(mujoco.mjtGeom, f"mjGEOM_{geom.type.upper()}"),
                size=_drawn_size(geom),
                pos=geom.position,
                quat=geom.orientation,
                **look,
            )
            if geom.type == "mesh":
                name = f"mesh{i}.{k}"
                spec.add_mesh(name=name, uservert=np.asarray(geom.vertices).ravel(), **hollow)
                solid.meshname = name
            solid.material = "ground" if geom.type == "plane" else "matt"

    def _colour(self, thing: Thing) -> tuple[float, float, float, float]:
        if thing.shape.colour != PLAIN:
            return thing.shape.colour
        whole = self.log.things[self._index[thing.whole]].kind if thing.whole in self._index else ""
        named = (thing.kind, whole, *sorted(thing.roles))
        return next((COLOURS[name] for name in named if name in COLOURS), PLAIN)


def _drawn_size(geom: Geom) -> tuple[float, float, float]:
    """Return the size as drawn [m]: a plane without bounds reaches far."""
    if geom.type == "plane":
        return (geom.size[0] or 20.0, geom.size[1] or 20.0, 0.05)
    return geom.size


def _dress(spec: Any, width: int, height: int) -> None:
    """Add sky, ground and lights."""
    spec.compiler.degree = False
    visual = spec.visual
    visual.global_.offwidth, visual.global_.offheight = width, height
    visual.global_.fovy = VIEW_ANGLE
    visual.quality.shadowsize = 2048
    visual.quality.offsamples = 4
    visual.map.znear = 0.01
    visual.headlight.ambient = (0.35, 0.35, 0.36)
    visual.headlight.diffuse = (0.25, 0.25, 0.25)
    visual.headlight.specular = (0.0, 0.0, 0.0)
    textures = mujoco.mjtTexture
    patterns = mujoco.mjtBuiltin
    spec.add_texture(
        name="sky",
        type=textures.mjTEXTURE_SKYBOX,
        builtin=patterns.mjBUILTIN_GRADIENT,
        rgb1=(0.86, 0.91, 0.96),
        rgb2=(0.55, 0.63, 0.72),
        width=256,
        height=1536,
    )
    spec.add_texture(
        name="tiles",
        type=textures.mjTEXTURE_2D,
        builtin=patterns.mjBUILTIN_CHECKER,
        rgb1=(0.93, 0.92, 0.90),
        rgb2=(0.82, 0.81, 0.79),
        width=512,
        height=512,
    )
    ground = spec.add_material(name="ground", texrepeat=(5, 5), texuniform=True, specular=0.1, shininess=0.1)
    ground.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "tiles"
    spec.add_material(name="matt", specular=0.25, shininess=0.35)
    spec.worldbody.add_light(
        # Not a directional light: its shadow map leaves patterns on a large floor.
        type=mujoco.mjtLightType.mjLIGHT_SPOT,
        dir=(-0.35, 0.45, -1.0),
        cutoff=60.0,
        exponent=1.0,
        diffuse=(0.62, 0.60, 0.56),
        specular=(0.25, 0.25, 0.25),
        castshadow=True,
    )
    spec.worldbody.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=(0.6, -0.4, -0.8),
        diffuse=(0.16, 0.18, 0.22),
        specular=(0.0, 0.0, 0.0),
        castshadow=False,
    )
