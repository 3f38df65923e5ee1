"""Converts shapes and materials to gz.msgs.Geometry, gz.msgs.Material and gz.msgs.Surface.

Called by `gz.sim.scene.message` for every visual and collision. Sizes, colours, friction and bitmasks come from the
description, which may have been changed at run time; files, textures and other values come from the SDF element.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/Conversions.cc
"""

from __future__ import annotations

from typing import Any

from gz_course.sim.gz.msgs.geometry_pb2 import Geometry as GeometryMessage
from gz_course.sim.gz.msgs.material_pb2 import Material
from gz_course.sim.gz.sim.errors import ResourceError
from gz_course.sim.gz.sim.scene.fields import set_colour, set_vector
from gz_course.sim.gz.sim.sdf.description import Collision, Geometry, Visual
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.materials import GREY
from gz_course.sim.gz.sim.sdf.resources import Resources

_MAPS = ("normal_map", "environment_map", "ambient_occlusion_map", "emissive_map", "light_map")
_METAL_MAPS = ("metalness_map", "roughness_map")
_SPECULAR_MAPS = ("glossiness_map", "specular_map")


def fill_geometry(message: Any, owner: Collision | Visual, resources: Resources) -> None:
    """Write the shape of a collision or visual into a gz.msgs.Geometry; lengths are in [m]."""
    geometry, kinds = owner.geometry, GeometryMessage
    x, y, z = geometry.size
    if geometry.kind in ("box", "sphere", "cylinder", "capsule", "cone", "ellipsoid", "plane"):
        message.type = kinds.Type.Value(geometry.kind.upper())
    if geometry.kind == "box":
        set_vector(message.box.size, geometry.size)
    elif geometry.kind == "sphere":
        message.sphere.radius = x / 2.0
    elif geometry.kind in ("cylinder", "capsule", "cone"):
        shape = getattr(message, geometry.kind)
        shape.radius, shape.length = x / 2.0, z
    elif geometry.kind == "ellipsoid":
        set_vector(message.ellipsoid.radii, (x / 2.0, y / 2.0, z / 2.0))
    elif geometry.kind == "plane":
        set_vector(message.plane.normal, geometry.normal)
        set_vector(message.plane.size, (x, y))
    else:
        _fill_from_file(message, geometry, owner.element.find("geometry") or owner.element, resources)


def _fill_from_file(message: Any, geometry: Geometry, element: Element, resources: Resources) -> None:
    """Write a mesh, heightmap or polyline: its file and parameters, without triangles."""
    shape = element.find(geometry.kind)
    if shape is None:
        message.type = GeometryMessage.EMPTY
    elif geometry.kind == "mesh":
        message.type = GeometryMessage.MESH
        message.mesh.filename = _path(shape, "uri", resources)
        set_vector(message.mesh.scale, shape.vector("scale", (1.0, 1.0, 1.0)))
        submesh = shape.find("submesh")
        if submesh is not None:
            message.mesh.submesh = submesh.text_of("name")
            message.mesh.center_submesh = submesh.flag("center", False)
    elif geometry.kind == "heightmap":
        message.type = GeometryMessage.HEIGHTMAP
        _fill_heightmap(message.heightmap, geometry, shape, resources)
    elif geometry.kind == "polyline":
        message.type = GeometryMessage.POLYLINE
        for each in element.all("polyline"):
            added = message.polyline.add(height=each.number("height", 1.0))
            for point in each.all("point"):
                set_vector(added.point.add(), point.floats(2))


def _fill_heightmap(message: Any, geometry: Geometry, shape: Element, resources: Resources) -> None:
    """Write a heightmap. Its origin is left at zero, because `<pos>` is part of the pose of the visual."""
    message.filename = _path(shape, "uri", resources)
    set_vector(message.size, geometry.size)
    message.use_terrain_paging = shape.flag("use_terrain_paging", False)
    message.sampling = max(0, shape.integer("sampling", 1))
    for texture in shape.all("texture"):
        message.texture.add(
            diffuse=_path(texture, "diffuse", resources),
            normal=_path(texture, "normal", resources),
            size=texture.number("size", 10.0),
        )
    for blend in shape.all("blend"):
        message.blend.add(min_height=blend.number("min_height", 0.0), fade_dist=blend.number("fade_dist", 0.0))


