"""Reads `<include>`: a model, light or world from another file, with the overrides given beside the `<uri>`.

`gz.sim.sdf.models` and `gz.sim.sdf.reader` open every include with it; `gz.sim.sdf.resources` finds the file. Each file
is parsed once. With `merge="true"` the children of the included model take the place of the include, and a frame
`_merged__NAME__model__` takes the place of the frame of that model.

Source: Composition, http://sdformat.org/tutorials?tut=composition
Source: Merging for Composition, http://sdformat.org/tutorials?tut=composition_merge_proposal
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError, SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf import plausibility, vocabulary
from gz_course.sim.gz.sim.sdf.element import Element, parse
from gz_course.sim.gz.sim.sdf.resources import Resources
from gz_course.sim.gz.sim.sdf.urdf.convert import sdf_of_robot
from gz_course.sim.gz.sim.sdf.urdf.xacro_file import restore_places

Version = tuple[int, int]
MOST_INCLUDES = 5000
"""Maximum number of includes in a world, because nested includes can grow exponentially."""
_KEPT_BY_PARENT = frozenset(("pose", "static", "self_collide", "allow_auto_disable", "enable_wind", "include_uri"))
_IN_WORLD = frozenset(("model", "include", "frame", "joint", "plugin"))
_OF_WORLDS = frozenset(("model", "include", "light", "frame", "joint", "plugin", "actor"))


@dataclass(frozen=True, eq=False, slots=True)
class Opened:
    """An element of a file, or one that an include refers to.

    `version` is the SDF version of its file, `place` the element in the including file, and `chain` lists the files
    being included.
    """

    element: Element
    version: Version
    place: Element
    chain: tuple[Path, ...] = ()

    @property
    def merged(self) -> bool:
        """Return whether this is an include with `merge="true"`."""
        return self.place is not self.element and self.place.attributes.get("merge", "false").lower() in ("true", "1")


def sdf_version(root: Element) -> Version:
    """Return the version of an `<sdf>` element. Raises `SdfError` if it is invalid."""
    text = root.attributes.get("version", "1.10")
    major, _, minor = text.partition(".")
    if not (major.isdigit() and minor.isdigit() and len(text) < 10):
        raise root.error(f"sdf version must look like 1.10, got '{text}'")
    return int(major), int(minor)


def read_root(text: str, file: str, diagnostics: Diagnostics) -> Element:
    """Return the `<sdf>` element of a text and check its elements and attributes; a URDF `<robot>` is converted."""
    root = parse(text, file)
    begin = text.lstrip().partition("<")[0].removeprefix("\ufeff").strip()
    if begin:
        diagnostics.warn(f"{file}:1", f"the text before the first tag is ignored: '{begin[:20]}'")
    restore_places(root)
    if root.tag == "robot":
        plausibility.check_origins(root, diagnostics)
        root = sdf_of_robot(root, diagnostics)
    elif root.tag != "sdf":
        text = f"the outermost element must be <sdf> or <robot>, got <{root.tag}>"
        raise root.error(f"{text}; put it between <sdf version='1.10'> and </sdf>")
    sdf_version(root)
    vocabulary.check(root, diagnostics)
    plausibility.check(root, diagnostics)
    return root


class Includes:
    """The includes of one world, with the names of the models that were not found."""

    def __init__(self, diagnostics: Diagnostics, resources: Resources) -> None:
        self.resources = resources
        self._diagnostics = diagnostics
        self._roots: dict[Path, Element] = {}
        self._count = 0
        self.skipped: set[str] = set()
        """Names of the models that were not found; joints to these models are skipped, too."""
        self.empty: set[str] = set()
        """Names of the models of the world that hold nothing but such includes, and are left out."""

    @property
    def found_all(self) -> bool:
        """Whether every model is there that a file has included so far."""
        return not (self.skipped or self.empty)

    def open(self, child: Element, version: Version, chain: tuple[Path, ...]) -> Opened | None:
        """Return `child`, or for an `<include>` the included element with its overrides.

        Returns None after a warning if the file was not found. Raises `SdfError` for files that include each other.
        """
        if child.tag != "include":
            return Opened(child, version, child, chain)
        uri = child.text_of("uri")
        if not uri:
            raise child.error("<include> needs a <uri>, for example <uri>model://ground_plane</uri>")
        self._count += 1
        if self._count > MOST_INCLUDES:
            raise child.error(f"the world opens more than {MOST_INCLUDES} includes; do files include each other twice?")
        try:
            path = self.resources.find_model(uri, child.folder)
        except ResourceError as error:
            self._diagnostics.warn(child.where, f"the include is skipped: {error}")
            self.skipped.add(child.text_of("name") or uri.rstrip("/").rsplit("/", 1)[-1])
            return None
        real = self.resources.real(path)
        if real in chain:
            names = " -> ".join(f"{each.parent.name}/{each.name}" for each in (*chain[chain.index(real) :], real))
            raise child.error(f"'{uri}' is included inside itself: {names}")
        root = self._root(path)
        found = self._entity(root, child, uri, path)
        if found is None:
            return None
        return Opened(self._overridden(found, child), sdf_version(root), child, (*chain, real))

    def _root(self, path: Path) -> Element:
        root = self._roots.get(path)
        if root is None:
            root = self._roots[path] = read_root(self.resources.read_text(path), str(path), self._diagnostics)
        return root

    def _entity(self, root: Element, include: Element, uri: str, path: Path) -> Element | None:
        merge = include.attributes.get("merge", "false").lower() in ("true", "1")
        found = root.find("model") or root.find("light") or (root.find("world") if merge else None)
        if found is None and root.find("actor") is not None:
            self._diagnostics.warn(include.where, f"actors are not simulated here, '{uri}' is skipped")
            return None
        if found is None:
            raise SdfError(f"{include.where}: '{uri}' leads to {path}, which holds no <model>")
        return found

    def _overridden(self, found: Element, include: Element) -> Element:
        """Return a copy of the included element with the overrides of the `<include>`."""
        made = replace(found, attributes=dict(found.attributes), children=list(found.children))
        for tag in ("static", "pose"):
            override = include.find(tag)
            if override is not None:
                made.children = [child for child in made.children if child.tag != tag]
                made.children.append(override)
        name = include.text_of("name")
        if name:
            made.attributes["name"] = name
        placement = include.text_of("placement_frame")
        if placement:
            if include.find("pose") is None:
                raise include.error("<placement_frame> of an <include> needs a <pose>: it says where that frame goes")
            made.attributes["placement_frame"] = placement
        made.children.extend(include.all("plugin"))
        for child in include.children:
            if ":" in child.tag:
                text = f"<{child.tag}> in an <include> is not carried out, the file is included as it is"
                self._diagnostics.warn(child.where, text)
        return made


def merged_children(opened: Opened, pose: Pose, base: str, link: str, *, world: bool) -> list[Element]:
    """Return the children of a merged include as elements of the including model or world.

    `pose`, given in the frame `base`, is the pose of the included model's frame, and `link` is the link to which that
    frame is fixed. Poses relative to the included model become relative to the frame that replaces it.
    """
    model = opened.element
    if model.tag == "world":
        return [child for child in model.children if child.tag in _OF_WORLDS]
    proxy = f"_merged__{model.name}__model__"
    values = " ".join(repr(float(value)) for value in (*pose.position, *pose.quaternion[1:], pose.quaternion[0]))
    stated = {"rotation_format": "quat_xyzw", **({"relative_to": base} if base else {})}
    place = opened.place
    frame = Element(
        "frame", {"name": proxy, **({} if world else {"attached_to": link})}, file=place.file, line=place.line
    )
    frame.children.append(Element("pose", stated, values, file=place.file, line=place.line))
    if not world and not base:
        frame.children[0].attributes["relative_to"] = "__model__"
    made = [frame]
    for child in model.children:
        if child.tag in _KEPT_BY_PARENT:
            continue
        if world and child.tag not in _IN_WORLD:
            what = f"<{child.tag}> '{child.name}' of '{model.name}'"
            raise place.error(f"{what} cannot be merged into a <world>, which holds models; leave merge away")
        made.append(_relative_to(child, proxy, opened.version))
    return made


def _relative_to(element: Element, proxy: str, version: Version) -> Element:
    """Return a copy of a child of a model in which the model's frame is called `proxy`."""
    made = _renamed(element, proxy, version)
    pose = made.find("pose")
    stated = "" if pose is None else pose.attributes.get("relative_to", "") or pose.attributes.get("frame", "")
    if made.tag in ("link", "model", "include") and not stated:
        fresh = Element("pose", {"relative_to": proxy}, file=made.file, line=made.line)
        if pose is not None:
            fresh = replace(pose, attributes={**pose.attributes, "relative_to": proxy})
        elif made.tag == "include":
            return made  # the pose is in its own file
        made.children = [child for child in made.children if child.tag != "pose"]
        made.children.insert(0, fresh)
    if made.tag == "frame" and not made.attributes.get("attached_to"):
        made.attributes["attached_to"] = proxy
    return made


def _renamed(element: Element, proxy: str, version: Version) -> Element:
    attributes = {
        key: proxy if key in ("relative_to", "attached_to", "expressed_in", "frame") and value == "__model__" else value
        for key, value in element.attributes.items()
    }
    text = proxy if element.tag in ("parent", "child") and element.text == "__model__" else element.text
    children = element.children
    if element.tag not in ("model", "plugin"):
        children = [_renamed(child, proxy, version) for child in children]
    made = replace(element, attributes=attributes, text=text, children=list(children))
    if made.tag in ("axis", "axis2"):
        xyz = made.find("xyz")
        old = version <= (1, 4) or made.flag("use_parent_model_frame", False)
        if xyz is not None and old and not xyz.attributes.get("expressed_in"):
            xyz.attributes["expressed_in"] = proxy
            made.children = [child for child in made.children if child.tag != "use_parent_model_frame"]
    return made
