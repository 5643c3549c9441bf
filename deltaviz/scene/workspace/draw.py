"""The nodes of the workspace, below `/reach`, in one browser."""

from __future__ import annotations

from typing import Any

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
from deltaviz.scene.workspace.hits import Surfaces
from deltaviz.scene.workspace.measures import coloured
from deltaviz.scene.workspace.pictures import Fitted, Section, Singularities, Skin
from deltaviz.scene.workspace.relay import Relay

BOUNDARY, OUTLINE, FITTED = "/reach/boundary", "/reach/outline", "/reach/fitted"
DESIGN, OBJECT = "/reach/design", "/reach/object"
SINGULAR = "/reach/type_1", "/reach/type_2"
SECTIONS = tuple(f"/reach/section_{axis}" for axis in "xyz")

_OPACITY, _PALE = 0.22, 0.08
_COLOURED = 0.5  # how opaque a boundary is that shows a measure
_SINGULAR = 0.45
_THIN = 0.002  # m, how thick a rectangle is drawn
_LOWER = 0.0004  # m, that a thing is drawn below a section at its height: they would flicker


class Drawing:
    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._nodes: dict[str, viser.SceneNodeHandle | Relay] = {}
        self.surfaces = Surfaces()

    def skin(self, skin: Skin | None) -> None:
        self.surfaces.skin = None
        if skin is None or skin.reason is not None:
            self._drop(BOUNDARY, OUTLINE)
            return
        self.surfaces.skin = skin
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
        self._picture(SECTIONS[section.axis], section)

    def object(self, section: Section | None) -> None:
        """A thing that lies in the scene, as a cut across z."""
        if section is None:
            self._drop(OBJECT)
        else:
            self._picture(OBJECT, section, lower=_LOWER)

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

    def singular(self, found: Singularities | None) -> None:
        surfaces = (None, None) if found is None else (found.type_1, found.type_2)
        kinds = zip(SINGULAR, surfaces, colours.SINGULAR, strict=True)
        for name, surface, colour in kinds:
            if surface is None or surface.distance is None:
                self._drop(name)
            elif len(surface.faces):
                self._mesh(name, Shape(surface.vertices, surface.faces), colour, _SINGULAR)
            else:
                self._lines(name, surface.edges, colour)

    def clear(self) -> None:
        self.surfaces.skin = None
        self._drop(*list(self._nodes))

    def _fill(self, *, covered: bool = False) -> None:
        """The boundary; in a plane not while a section lies in the same place."""
        skin = self.surfaces.skin
        if skin is None:
            return
        planar = len(skin.edges) > 0
        if planar and (covered or SECTIONS[1] in self._nodes):
            self._drop(BOUNDARY)
        elif not covered and skin.share is not None and not planar:
            self._nodes[BOUNDARY] = self._glb(BOUNDARY, _shaded(skin, skin.share))
        elif not covered:
            shape = Shape(skin.vertices, skin.faces)
            self._mesh(BOUNDARY, shape, colours.REACH, _OPACITY)

    def _picture(self, name: str, section: Section, *, lower: float = 0.0) -> None:
        self.surfaces.flat[name] = section
        if not isinstance(relay := self._nodes.get(name), Relay):
            relay = self._nodes[name] = Relay(name)
        relay.show(lambda own: self._glb(own, _glowing(section), lower=lower))

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

    def _lines(self, name: str, edges: NDArray[np.floating], colour: colours.Colour) -> None:
        self._nodes[name] = self._scene.add_line_segments(
            name, points=edges, colors=colour, thickness=2.0, thickness_units="screen"
        )

    def _glb(
        self, name: str, mesh: trimesh.Trimesh, *, lower: float = 0.0
    ) -> viser.SceneNodeHandle:
        return self._scene.add_mesh_trimesh(
            name,
            mesh,
            cast_shadow=False,
            receive_shadow=False,
            position=(0.0, 0.0, -lower),
        )

    def _drop(self, *names: str) -> None:
        for name in names:
            self.surfaces.flat.pop(name, None)
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
    uv = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    faces = np.array([(0, 1, 2), (0, 2, 3)])
    return _textured(corners, faces, uv, picture, alphaMode="MASK", alphaCutoff=0.5)


def _shaded(skin: Skin, share: NDArray[np.float32]) -> trimesh.Trimesh:
    """The boundary in a measure's colours, in the same way: each vertex at its place on a picture
    of the scale."""
    steps = 256
    picture = np.full((1, steps, 4), 255, np.uint8)
    picture[..., :3] = coloured(np.linspace(0.0, 1.0, steps))
    picture[..., 3] = round(255 * _COLOURED)
    along = (share * (steps - 1) + 0.5) / steps  # between the middles of its ends
    uv = np.stack((along, np.full_like(along, 0.5)), axis=-1)
    return _textured(skin.vertices, skin.faces, uv, Image.fromarray(picture), alphaMode="BLEND")


def _textured(
    vertices: NDArray[Any],
    faces: NDArray[Any],
    uv: NDArray[Any],
    picture: Image.Image,
    **alpha: object,
) -> trimesh.Trimesh:
    material = PBRMaterial(
        baseColorTexture=picture,
        baseColorFactor=[0, 0, 0, 255],
        emissiveTexture=picture.convert("RGB"),
        emissiveFactor=[1.0, 1.0, 1.0],
        metallicFactor=0.0,
        roughnessFactor=1.0,
        doubleSided=True,
        **alpha,
    )
    visual = TextureVisuals(uv=uv, material=material)
    return trimesh.Trimesh(vertices=vertices, faces=faces, visual=visual, process=False)