def _path(element: Element, tag: str, resources: Resources) -> str:
    """Return the absolute path of the file that child `tag` names, or its text if that file does not exist."""
    uri = element.text_of(tag)
    if not uri:
        return ""
    try:
        return str(resources.real(resources.find_file(uri, element.folder)))
    except ResourceError:
        return uri


def transparency(visual: Visual) -> float:
    """Return the `<transparency>` of a visual, from 0 (opaque) to 1."""
    return min(1.0, max(0.0, visual.element.number("transparency", 0.0)))


def fill_material(visual: Visual, resources: Resources) -> Material | None:
    """Return the material of a visual, or None if it has no `<material>` and no colour of its own.

    Diffuse is the present colour of the visual; ambient is the same unless `<ambient>` is given.
    """
    element = visual.element.find("material")
    solid = 1.0 - transparency(visual)
    red, green, blue, alpha = visual.rgba
    if element is None and (red, green, blue) == GREY[:3]:
        return None
    message = Material()
    now = (red, green, blue, min(1.0, alpha / solid) if solid > 0.0 else 1.0)
    set_colour(message.diffuse, now)
    if element is None:
        set_colour(message.ambient, now)
        set_colour(message.specular, (0.0, 0.0, 0.0))
        set_colour(message.emissive, (0.0, 0.0, 0.0))
        message.lighting = True
        return message
    set_colour(message.ambient, _colour(element, "ambient", now))
    set_colour(message.specular, _colour(element, "specular", (0.0, 0.0, 0.0)))
    set_colour(message.emissive, _colour(element, "emissive", (0.0, 0.0, 0.0)))
    message.lighting = element.flag("lighting", True)
    message.double_sided = element.flag("double_sided", False)
    message.render_order = element.number("render_order", 0.0)
    message.shininess = element.number("shininess", 0.0)
    script = element.find("script")
    if script is not None:
        message.script.name = script.text_of("name", script.text)
        message.script.uri.extend(each.text for each in script.all("uri"))
    pbr = element.find("pbr")
    if pbr is not None:
        _fill_pbr(message.pbr, pbr, resources)
    return message


def _colour(element: Element, tag: str, default: tuple[float, ...]) -> tuple[float, ...]:
    child = element.find(tag)
    if child is None or not child.text:
        return default
    return tuple(child.floats(4 if len(child.text.split()) == 4 else 3))


def _fill_pbr(message: Any, pbr: Element, resources: Resources) -> None:
    """Write the metal workflow of `<pbr>`, or the specular one if there is no metal workflow."""
    workflow = pbr.find("metal") or pbr.find("specular")
    if workflow is None:
        return
    metal = workflow.tag == "metal"
    message.type = Material.PBR.METAL if metal else Material.PBR.SPECULAR
    for name in ("albedo_map", *_MAPS, *(_METAL_MAPS if metal else _SPECULAR_MAPS)):
        if workflow.find(name) is not None:
            setattr(message, name, _path(workflow, name, resources))
    light_map = workflow.find("light_map")
    if light_map is not None:
        uv_set = light_map.attributes.get("uv_set", "0")
        message.light_map_texcoord_set = int(uv_set) if uv_set.isdecimal() else 0
    if metal:
        message.metalness = workflow.number("metalness", 0.5)
        message.roughness = workflow.number("roughness", 0.5)
    else:
        message.glossiness = workflow.number("glossiness", 0.0)


def fill_surface(message: Any, collision: Collision) -> None:
    """Write the friction and contact parameters of a collision into a gz.msgs.Surface."""
    message.collide_bitmask = collision.bitmask
    message.friction.mu = message.friction.mu2 = collision.mu
    surface = collision.element.find("surface")
    ode = surface.find("friction/ode") if surface is not None else None
    if ode is not None:
        message.friction.mu2 = ode.number("mu2", collision.mu)
        set_vector(message.friction.fdir1, ode.vector("fdir1", (0.0, 0.0, 0.0)))
        message.friction.slip1, message.friction.slip2 = ode.number("slip1", 0.0), ode.number("slip2", 0.0)
    bounce = surface.find("bounce") if surface is not None else None
    if bounce is not None:
        message.restitution_coefficient = bounce.number("restitution_coefficient", 0.0)
        message.bounce_threshold = bounce.number("threshold", 1e5)
