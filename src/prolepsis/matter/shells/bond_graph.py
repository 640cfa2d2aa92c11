"""A brittle shell as a graph of pieces joined by elastic bonds: which bonds does a set of contact forces overload?

The forces on the pieces, less the inertial forces of the free body (inertial relief), stretch and bend the
bonds. One matrix, computed once for a graph, turns forces into bond loads. A bond gives way in two ways that
add up: by membrane stress, which in a closed shell goes with the stress peak around a contact that the
pieces are too coarse to resolve, so that its strength is a calibrated one; and by bending, which matters in
open shells and shards and which the pieces do resolve, so that its strength is the material's.

Where a membrane lines the shell, a bond that gives way is cracked, a hinge: closed, its rough faces press on each other
and shear; open, the soft membrane alone holds it, until that tears as well. Without a membrane it is gone at once.

Source: frame elements (any text on the finite element method); Rankine's criterion for brittle materials.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from prolepsis.geometry.rotations import cross
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray

ALONG = 5
"""Points that stand for an edge, some 3 mm apart."""
RIM = 2.0
"""What presses so near to a rim, over the length in which a shell bends, presses beside it [1]."""
HINGE = 1.0e-3
"""Share of its stiffness in bending and twist that a cracked bond keeps [1]: next to nothing."""
SETTLING = 4
"""Rounds in which it is found which cracks are open; mostly two are enough."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BondGraph:
    """n pieces and m elastic bonds; positions are in one common frame, that of the intact body."""

    nodes: IntArray
    """Number of each piece in the intact shell, shape (n,), ascending."""
    centres: FloatArray
    """Centres of the pieces [m], shape (n, 3)."""
    normals: FloatArray
    """Outward unit normals, shape (n, 3)."""
    masses: FloatArray
    """Mass that each piece carries, contents included [kg], shape (n,)."""
    bonds: IntArray
    """Joined pieces as positions in ``nodes``, shape (m, 2)."""
    widths: FloatArray
    """Lengths of the common edges [m], shape (m,)."""
    strengths: FloatArray
    """Membrane stress that each bond bears [Pa], shape (m,)."""
    bending_strength: float
    """Bending stress that the material bears [Pa]."""
    weakened: BoolArray
    """Whether a bond lies at the tip of a crack and has lost strength for it, shape (m,)."""
    thickness: float
    """Thickness of the shell [m]."""
    youngs_modulus: float
    """Young's modulus [Pa]."""
    poisson_ratio: float
    """Poisson's ratio [1]."""
    membrane_strength: float
    """Pull that the membrane bears for each length of a crack [N/m]; 0 without one."""
    membrane_stretch: float
    """How far it stretches until it tears [m]."""
    cracked: BoolArray
    """Whether a bond has given way and a membrane lines it, shape (m,)."""
    opened: BoolArray
    """Whether a cracked bond is open, shape (m,)."""
    spread: float
    """Length over which a contact force is shared among pieces [m]."""
    semi_axes: tuple[float, float, float]
    """Half lengths of the ellipsoid that the shell is [m]."""
    rims: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    """Points along the edges that have given way [m], shape (r, 3)."""
    rim_strength: float = 1.0
    """Force that breaks it beside such an edge, over that which does elsewhere [1]."""
    evened: float = 0.0
    """Greatest load of a bond by each newton on a whole shell, wherever it presses [1/N]; 0 if as computed."""
    damaged: bool = False
    """Whether any bond has given way."""
    local: bool = False
    """Whether peaks round contacts are counted by themselves, and bonds bear what the material does."""
    hardening: float = 1.0
    """Factor on what bonds bear that have not cracked: more for a short time [1]."""
    response: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))
    """Bond force components per node wrench, shape (6 m, 6 n); filled by ``assembled``."""

    def assembled(self) -> BondGraph:
        """Return the graph with its response matrix."""
        return replace(self, response=_response(self))

    def wrenches_per_force(self, points: FloatArray) -> FloatArray:
        """Return how unit forces at points act on the pieces near them.

        Args:
            points: Points of attack in the common frame [m], shape (c, 3).

        Returns:
            Force [1] and moment about its centre [m] of each piece, per force along x, y and z, shape (c, 6 n, 3).
        """
        arms = points[:, None, :] - self.centres[None, :, :]
        squared = np.einsum("cij,cij->ci", arms, arms)
        weights = np.exp((squared.min(axis=1, keepdims=True) - squared) / (2 * self.spread**2))
        weights /= weights.sum(axis=1, keepdims=True)
        x, y, z = np.moveaxis(arms * weights[:, :, None], 2, 0)
        wrenches = np.zeros((len(points), len(self.nodes), 6, 3))
        for k in range(3):
            wrenches[:, :, k, k] = weights
        wrenches[:, :, 3, 1], wrenches[:, :, 3, 2] = -z, y
        wrenches[:, :, 4, 0], wrenches[:, :, 4, 2] = z, -x
        wrenches[:, :, 5, 0], wrenches[:, :, 5, 1] = -y, x
        return wrenches.reshape(len(points), 6 * len(self.nodes), 3)

    def loads(self, points: FloatArray, forces: FloatArray) -> FloatArray:
        """Return how near each bond is to giving way under contact forces.

        Args:
            points: Points of attack in the common frame [m], shape (c, 3).
            forces: Forces in the same frame [N], shape (c, 3).

        Returns:
            Load over strength [1], shape (m,); a bond gives way at 1.
        """
        wrenches = self.wrenches_per_force(points)
        if self.evened and not self.damaged:
            forces = forces * (self.evened / self.peaks(points))[:, None]
        wrench = np.einsum("cij,cj->i", wrenches, forces)
        loads = self.ratios((self.response @ wrench).reshape(-1, 6))
        return loads + self._local(points, forces) if self.local else loads

    def _local(self, points: FloatArray, forces: FloatArray) -> FloatArray:
        """Return the loads by the peaks round contacts, which break it as they do the whole [1], shape (m,)."""
        apart = np.linalg.norm(points[:, None] - self.rims, axis=2).min(axis=1, initial=np.inf)
        weaker = np.where(apart < RIM * self.bent, 1 / self.rim_strength, 1.0)
        nearest = np.linalg.norm(self.centres - points[:, None], axis=2).argmin(axis=1)
        pressed = np.bincount(nearest, weaker * np.linalg.norm(forces, axis=1), len(self.nodes))
        loads = self.evened / self.hardening * pressed[self.bonds].max(axis=1)
        return np.where(self.cracked, 0.0, loads)

    @property
    def local_peak(self) -> float:
        """Greatest load of a bond by the peak round a contact of a newton [1/N]."""
        return self.evened / (self.hardening * self.rim_strength) if self.local else 0.0

    @property
    def bent(self) -> float:
        """Length in which a shell bends at an edge or round a load [m]."""
        radius = float(np.prod(self.semi_axes)) ** (1 / 3)
        return bending_length(radius, self.thickness, self.poisson_ratio)

    def peaks(self, points: FloatArray) -> FloatArray:
        """Return the greatest load of any bond by each newton that presses at a point alone and for long [1/N], (c,).

        It hangs on how the pieces lie there, which are too coarse for the stress round a contact.
        """
        outward = points / np.square(self.semi_axes)
        inward = -outward / np.linalg.norm(outward, axis=1, keepdims=True)
        wrenches = np.einsum("cij,cj->ic", self.wrenches_per_force(points), inward)
        components = (self.response @ wrenches).reshape(len(self.bonds), 6, len(points))
        return self.hardening * self.ratios(components.transpose(2, 0, 1)).max(axis=1)

    def ratios(self, components: FloatArray) -> FloatArray:
        """Return load over strength of each bond [1], shape (..., m), under components as ``stresses`` takes them."""
        membrane, bending = self.stresses(components)
        loads = (membrane / self.strengths + bending / self.bending_strength) / self.hardening
        if not self.cracked.any():
            return loads
        pull = np.maximum(components[..., 0], 0.0) / (self.widths * self.membrane_strength)
        return np.where(self.cracked, pull, loads)

    def settled(self, points: FloatArray, forces: FloatArray) -> BondGraph:
        """Return the assembled graph with those cracks open that contact forces pull open, and the others closed.

        Args:
            points: Points of attack in the common frame [m], shape (c, 3).
            forces: Forces in the same frame [N], shape (c, 3).
        """
        graph = self if len(self.response) else self.assembled()
        wrench = np.einsum("cij,cj->i", self.wrenches_per_force(points), forces)
        for _ in range(SETTLING):
            opened = graph.cracked & ((graph.response @ wrench).reshape(-1, 6)[:, 0] > 0)
            if np.array_equal(opened, graph.opened):
                break
            graph = replace(graph, opened=opened).assembled()
        return graph

    def stresses(self, components: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the greatest tensile membrane stress and the bending stress of each bond [Pa], each (..., m).

        Args:
            components: Axial, two shear forces [N], twist, bending, in-plane bending [N m], shape (..., m, 6).
        """
        area = self.widths * self.thickness
        shear = np.hypot(components[..., 1], components[..., 2]) / area
        in_plane = 6 * np.abs(components[..., 5]) / (self.thickness * self.widths**2)
        normal = components[..., 0] / area + in_plane
        bending = 6 * np.abs(components[..., 4]) / (self.widths * self.thickness**2)
        return normal / 2 + np.sqrt((normal / 2) ** 2 + shear**2), bending

    def after_breaking(self, broken: BoolArray, weakening: float) -> BondGraph:
        """Return the graph in which ``broken`` bonds, shape (m,), have cracked or gone, its crack tips weakened.

        Args:
            broken: True for each bond that has given way.
            weakening: Factor on the strength of the bonds that share a piece with a broken one [1].
        """
        touched = np.zeros(len(self.nodes), dtype=bool)
        touched[self.bonds[broken].ravel()] = True
        tip = touched[self.bonds].any(axis=1) & ~self.weakened
        strengths = np.where(tip, self.strengths * weakening, self.strengths)
        cracked = replace(
            self,
            strengths=strengths,
            weakened=self.weakened | tip,
            cracked=self.cracked | broken,
            opened=self.opened | broken,
            damaged=True,
            rims=np.concatenate([self.rims, self._edges(broken & ~self.cracked)]),
            rim_strength=weakening,
        )
        if not self.membrane_strength:
            return cracked.without(broken)
        return cracked.with_local_peaks(weakening).without(broken & self.cracked)

    def _edges(self, chosen: BoolArray) -> FloatArray:
        """Return points along the common edges of the ``chosen`` bonds, shape (m,), shape (r, 3) [m]."""
        first, second = self.bonds[chosen].T
        edge = cross(self.normals[first] + self.normals[second], self.centres[second] - self.centres[first])
        edge /= np.linalg.norm(edge, axis=1)[:, None]
        middle = (self.centres[first] + self.centres[second]) / 2
        along = np.linspace(-0.5, 0.5, ALONG)[:, None] * edge[:, None] * self.widths[chosen][:, None, None]
        return (middle[:, None] + along).reshape(-1, 3)

    def without(self, gone: BoolArray) -> BondGraph:
        """Return the graph without the bonds that are ``gone``, shape (m,)."""
        kept = ~gone
        return replace(
            self,
            bonds=self.bonds[kept],
            widths=self.widths[kept],
            strengths=self.strengths[kept],
            weakened=self.weakened[kept],
            cracked=self.cracked[kept],
            opened=self.opened[kept],
            response=np.zeros((0, 0)),
        )

    def round_pieces(self, pieces: IntArray) -> BoolArray:
        """Return which bonds join one of some pieces, given as positions in ``nodes``, to another, shape (m,)."""
        chosen = np.zeros(len(self.nodes), dtype=bool)
        chosen[pieces] = True
        return chosen[self.bonds[:, 0]] | chosen[self.bonds[:, 1]]

    def with_local_peaks(self, weakening: float) -> BondGraph:
        """Return it as a cracked shell, or a part of one, weaker by a factor at the tips of cracks [1].

        The strengths of the whole stand for the peak round a contact. Elsewhere bonds bear what the material does.
        """
        if self.local:
            return self
        strengths = self.bending_strength * np.where(self.weakened, weakening, 1.0)
        return replace(self, strengths=strengths, local=True)

    def joined(self, chosen: BoolArray) -> list[tuple[int, int]]:
        """Return the numbers of the pieces that the ``chosen`` bonds, shape (m,), join."""
        return [(int(a), int(b)) for a, b in self.nodes[self.bonds[chosen]]]

    def fragments(self) -> tuple[BondGraph, ...]:
        """Return the connected parts, ordered by their lowest piece."""
        label = np.arange(len(self.nodes))
        for _ in range(len(self.nodes)):
            lowest = np.minimum(label[self.bonds[:, 0]], label[self.bonds[:, 1]])
            new = label.copy()
            np.minimum.at(new, self.bonds[:, 0], lowest)
            np.minimum.at(new, self.bonds[:, 1], lowest)
            if np.array_equal(new, label):
                break
            label = new
        return tuple(self._part(label == k) for k in np.unique(label))

    def _part(self, chosen: BoolArray) -> BondGraph:
        position = np.cumsum(chosen) - 1
        inside = chosen[self.bonds].all(axis=1) if len(self.bonds) else np.zeros(0, dtype=bool)
        return replace(
            self,
            nodes=self.nodes[chosen],
            centres=self.centres[chosen],
            normals=self.normals[chosen],
            masses=self.masses[chosen],
            bonds=position[self.bonds[inside]],
            widths=self.widths[inside],
            strengths=self.strengths[inside],
            weakened=self.weakened[inside],
            cracked=self.cracked[inside],
            opened=self.opened[inside],
            response=np.zeros((0, 0)),
        )


def bending_length(radius: float, thickness: float, poisson_ratio: float) -> float:
    """Return the length in which a shell of a radius [m] and thickness [m] bends [m] (Reissner 1946)."""
    bent: float = (radius * thickness) ** 0.5 / (12 * (1 - poisson_ratio**2)) ** 0.25
    return bent


def _response(graph: BondGraph) -> FloatArray:
    """Return bond force components per node wrench with inertial relief, shape (6 m, 6 n)."""
    n, m = len(graph.nodes), len(graph.bonds)
    if m == 0:
        return np.zeros((0, 6 * n))
    strain, stiffness = _strain(graph)
    rigid = _rigid_modes(graph.centres)
    inertia = np.repeat(graph.masses[:, None], 6, axis=1)
    inertia[:, 3:] *= graph.thickness**2  # to the relief, pieces are as good as points
    weighted = inertia.ravel()[:, None] * rigid
    relief = np.eye(6 * n) - weighted @ np.linalg.solve(rigid.T @ weighted, rigid.T)
    stiff = strain.T @ (stiffness[:, None] * strain)
    basis, _ = np.linalg.qr(rigid)
    grounded = stiff + np.trace(stiff) / (6 * n) * (basis @ basis.T)
    # Rotations carry metres less than translations: scale before solving, or the matrix is ill conditioned.
    scale = 1 / np.sqrt(np.diag(grounded))
    balanced = scale[:, None] * grounded * scale[None, :]
    motion = scale[:, None] * np.asarray(np.linalg.solve(balanced, scale[:, None] * relief), dtype=np.float64)
    return stiffness[:, None] * (strain @ motion)


def _strain(graph: BondGraph) -> tuple[FloatArray, FloatArray]:
    """Return the matrix from node motions to bond deformations, shape (6 m, 6 n), and the bond stiffnesses, (6 m,)."""
    first, second = graph.bonds.T
    along = graph.centres[second] - graph.centres[first]
    length = np.linalg.norm(along, axis=1)
    x = along / length[:, None]
    normal = graph.normals[first] + graph.normals[second]
    normal -= (normal * x).sum(axis=1)[:, None] * x
    z = normal / np.linalg.norm(normal, axis=1)[:, None]
    y = cross(z, x)
    axes = np.stack([x, y, z], axis=1)
    middle = (graph.centres[first] + graph.centres[second]) / 2
    m, n = len(first), len(graph.nodes)
    strain = np.zeros((m, 6, n, 6))
    rows = np.arange(m)
    for node, sign in ((first, -1.0), (second, 1.0)):
        arm = middle - graph.centres[node]
        strain[rows, :3, node, :3] = sign * axes
        # u_middle = u + theta x arm, so the columns for theta are axes . (e_k x arm).
        for k in range(3):
            strain[rows, :3, node, 3 + k] = sign * np.einsum("mij,mj->mi", axes, _about_axis(k, arm))
        strain[rows, 3:, node, 3:] = sign * axes
    return strain.reshape(6 * m, 6 * n), _stiffness(graph)


def _stiffness(graph: BondGraph) -> FloatArray:
    """Return the stiffness of each component of each bond [N/m, N m], shape (6 m,)."""
    first, second = graph.bonds.T
    length = np.linalg.norm(graph.centres[second] - graph.centres[first], axis=1)
    e, t, w = graph.youngs_modulus, graph.thickness, graph.widths
    g = e / (2 * (1 + graph.poisson_ratio))
    stiffness = np.stack(
        [
            e * w * t / length,
            g * w * t / length,
            g * w * t / length,
            g * w * t**3 / (3 * length),
            e * w * t**3 / (12 * (1 - graph.poisson_ratio**2) * length),
            e * t * w**3 / (12 * length),
        ],
        axis=1,
    )
    stiffness[graph.cracked, 3:5] *= HINGE
    if graph.opened.any():
        pulled = graph.membrane_strength * w / graph.membrane_stretch
        turned = pulled * w**2 / 12
        soft = np.stack([pulled, pulled, pulled, HINGE * turned, HINGE * turned, turned], axis=1)
        stiffness[graph.opened] = soft[graph.opened]
    return stiffness.ravel()


def _rigid_modes(centres: FloatArray) -> FloatArray:
    """Return the six rigid motions of points as columns, shape (6 n, 6)."""
    n = len(centres)
    modes = np.zeros((n, 6, 6))
    modes[:, :3, :3] = np.eye(3)
    modes[:, 3:, 3:] = np.eye(3)
    for k in range(3):
        modes[:, :3, 3 + k] = _about_axis(k, centres)
    return modes.reshape(6 * n, 6)


def _about_axis(k: int, points: FloatArray) -> FloatArray:
    """Return the cross products of the k-th unit vector with points, shape (n, 3)."""
    i, j = (k + 1) % 3, (k + 2) % 3
    found = np.zeros_like(points)
    found[:, i], found[:, j] = -points[:, j], points[:, i]
    return found
