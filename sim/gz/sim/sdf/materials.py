"""Reads `<material>` and `<surface>`: colour and texture of a `<visual>`, friction and bitmask of a `<collision>`.

Warns about direction-dependent friction, which is not simulated.

Source: SDFormat, elements `<material>` and `<surface>`, http://sdformat.org/spec
Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/rendering/MaterialParser/gazebo.material (names and diffuse
colours of scripts, of which Gazebo reads neither alpha nor textures)
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.resources import Resources
from gz_course.sim.gz.sim.sdf.textures import Pixels

Rgba = tuple[float, float, float, float]
GREY: Rgba = (0.7, 0.7, 0.7, 1.0)
_PAVED = (0.8, 0.8, 0.8)
_PAVED_NAMES = (
    "footway lane_1 lanes_2 lanes_4 lanes_6 motorway pedestrian primary residential road secondary steps tertiary trunk"
)
_SCRIPT_COLOURS: dict[str, tuple[float, ...]] = {
    "grey": (0.7, 0.7, 0.7),
    "gray": (0.7, 0.7, 0.7),
    "darkgrey": (0.175, 0.175, 0.175),
    "darkgray": (0.175, 0.175, 0.175),
    "white": (1.0, 1.0, 1.0),
    "flatblack": (0.1, 0.1, 0.1),
    "black": (0.0, 0.0, 0.0),
    "red": (1.0, 0.0, 0.0),
    "redbright": (0.87, 0.26, 0.07),
    "green": (0.0, 1.0, 0.0),
    "blue": (0.0, 0.0, 1.0),
    "skyblue": (0.0, 0.0, 1.0),
    "yellow": (1.0, 1.0, 0.0),
    "zincyellow": (0.9725, 0.9529, 0.2078),
    "darkyellow": (0.7, 0.7, 0.0),
    "orange": (1.0, 0.5088, 0.0468),
    "purple": (1.0, 0.0, 1.0),
    "turquoise": (0.0, 1.0, 1.0),
    "indigo": (0.33, 0.0, 0.5),
    "gold": (0.8, 0.64869, 0.120759),
    "pioneer2body": (0.681193, 0.000923, 0.000923),
    "lighton": (0.0, 1.0, 0.0),
    "lightoff": (1.0, 0.0, 0.0),
    "redglow": (1.0, 0.0, 0.0),
    "turquoiseglowoutline": (0.0, 1.0, 1.0),
    "greentransparent": (0.0, 1.0, 0.0),
    "bluetransparent": (0.0, 0.0, 1.0),
    "yellowtransparent": (1.0, 1.0, 0.0),
    "orangetransparent": (1.0, 0.44, 0.0),
    "darkmagentatransparent": (0.6, 0.0, 0.6),
    "greytransparent": (0.5, 0.5, 0.5),
    "blacktransparent": (0.0, 0.0, 0.0),
    "bluelaser": (0.0, 0.0, 1.0),
    "lightbluelaser": (0.5, 0.5, 1.0),
    "jointanchor": (1.0, 1.0, 1.0),
    # gz-sim reads no textures of scripts, so these are white.
    "wood": (1.0, 1.0, 1.0),
    "woodpallet": (1.0, 1.0, 1.0),
    "bricks": (1.0, 1.0, 1.0),
    "buildingframe": (1.0, 1.0, 1.0),
    **dict.fromkeys(_PAVED_NAMES.split(), _PAVED),
}
_MEANT_COLOURS: dict[str, tuple[float, ...]] = {
    # The scripts of these state no diffuse colour: their other words, or their pictures, say what is meant.
    "whiteglow": (1.0, 1.0, 1.0),
    "greenglow": (0.0, 1.0, 0.0),
    "blueglow": (0.0, 0.0, 1.0),
    "yellowglow": (1.0, 1.0, 0.0),
    "purpleglow": (1.0, 0.0, 1.0),
    "turquoiseglow": (0.0, 1.0, 1.0),
    "redtransparent": (1.0, 0.0, 0.0, 0.5),
    "redtransparentoverlay": (1.0, 0.0, 0.0, 0.5),
    "greentransparentoverlay": (0.0, 1.0, 0.0, 0.5),
    "bluetransparentoverlay": (0.0, 0.0, 1.0, 0.5),
    "orangetransparentoverlay": (1.0, 0.5088, 0.0468, 0.8),
    "darkorangetransparentoverlay": (0.6, 0.305, 0.028, 0.8),
    "woodfloor": (0.55, 0.4, 0.25),
    "ceilingtiled": (0.85, 0.85, 0.82),
    "paintedwall": (0.8, 0.78, 0.7),
    "pioneerbody": (0.5, 0.0, 0.0),
    "tarmac": (0.2, 0.2, 0.2),
    "runway": (0.3, 0.3, 0.3),
    "grass": (0.25, 0.5, 0.2),
    "mud": (0.35, 0.25, 0.15),
    "cloudysky": (0.7, 0.8, 0.9),
    "checkerblue": (0.2, 0.3, 0.7),
}


def read_colour(visual: Element, diagnostics: Diagnostics) -> Rgba:
    """Return the colour of a `<visual>`: its Gazebo script if that is known, else diffuse, else ambient, else grey."""
    transparency = min(1.0, max(0.0, visual.number("transparency", 0.0)))
    material = visual.find("material")
    red, green, blue, alpha = GREY
    if material is not None:
        stated = material.find("diffuse") or material.find("ambient")
        script = material.find("script")
        if stated is not None and stated.text and not _is_known(script):
            words = stated.text.split()
            values = [_unit(value) for value in stated.floats(4 if len(words) == 4 else 3)]
            red, green, blue = values[:3]
            alpha = values[3] if len(values) == 4 else 1.0
        elif script is not None and (script.text or script.text_of("name")):
            red, green, blue, alpha = _script_colour(script, diagnostics)
        elif albedo_map(visual) is not None:
            red, green, blue = 1.0, 1.0, 1.0
    return red, green, blue, alpha * (1.0 - transparency)


def albedo_map(visual: Element) -> Element | None:
    """Return the `<albedo_map>` of a `<visual>`: that of the metal workflow, else that of the specular one."""
    for workflow in ("metal", "specular"):
        found = visual.find(f"material/pbr/{workflow}/albedo_map")
        if found is not None and found.text:
            return found
    return None


def read_albedo(visual: Element, diagnostics: Diagnostics, resources: Resources) -> Pixels | None:
    """Return the texture of a `<visual>`, or None, after a warning if its file cannot be used."""
    found = albedo_map(visual)
    if found is None:
        return None
    try:
        return resources.read_texture(resources.find_file(found.text, found.folder))
    except (ResourceError, OSError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        diagnostics.warn(found.where, f"{reason}; visual '{visual.name}' has its plain colour")
        return None


def _unit(value: float) -> float:
    return min(1.0, max(0.0, value))


def _is_known(script: Element | None) -> bool:
    """Return whether a script is one of Gazebo's own with a colour, which takes precedence over that beside it."""
    name = script.text_of("name", script.text) if script is not None else ""
    return name.startswith("Gazebo/") and name.rsplit("/", 1)[-1].lower() in _SCRIPT_COLOURS


