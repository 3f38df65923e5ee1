"""Random worlds for the comparison with libsdformat: frames that hang on each other in any way SDF allows."""

from __future__ import annotations

import random
from pathlib import Path

KINDS = ("fixed", "revolute", "continuous", "prismatic", "ball", "universal", "revolute2", "screw")


class WorldMaker:
    """Makes one world (and the model files it includes, in `folder`) from one number."""

    def __init__(self, seed: int, folder: Path) -> None:
        self.chance = random.Random(seed)
        self.folder = folder
        self.included = 0
        # Files of old versions have no frames; their axes can be in the model's frame.
        self.version = self.chance.choice(("1.4", "1.5", "1.6", "1.7", "1.8", "1.9", "1.9", "1.9"))
        self.old = self.version < "1.7"

    def pose(self, frames: list[str], *, default: bool = True) -> str:
        """A <pose>, most of the time relative to one of `frames`."""
        numbers = [self.chance.uniform(-3, 3) for _ in range(6)]
        attributes = ""
        if frames and not self.old and self.chance.random() < (0.6 if default else 1.0):
            attributes += f" relative_to='{self.chance.choice(frames)}'"
        if self.version == "1.9" and self.chance.random() < 0.2:
            attributes += " degrees='true'"
            numbers[3:] = [57.0 * value for value in numbers[3:]]
        return f"<pose{attributes}>{' '.join(map(repr, numbers))}</pose>" if self.chance.random() < 0.85 else ""

    def world(self) -> str:
        """The text of a world with models, nested and included ones, lights and frames."""
        frames: list[str] = []
        parts = []
        for number in range(self.chance.randint(1, 4)):
            if not self.old and self.chance.random() < 0.3:
                name = f"wf{number}"
                parts.append(f"<frame name='{name}'>{self.pose(frames)}</frame>")
                frames.append(name)
            name = f"m{number}"
            if self.chance.random() < 0.3:
                parts.append(self.include(name, frames, merge=False))
                frames.append(name)
            else:
                text, inside, _ = self.model(name, frames, 0)
                parts.append(text)
                frames.extend([name, *(f"{name}::{each}" for each in inside)])
        parts.append(f"<light name='lamp' type='point'>{self.pose(frames)}</light>")
        self.chance.shuffle(parts)
        return f"<sdf version='{self.version}'><world name='w'>{''.join(parts)}</world></sdf>"

    def model(self, name: str, around: list[str], depth: int) -> tuple[str, list[str], list[str]]:
        """A model, the names of its frames and of its links, those of nested models scoped."""
        chance = self.chance
        frames: list[str] = ["__model__"]
        links: list[str] = []
        parts: list[str] = []
        for number in range(chance.randint(1, 4)):
            link = f"l{number}"
            shape = "<geometry><sphere><radius>1</radius></sphere></geometry>"
            collision = f"<collision name='c'>{self.pose(frames)}{shape}</collision>"
            parts.append(f"<link name='{link}'>{self.pose(frames)}{collision if chance.random() < 0.5 else ''}</link>")
            links.append(link)
            frames.append(link)
            if not self.old and chance.random() < 0.4:
                frame = f"f{number}"
                attached = f" attached_to='{chance.choice(frames)}'" if chance.random() < 0.6 else ""
                parts.append(f"<frame name='{frame}'{attached}>{self.pose(frames)}</frame>")
                frames.append(frame)
        nested: list[str] = []
        if depth < 2 and self.version > "1.4" and chance.random() < 0.5:
            inner = f"n{depth}"
            if chance.random() < 0.4:
                merge = self.version == "1.9" and chance.random() < 0.5
                parts.append(self.include(inner, frames, merge=merge))
                if merge:
                    links.append(f"{inner}_link")
                    frames.append(f"{inner}_link")
                else:
                    nested.append(f"{inner}::{inner}_link")
                    frames.append(inner)
            else:
                text, inside, carried = self.model(inner, frames, depth + 1)
                parts.append(text)
                nested.extend(f"{inner}::{each}" for each in carried)
                frames.extend([inner, *(f"{inner}::{each}" for each in inside)])
        everything = [*links, *nested]
        for number, child in enumerate(links[1:]):
            if chance.random() < 0.7:
                parts.append(self.joint(f"j{number}", everything, child, frames))
        chance.shuffle(parts)
        attributes = ""
        if not self.old and chance.random() < 0.3:
            attributes += f" canonical_link='{chance.choice(links)}'"
        if self.version >= "1.8" and len(frames) > 1 and chance.random() < 0.25:
            attributes += f" placement_frame='{chance.choice(frames[1:])}'"
        static = "<static>true</static>" if chance.random() < 0.1 else ""
        text = f"<model name='{name}'{attributes}>{static}{self.pose(around)}{''.join(parts)}</model>"
        return text, frames[1:], everything

    def joint(self, name: str, links: list[str], child: str, frames: list[str]) -> str:
        """A joint onto `child`; its axes are expressed in any frame."""
        chance = self.chance
        kind = chance.choice(KINDS)
        parent = chance.choice([*(each for each in links if each != child), "world"])
        axes = ""
        if kind not in ("fixed", "ball"):
            axes = self.axis("axis", frames)
        if kind in ("universal", "revolute2"):
            axes += self.axis("axis2", frames)
        if kind == "screw":
            axes += chance.choice(
                ("", "<screw_thread_pitch>0.3</screw_thread_pitch>", "<thread_pitch>-2</thread_pitch>")
            )
        pose = self.pose([each for each in frames if each != child])
        return f"<joint name='{name}' type='{kind}'>{pose}<parent>{parent}</parent><child>{child}</child>{axes}</joint>"

    def axis(self, tag: str, frames: list[str]) -> str:
        """An <axis> or <axis2> of unit length; the two are never parallel."""
        numbers = [self.chance.uniform(0.1, 0.3) for _ in range(3)]
        numbers[0 if tag == "axis2" else 2] += 1.0
        length = sum(value * value for value in numbers) ** 0.5
        frame = after = ""
        if self.old and self.version > "1.4" and self.chance.random() < 0.4:
            after = "<use_parent_model_frame>1</use_parent_model_frame>"
        elif not self.old and self.chance.random() < 0.4:
            frame = f" expressed_in='{self.chance.choice(frames)}'"
        return f"<{tag}><xyz{frame}>{' '.join(repr(value / length) for value in numbers)}</xyz>{after}</{tag}>"

    def include(self, name: str, frames: list[str], *, merge: bool) -> str:
        """An <include> of a file of its own with two links, one of them called NAME_link."""
        self.included += 1
        path = self.folder / f"included{self.included}.sdf"
        outside, self.version, self.old = self.version, "1.9", False
        path.write_text(
            f"<sdf version='1.9'><model name='original'>{self.pose([])}<link name='{name}_link'>{self.pose([])}</link>"
            f"<link name='{name}_other'>{self.pose(['__model__', f'{name}_link', f'{name}_frame'])}</link>"
            f"<frame name='{name}_frame' attached_to='{self.chance.choice(('__model__', f'{name}_link'))}'>"
            f"{self.pose([f'{name}_link'])}</frame>"
            f"<joint name='{name}_joint' type='revolute'><parent>{name}_link</parent><child>{name}_other</child>"
            f"{self.axis('axis', ['__model__', f'{name}_frame'])}</joint></model></sdf>"
        )
        self.version, self.old = outside, outside < "1.7"
        pose = self.pose(frames)
        placement = ""
        if pose and self.version == "1.9" and self.chance.random() < 0.4:
            placement = f"<placement_frame>{name}_frame</placement_frame>"
        merged = " merge='true'" if merge else ""
        return f"<include{merged}><uri>file://{path}</uri><name>{name}</name>{pose}{placement}</include>"
