"""The graph of the frames of a description in the DOT language, as `gz sdf --graph` prints it.

Graph `pose`: an edge leads from the frame that a pose is relative to, to the frame that has the pose. Graph `frame`: an
edge leads from a frame to the one it is attached to, from a joint to its child, and from a model to its canonical link.
The edge between a model and its frame `__model__` has the label 0, all others 1. Vertices and edges are numbered and
ordered as those of libsdformat 14.

Source: https://github.com/gazebosim/sdformat/blob/sdf14/src/FrameSemantics.cc
Source: https://github.com/gazebosim/sdformat/blob/sdf14/src/cmd/gz_TEST.cc (GraphCmd)
"""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.sdf.element import Element

KINDS = ("pose", "frame")


class FrameGraph:
    """The graph of the world, or else of the model, of a description whose includes are replaced.

    Raises SdfError for a frame that does not exist, and if there is neither a world nor a model.
    """

    def __init__(self, root: Element, kind: str) -> None:
        self._of_poses = kind == "pose"
        self._vertices: dict[str, int] = {}
        self._edges: list[tuple[int, int, int]] = []
        world, model = root.find("world"), root.find("model")
        if world is not None:
            self._add_world(world)
        elif model is not None:
            top = self._add_vertex("__root__")
            self._add_model(model, "")
            if self._of_poses:
                self._edges.append((top, self._vertices[model.name], 1))
        else:
            raise root.error("the file has neither a <world> nor a <model>, so there is no graph of its frames")

    def __str__(self) -> str:
        lines = [f'  {number} [label="{name} ({number})"];' for name, number in self._vertices.items()]
        lines += [f"  {start} -> {end} [label={label}];" for start, end, label in self._edges]
        return "\n".join(("digraph {", *lines, "}"))

    def _add_vertex(self, name: str) -> int:
        return self._vertices.setdefault(name, len(self._vertices))

    def _add_world(self, world: Element) -> None:
        top = self._add_vertex("__root__") if self._of_poses else 0
        own = self._add_vertex("world")
        if self._of_poses:
            self._edges.append((top, own, 1))
        for model in world.all("model"):
            self._add_model(model, "")
        for each in (*world.all("joint"), *world.all("frame")):
            self._add_vertex(each.name)
        self._connect(world, "", "world")

    def _add_model(self, model: Element, scope: str) -> None:
        own = self._add_vertex(scope + model.name)
        scope = f"{scope}{model.name}::"
        inner = self._add_vertex(f"{scope}__model__")
        self._edges.append((own, inner, 0))
        for each in (*model.all("link"), *model.all("joint"), *model.all("frame")):
            self._add_vertex(scope + each.name)
        for nested in model.all("model"):
            self._add_model(nested, scope)
        self._connect(model, scope, "__model__")
        canonical = model.attributes.get("canonical_link") or _first_link(model)
        if not self._of_poses and canonical:
            self._edges.append((inner, self._number(canonical, scope, model), 1))

    def _connect(self, holder: Element, scope: str, own: str) -> None:
        """Add the edges of the frames that belong directly to a world or model."""
        for each, default in _frames(holder, own, poses=self._of_poses):
            number = self._vertices[scope + each.name]
            pose = each.find("pose") if self._of_poses else None
            stated = (pose.attributes.get("relative_to") or pose.attributes.get("frame")) if pose is not None else None
            other = self._number(stated or default, scope, pose or each)
            self._edges.append((other, number, 1) if self._of_poses else (number, other, 1))

    def _number(self, name: str, scope: str, asker: Element) -> int:
        found = self._vertices.get(scope + name)
        if found is None:
            known = [each.removeprefix(scope) for each in self._vertices if each.startswith(scope)]
            hint = did_you_mean(name, known, listing="frames are")
            raise asker.error(f"<{asker.tag}> names frame '{name}', which does not exist{hint}")
        return found


def _frames(holder: Element, own: str, *, poses: bool) -> Iterator[tuple[Element, str]]:
    """Yield the frames of a world or model that have an edge, each with the frame it belongs to by default."""
    if poses:
        yield from ((link, own) for link in holder.all("link"))
        if own == "world":
            yield from ((model, own) for model in holder.all("model"))
    yield from ((joint, joint.text_of("child")) for joint in holder.all("joint"))
    yield from ((frame, frame.attributes.get("attached_to") or own) for frame in holder.all("frame"))
    if poses and own != "world":
        yield from ((model, own) for model in holder.all("model"))


def _first_link(model: Element) -> str:
    """Return the scoped name of a model's first link, or of the first one of its nested models; empty if none."""
    link = model.find("link")
    if link is not None:
        return link.name
    nested = ((each, _first_link(each)) for each in model.all("model"))
    return next((f"{each.name}::{found}" for each, found in nested if found), "")