def _script_colour(script: Element, diagnostics: Diagnostics) -> Rgba:
    """Return the colour that `<script><name>Gazebo/Red</name></script>` names; old files name it in `<script>`."""
    name = script.text_of("name", script.text)
    known = _SCRIPT_COLOURS | _MEANT_COLOURS
    found = known.get(name.rsplit("/", 1)[-1].lower())
    if found is not None:
        return found[0], found[1], found[2], found[3] if len(found) == 4 else 1.0
    if name.startswith("Gazebo/"):
        hint = did_you_mean(name.rsplit("/", 1)[-1].lower(), known, listing="colours that are known are")
        diagnostics.warn(script.where, f"material script '{name}' is not known, grey is used{hint}")
    else:
        text = f"material script '{name}' is a file of its own, which is not read; grey is used, give a <diffuse>"
        diagnostics.warn(script.where, text)
    return GREY


def read_friction(collision: Element, diagnostics: Diagnostics) -> float:
    """Return the Coulomb friction coefficient of a `<collision>` (Gazebo's default is 1)."""
    surface = collision.find("surface/friction/ode")
    mu = surface.number("mu", 1.0) if surface is not None else 1.0
    if mu < 0.0:
        raise (surface or collision).error(f"friction <mu> must not be negative, got {mu:g}")
    contact = collision.find("surface/contact")
    if contact is not None and contact.flag("collide_without_contact", False):
        text = f"<collide_without_contact> is not simulated, collision '{collision.name}' pushes what it touches"
        diagnostics.warn(contact.where, text)
    return min(mu, 1e6)


def warn_of_directions(collision: Element, mu: float, honoured: bool, diagnostics: Diagnostics) -> None:
    """Warn about what a `<collision>` of friction `mu` states of directions and is not simulated; `honoured`: `mu2`,
    `fdir1` and `slip1` are.
    """
    surface, name = collision.find("surface/friction/ode"), collision.name
    if surface is None:
        return
    if honoured:
        _warn_of_slip(surface, ("slip2",), name, diagnostics)
        return
    mu2 = surface.number("mu2", mu)
    if mu2 != mu:
        text = f"friction is the same in all directions here: collision '{name}' uses <mu> {mu:g}, not <mu2> {mu2:g}"
        diagnostics.warn(surface.where, text)
    directed = surface.find("fdir1") is not None and any(surface.vector("fdir1", (0.0, 0.0, 0.0)))
    if directed and (mu2 != mu or any(surface.number(tag, 0.0) for tag in ("slip1", "slip2"))):
        text = f"<fdir1> of collision '{name}' is ignored: friction is the same in all directions here"
        diagnostics.warn(surface.where, text)
    _warn_of_slip(surface, ("slip1", "slip2"), name, diagnostics)


def _warn_of_slip(surface: Element, tags: Iterable[str], name: str, diagnostics: Diagnostics) -> None:
    for tag in tags:
        slip = surface.number(tag, 0.0)
        if slip > 0.0 and math.isfinite(slip):
            text = f"<{tag}> {slip:g} of collision '{name}' is ignored: only the round wheels of a DiffDrive slip, by "
            text += "<slip1>, with an <fdir1> along the axle"
            diagnostics.warn(surface.where, text)
            break


def read_restitution(collision: Element) -> float:
    """Return the restitution coefficient of a `<collision>`, 0 to 1; its `<threshold>` is ignored, as in Gazebo."""
    bounce = collision.find("surface/bounce")
    value = bounce.number("restitution_coefficient", 0.0) if bounce is not None else 0.0
    if not 0.0 <= value <= 1.0:
        raise (bounce or collision).error(f"<restitution_coefficient> must be from 0 to 1, got {value:g}")
    return value


def read_bitmask(collision: Element) -> int:
    """Return the bitmask of a `<collision>`: two collisions can touch if they have a bit in common."""
    text = collision.text_of("surface/contact/collide_bitmask", "0xFF")
    try:
        return int(text, 0) & 0x7FFFFFFF
    except ValueError:
        raise collision.error(f"<collide_bitmask> must be a whole number such as 0x01, got '{text}'") from None
