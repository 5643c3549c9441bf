"""The nodes of the workspace, below `/reach`, in one browser."""

from __future__ import annotations

import numpy as np
import trimesh
import viser
from numpy.typing import NDArray
from PIL import Image
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

from deltaviz.robots.workspace.shapes import Cuboid
from deltaviz.scene import colours, shapes
from deltaviz.scene.shapes import Shape
from deltaviz.scene.units import Array, metres
from deltaviz.scene.workspace.pictures import Fitted, Section, Skin

BOUNDARY, OUTLINE, FITTED = "/reach/boundary", "/reach/outline", "/reach/fitted"
DESIGN = "/reach/design"
SECTIONS = tuple(f"/reach/section_{axis}" for axis in "xyz")

_OPACITY, _PALE = 0.22, 0.08
_THIN = 0.002  # m, how thick a rectangle is drawn


class Drawing:
    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._nodes: dict[str, viser.SceneNodeHandle] = {}
        self._skin: Skin | None = None

    def skin(self, skin: Skin | None) -> None:
        self._skin = None
        if skin is None or skin.reason is not None:
            self._drop(BOUNDARY, OUTLINE)
            return
        self._skin = skin
        self._fill()
        if len(skin.edges):
            self._lines(OUTLINE, skin.edges, colours.REACH)
        else:
            self._drop(OUTLINE)

    def fade(self, pale: bool) -> None:
        """The boundary of what is not any more what was asked for."""
        boundary = self._nodes.get(BOUNDARY)
        if isinstance(boundary, viser.MeshHandle):
            boundary.opacity = _PALE if pale else _OPACITY

    def design(self, segments: Array | None) -> None:
        """(k, 2, 3): the arms of a robot that is not there."""
        if segments is None:
            self._drop(DESIGN)
        else:
            self._lines(DESIGN, segments, colours.DESIGN)

    def section(self, section: Section) -> None:
        self._fill(covered=True)
        name = SECTIONS[section.axis]
        self._nodes[name] = self._scene.add_mesh_trimesh(
            name, _glowing(section), cast_shadow=False, receive_shadow=False
        )

    def no_section(self, axis: int) -> None:
        self._drop(SECTIONS[axis])
        if BOUNDARY not in self._nodes:
            self._fill()

    def fitted(self, fitted: Fitted | None) -> None:
        if fitted is None or fitted.shape is None:
            self._drop(FITTED)
            return
        body = fitted.shape
        low, high = (float(metres(z)) for z in (body.floor, body.floor + body.height))
        if isinstance(body, Cuboid):
            (x,), (half,) = metres(body.centre).tolist(), (metres(body.size) / 2).tolist()
            shape = shapes.block((x - half, x + half), (-_THIN / 2, _THIN / 2), (low, high))
        else:
            centre = np.append(metres(body.centre), 0.0)
            radius = float(metres(body.diameter)) / 2
            shape = shapes.cylinder(radius, low, high, segments=96).moved(centre)
        self._mesh(FITTED, shape, colours.FITTED, 0.35)

    def clear(self) -> None:
        self._skin = None
        self._drop(*list(self._nodes))

    def _fill(self, *, covered: bool = False) -> None:
        """The boundary; in a plane not while a section lies in the same place."""
        if self._skin is None:
            return
        planar = len(self._skin.edges) > 0
        if planar and (covered or SECTIONS[1] in self._nodes):
            self._drop(BOUNDARY)
        elif not covered:
            shape = Shape(self._skin.vertices, self._skin.faces)
            self._mesh(BOUNDARY, shape, colours.REACH, _OPACITY)

    def _lines(self, name: str, segments: NDArray[np.floating], colour: colours.Colour) -> None:
        self._nodes[name] = self._scene.add_line_segments(
            name, points=segments, colors=colour, thickness=2.0, thickness_units="screen"
        )

    def _mesh(self, name: str, shape: Shape, colour: colours.Colour, opacity: float) -> None:
        self._nodes[name] = self._scene.add_mesh_simple(
            name,
            shape.vertices,
            shape.faces,
            color=colour,
            opacity=opacity,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )

    def _drop(self, *names: str) -> None:
        for name in names:
            node = self._nodes.pop(name, None)
            if node is not None:
                node.remove()


def _glowing(section: Section) -> trimesh.Trimesh:
    """A rectangle with the section's picture on it, in its own colours whatever the light; what
    is cut out of it hides nothing, and what it shows is seen through the boundary."""
    first, second = (i for i in range(3) if i != section.axis)
    corners = np.tile(section.low, (4, 1))
    corners[1:3, first] = section.high[first]
    corners[2:, second] = section.high[second]
    picture = Image.fromarray(section.image[::-1])  # a texture's first row is its top
    material = PBRMaterial(
        baseColorTexture=picture,
        baseColorFactor=[0, 0, 0, 255],
        emissiveTexture=picture.convert("RGB"),
        emissiveFactor=[1.0, 1.0, 1.0],
        metallicFactor=0.0,
        roughnessFactor=1.0,
        alphaMode="MASK",
        alphaCutoff=0.5,
        doubleSided=True,
    )
    uv = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    visual = TextureVisuals(uv=uv, material=material)
    faces = [(0, 1, 2), (0, 2, 3)]
    return trimesh.Trimesh(vertices=corners, faces=faces, visual=visual, process=False)
