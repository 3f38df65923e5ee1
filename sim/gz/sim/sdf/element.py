"""XML of an SDF file as a tree of elements with their file and line.

Gazebo's parser (tinyxml2) accepts texts that strict XML parsers reject ("--" inside comments, undeclared prefixes such
as `gz:policies`, an `<?xml?>` line after white space, words before the first tag). Therefore these words, comments and
declarations are blanked first, keeping the line numbers, and expat runs without namespaces.

Source: https://github.com/leethomason/tinyxml2, `XMLNode::ParseDeep` (where a declaration may stand)
"""

from __future__ import annotations

import math
import re
import xml.parsers.expat
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from gz_course.sim.gz.sim.errors import SdfError, one_line
from gz_course.sim.gz.sim.pose import Pose

DEEPEST = 200
"""Maximum depth of nested elements; that of real worlds is below 30."""
MOST_ELEMENTS = 500_000
"""Maximum number of elements in a file; a world of 3000 models has 100,000."""

_OPENING = re.compile(r"<!--|<!\[CDATA\[|<\?xml")
_MARKUP = re.compile(r"<[\w:!?]")
_LONE_AMPERSAND = re.compile(r"&(?!(?:lt|gt|amp|quot|apos|#[0-9]{1,10}|#x[0-9a-fA-F]{1,8});)")
_CLOSING_TAG = re.compile(r"</\s*([^\s<>/]+)")
_CLOSING = {"<!-": "-->", "<?x": "?>", "<![": "]]>"}
_UNIT = re.compile(r"\d\s*(m|mm|cm|km|kg|g|deg|degrees|rad|s|ms|°|N|Nm)\b|°")
_TRUE = {"true", "1"}
_FALSE = {"false", "0"}


