"""Named frames of SDF (`relative_to`, `attached_to`, `<frame>`, `a::b`) and their poses.

The reader makes one `Scope` per model and one for the world, adds every named frame, and gets poses in the frame of the
scope. Rules are those of SDF 1.7 and later: a pose without `relative_to` is relative to the model for links, nested
models and frames without `attached_to`; to the child link for joints; to `attached_to` for other frames.

Source: Pose Frame Semantics, http://sdformat.org/tutorials?tut=pose_frame_semantics
"""

from __future__ import annotations

from dataclasses import dataclass, field

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.pose import IDENTITY, Pose
from gz_course.sim.gz.sim.sdf.element import Element


@dataclass(eq=False)
class _Frame:
    pose: Pose
    relative_to: str
    element: Element
    attached_to: str
    is_link: bool = False


@dataclass(eq=False)
class Scope:
    """Named frames of one model or of the world; `own` is the name of the scope's own frame, `__model__` or `world`."""

    own: str
    element: Element
    flat_names: bool = False
    """SDF before 1.8: a name with `::` is that of a part of a nested model."""
    frames: dict[str, _Frame] = field(default_factory=dict)
    nested: dict[str, Scope] = field(default_factory=dict)
    placed: dict[str, Pose] = field(default_factory=dict)

    def add(
        self,
        name: str,
        element: Element,
        *,
        pose: Pose = IDENTITY,
        relative_to: str = "",
        attached_to: str = "",
        is_link: bool = False,
        nested: Scope | None = None,
    ) -> None:
        """Add a named frame. Raises SdfError if the name is taken or reserved."""
        if not name:
            raise element.error(f"<{element.tag}> needs a name attribute")
        if name == "world" or (name.startswith("__") and name.endswith("__")):
            raise element.error(f"the name '{name}' is reserved; call this <{element.tag}> something else")
        if "::" in name and not self.flat_names:
            raise element.error(f"the name '{name}' must not contain '::', which separates scopes")
        if name in self.frames:
            first = self.frames[name].element
            raise element.error(
                f"<{element.tag}> is called '{name}', but <{first.tag}> on line {first.line} is already; "
                "names in one model must differ"
            )
        self.frames[name] = _Frame(pose, relative_to or self.own, element, attached_to, is_link)
        if nested is not None:
            self.nested[name] = nested

    def pose_of(self, name: str, asker: Element) -> Pose:
        """Return the pose of frame `name` in the frame of the scope.

        Raises SdfError with the line of `asker` if there is no such frame.
        """
        chain: dict[str, tuple[Pose, Element]] = {}
        while True:
            if name == self.own or (name == "__model__" and self.own == "world"):
                pose = IDENTITY
                break
            if name in self.placed:
                pose = self.placed[name]
                break
            if name in chain:
                names = list(chain)
                circle = " -> ".join([*names[names.index(name) :], name])
                raise chain[name][1].error(f"the poses of these frames depend on each other in a circle: {circle}")
            outer, scoped, inner = name.partition("::")
            if scoped and name not in self.frames:
                if outer not in self.nested:
                    raise self._unknown(outer, asker)
                chain[name] = (self.nested[outer].pose_of(inner, asker), asker)
                name = outer
                continue
            frame = self.frames.get(name)
            if frame is None:
                raise self._unknown(name, asker)
            chain[name] = (frame.pose, frame.element)
            name, asker = frame.relative_to, frame.element
        for key, (step, _) in reversed(chain.items()):
            pose = pose * step
            self.placed[key] = pose
        return pose

    def link_behind(self, name: str, asker: Element) -> str:
        """Return the scoped name of the link that frame `name` is fixed to (`world` stays `world`)."""
        seen: list[str] = []
        while True:
            if name == "world":
                return name
            if "::" in name and name not in self.frames:
                outer, _, inner = name.partition("::")
                if outer not in self.nested:
                    raise self._unknown(outer, asker)
                return f"{outer}::{self.nested[outer].link_behind(inner, asker)}"
            if name == self.own:
                name = self.canonical_link(asker)
                continue
            frame = self.frames.get(name)
            if frame is None:
                raise self._unknown(name, asker)
            if frame.is_link:
                return name
            if name in seen:
                raise frame.element.error(f"frame '{name}' is attached to itself through {' -> '.join(seen)}")
            seen.append(name)
            if name in self.nested:
                return f"{name}::{self.nested[name].canonical_link(asker)}"
            name = frame.attached_to or self.own

    def check(self) -> None:
        """Look at every `<frame>`, also at those that nothing uses.

        Raises SdfError for a `relative_to` or `attached_to` that names nothing, and for a circle of them.
        """
        for name, frame in self.frames.items():
            if frame.element.tag != "frame":
                continue
            self.pose_of(name, frame.element)
            chain, base = [name], frame
            while base.element.tag == "frame" and base.attached_to:
                self.pose_of(base.attached_to, base.element)
                chain.append(base.attached_to)
                if base.attached_to in chain[:-1]:
                    circle = " -> ".join(chain)
                    raise base.element.error(f"these frames are attached to each other in a circle: {circle}")
                if base.attached_to not in self.frames:
                    break  # the scope itself, or a frame of a nested model
                base = self.frames[base.attached_to]

    def canonical_link(self, asker: Element) -> str:
        """Return the link to which the model's own frame is fixed: `canonical_link`, else the first link, also of a
        nested model.
        """
        chosen = self.element.attributes.get("canonical_link", "")
        if chosen:
            return self.link_behind(chosen, self.element)
        for name, frame in self.frames.items():
            if frame.is_link:
                return name
        for name, scope in self.nested.items():
            return f"{name}::{scope.canonical_link(asker)}"
        raise asker.error(f"model '{self.element.name}' has no link; give it at least one <link>")

    def _unknown(self, name: str, asker: Element) -> Exception:
        what = "the world" if self.own == "world" else f"model '{self.element.name}'"
        return asker.error(f"{what} has no frame '{name}'{did_you_mean(name, self.frames, listing='its frames are')}")