@dataclass(eq=False)
class Element:
    """One XML element: `tag`, `attributes`, `text` (stripped), `children`, and its place (`file`, `line`)."""

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    text: str = ""
    children: list[Element] = field(default_factory=list)
    file: str = "<string>"
    line: int = 0

    @property
    def where(self) -> str:
        """Return `file:line`, the beginning of every message about this element."""
        return f"{self.file}:{self.line}"

    @property
    def name(self) -> str:
        """Return the attribute `name`, or an empty text."""
        return self.attributes.get("name", "")

    @property
    def folder(self) -> Path | None:
        """Return the folder of the file, to which URIs are relative, or None for a text without a file."""
        return None if self.file.startswith("<") else Path(self.file).parent

    def error(self, sentence: str) -> SdfError:
        """Return an error with `sentence` about this element, without raising it."""
        error = SdfError(f"{self.where}: {one_line(sentence)}")
        error.element = self
        return error

    def find(self, tag: str) -> Element | None:
        """Return the first child called `tag`; `a/b` means child `b` of child `a`."""
        node = self
        for part in tag.split("/"):
            below = next((child for child in node.children if child.tag == part), None)
            if below is None:
                return None
            node = below
        return node

    def all(self, *tags: str) -> Iterator[Element]:
        """Yield the direct children whose tag is one of `tags`, in file order."""
        return (child for child in self.children if child.tag in tags)

    def below(self) -> Iterator[Element]:
        """Yield this element and all below it, in file order."""
        yield self
        for child in self.children:
            yield from child.below()

    def text_of(self, tag: str, default: str = "") -> str:
        """Return the text of child `tag`, or `default` when it is missing or empty."""
        child = self.find(tag)
        return child.text if child is not None and child.text else default

    def number(self, tag: str, default: float) -> float:
        """Return child `tag` as a float, which may be infinite. Raises SdfError if it is no number or NaN."""
        child = self.find(tag)
        if child is None or not child.text:
            return default
        return child.floats(1)[0]

    def integer(self, tag: str, default: int) -> int:
        """Return child `tag` as an int; `360.0` is accepted, as in Gazebo."""
        value = self.number(tag, float(default))
        if not math.isfinite(value):
            raise (self.find(tag) or self).error(f"<{tag}> must be a whole number, got '{self.text_of(tag)}'")
        return int(value)

    def mask(self, tag: str, default: int) -> int:
        """Return child `tag` as the bits of a 32-bit mask, written in decimal or, as `0x01`, in hexadecimal."""
        text = self.text_of(tag)
        try:
            return int(text, 0) & 0xFFFFFFFF if text else default
        except ValueError:
            raise (self.find(tag) or self).error(
                f"<{tag}> must be a whole number such as 1 or 0x01, got '{text}'"
            ) from None

    def flag(self, tag: str, default: bool) -> bool:
        """Return child `tag` as a boolean (true/false/1/0)."""
        child = self.find(tag)
        if child is None or not child.text:
            return default
        word = child.text.lower()
        if word in _TRUE or word in _FALSE:
            return word in _TRUE
        raise child.error(f"<{tag}> must be true or false, got '{child.text}'")

    def vector(self, tag: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """Return child `tag` as exactly as many floats as `default` has."""
        child = self.find(tag)
        if child is None or not child.text:
            return default
        return tuple(child.floats(len(default)))

    def floats(self, count: int) -> list[float]:
        """Return the text of this element as `count` floats. Raises SdfError with the text for anything else."""
        words = self.text.split()
        wanted = "a number" if count == 1 else f"{count} numbers"
        if len(words) != count:
            raise self.error(f"<{self.tag}> needs {wanted}, got '{self.text}'{_advice(self, count)}")
        try:
            values = [float(word) for word in words]
        except ValueError:
            text = f"<{self.tag}> needs {wanted}, got '{self.text}'{_advice(self, count)}"
            raise self.error(text) from None
        if any(math.isnan(value) for value in values):
            raise self.error(f"<{self.tag}> must not be NaN, got '{self.text}'")
        return values

    def pose(self) -> Pose:
        """Return this `<pose>` as a `Pose` (x y z [m], roll pitch yaw [rad]), with `degrees` and `rotation_format`.

        Source: SDFormat, Specifying pose, http://sdformat.org/tutorials?tut=specify_pose
        """
        if not self.text:
            return Pose()
        if self.attributes.get("rotation_format", "euler_rpy") == "quat_xyzw":
            x, y, z, qx, qy, qz, qw = self.floats(7)
            quaternion = np.array((qw, qx, qy, qz))
            norm = float(np.linalg.norm(quaternion))
            if not math.isfinite(norm) or norm < 1e-12:
                raise self.error("the quaternion of <pose> has no length")
            pose = Pose((x, y, z), quaternion / norm)
        else:
            x, y, z, roll, pitch, yaw = self.floats(6)
            scale = math.pi / 180.0 if self.attributes.get("degrees", "false").lower() in _TRUE else 1.0
            if not all(map(math.isfinite, (roll, pitch, yaw))):
                raise self.error(f"<pose> must be finite, got '{self.text}'")
            pose = Pose.from_rpy((x, y, z), (roll * scale, pitch * scale, yaw * scale))
        if not np.all(np.isfinite(pose.position)):
            raise self.error(f"<pose> must be finite, got '{self.text}'")
        return pose


def without(element: Element, gone: Element) -> Element:
    """Return a copy of an element that lacks one of those below it."""
    kept = [without(child, gone) for child in element.children if child is not gone]
    return replace(element, children=kept)


def _advice(element: Element, count: int) -> str:
    """Return what to change in a text that is not `count` numbers, or an empty text."""
    text = element.text
    if "${" in text or "$(" in text:
        return "; this is xacro, which is expanded in files whose name ends with .xacro"
    if "," in text:
        return "; write blanks between numbers and a point before decimals, no commas"
    if _UNIT.search(text):
        return "; write the number alone: lengths are in m, masses in kg, angles in rad, times in s"
    if len(text.split()) == 1 and element.tag in ("scale", "gravity"):
        return f"; write '0 0 {text}'" if element.tag == "gravity" else f"; write '{text} {text} {text}'"
    if count == 6:
        return "; they are x y z (m) and roll pitch yaw (rad)"
    return ""


def parse(text: str, file: str = "<string>") -> Element:
    """Parse XML text into its root `Element`; `file` is only used in messages. Raises SdfError with the line."""
    parser = xml.parsers.expat.ParserCreate("utf-8")
    parser.buffer_text = True
    stack: list[Element] = []
    roots: list[Element] = []
    texts: list[list[str]] = []
    count = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count
        element = Element(tag, attributes, file=file, line=parser.CurrentLineNumber)
        if len(stack) >= DEEPEST:
            raise element.error(f"elements stand more than {DEEPEST} deep inside each other; this is no SDF")
        count += 1
        if count > MOST_ELEMENTS:
            raise element.error(
                f"the file has more than {MOST_ELEMENTS} elements; split the world into included models"
            )
        (stack[-1].children if stack else roots).append(element)
        stack.append(element)
        texts.append([])

    def end(_tag: str) -> None:
        stack.pop().text = "".join(texts.pop()).strip()

    def characters(data: str) -> None:
        if texts:
            texts[-1].append(data)

    def entity(name: str, *_rest: object) -> None:
        # Nested entities can expand a small text beyond any memory limit.
        raise SdfError(f"{file}:{parser.CurrentLineNumber}: the entity '{name}' is declared; write its text instead")

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = characters
    parser.EntityDeclHandler = entity
    text = text.removeprefix("\ufeff")
    first = text.split(maxsplit=1)[0] if text.strip() else ""
    if not first.startswith("<") and not _MARKUP.search(text):
        what = f"it begins with '{first[:20]}'" if first else "it is empty"
        raise SdfError(f"{file}:1: this is no XML: {one_line(what)}, but an SDF or URDF begins with '<'")
    blanked = _blanked(text, file)
    # expat expects the root element first; the lines of the removed white space still count.
    body = blanked.lstrip()
    skipped = blanked[: len(blanked) - len(body)].count("\n")
    try:
        parser.Parse(("\n" * skipped + body).encode("utf-8", "replace"), True)
    except xml.parsers.expat.ExpatError as error:
        what = xml.parsers.expat.errors.messages.get(error.code, "malformed")
        if stack:
            what += f", while <{stack[-1].tag}> (opened on line {stack[-1].line}) was open"
        closing = _CLOSING_TAG.search(blanked.split("\n")[error.lineno - 1], max(0, error.offset - 2))
        if what.startswith("mismatched tag") and closing is not None:
            what += f" and </{closing[1]}> was met; write </{stack[-1].tag}> before it"
        else:
            what += "; check that every tag is closed and every attribute quoted"
        raise SdfError(f"{file}:{error.lineno}: this is not well-formed XML: {what}") from None
    return roots[0]


def _blanked(text: str, file: str) -> str:
    """Replace comments, XML declarations and words before the first tag by their line breaks, and an & that begins no
    reference by `&amp;`.

    libsdformat ignores such words and takes such an & for itself. Raises SdfError for an unterminated comment, and
    for a declaration behind anything else.
    """
    begin = _MARKUP.search(text)
    done = begin.start() if begin is not None else 0
    kept = ["\n" * text.count("\n", 0, done)]
    at_top = not text[:done].strip()
    for opening in _OPENING.finditer(text):
        if opening.start() < done:
            continue
        closing = _CLOSING[opening.group()[:3]]
        at_top = at_top and not text[done : opening.start()].strip()
        if closing == "?>" and not at_top:
            line = text.count("\n", 0, opening.start()) + 1
            raise SdfError(
                f"{file}:{line}: the <?xml ...?> line must be the first in the file, before comments and text too, "
                "or Gazebo refuses the file; move it to the top"
            )
        at_top = at_top and closing == "?>"
        end = text.find(closing, opening.end())
        if end < 0 and closing == "-->":
            line = text.count("\n", 0, opening.start()) + 1
            raise SdfError(f"{file}:{line}: the comment that begins here with <!-- has no end; close it with -->")
        if end < 0:
            break  # the rest is unchanged: the parser reports the error with the right line
        end += len(closing)
        kept.append(_LONE_AMPERSAND.sub("&amp;", text[done : opening.start()]))
        if opening.group().startswith("<!["):
            kept.append(text[opening.start() : end])
            done = end
            continue
        kept.append("\n" * text.count("\n", opening.start(), end))
        done = end
    kept.append(_LONE_AMPERSAND.sub("&amp;", text[done:]))
    return "".join(kept)
