"""Finds and reads the files of worlds, models, meshes and images.

Called by `World.load` for the name of the world and by the reader for every `<uri>`. Files are searched for in the
folders of GZ_SIM_RESOURCE_PATH, then of SDF_PATH and IGN_GAZEBO_RESOURCE_PATH, then in the built-in folders; for
`package://` also in `share/` of every prefix in AMENT_PREFIX_PATH. Nothing is downloaded: an address of Gazebo Fuel
refers to the model of that name in one of these folders (`Ground Plane` and `Sun` are built in).

The reader opens files only through the `Resources` object it was given: `FILES` opens files of this machine,
`gz.sim.sdf.assets` holds the content in memory. A xacro file is expanded when it is read. Its expressions are Python
code, so read only xacro files that you trust.

Source: Finding resources, https://gazebosim.org/api/sim/8/resources.html
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Protocol
from urllib.parse import unquote

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import ResourceError, SdfError
from gz_course.sim.gz.sim.sdf.element import parse
from gz_course.sim.gz.sim.sdf.special_files import special_kind

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from gz_course.sim.gz.sim.sdf.meshes import Mesh

BUILT_IN_WORLDS = Path(__file__).resolve().parent.parent / "worlds"
BUILT_IN_MODELS = Path(__file__).resolve().parent.parent / "models"
NEWEST_SDF = (1, 12)

_VARIABLES = ("GZ_SIM_RESOURCE_PATH", "SDF_PATH", "IGN_GAZEBO_RESOURCE_PATH")
_WORLD_ENDINGS = (".sdf", ".world", ".xacro", ".urdf", ".xml")
_MOST_READ = 64 * 1024  # of a file that may be a world
_MOST_BYTES = 64 * 1024 * 1024


def resource_paths() -> list[Path]:
    """Return the folders in GZ_SIM_RESOURCE_PATH and in the variables with older names (separated by `:`), in order."""
    words = [word for name in _VARIABLES for word in os.environ.get(name, "").split(os.pathsep) if word]
    return [Path(word) for word in dict.fromkeys(words)]


def package_shares() -> list[Path]:
    """Return the `share` folders of the ROS prefixes in AMENT_PREFIX_PATH, in order."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return [Path(prefix) / "share" for prefix in dict.fromkeys(prefixes) if prefix]


def find_world(name: str | Path) -> Path:
    """Return the world file for a path or a name. Raises `ResourceError` with the nearest name."""
    text = str(name)
    if text.startswith(("http://", "https://")):
        raise ResourceError(f"world '{text}' would have to be downloaded, which is not done here; save it as a file")
    names = [text] if text.endswith(_WORLD_ENDINGS) else [text, text + ".sdf"]
    folders = (Path(), *resource_paths(), BUILT_IN_WORLDS)
    for folder in folders:
        for each in names:
            for candidate in (folder / each, folder / "worlds" / each):
                if _is_file(candidate):
                    return candidate
    if Path(text).is_dir():
        inside = sorted(path.name for path in Path(text).glob("*.sdf"))[:3]
        hint = f", for example {Path(text) / inside[0]}" if inside else ""
        raise ResourceError(f"'{text}' is a folder, not a world file; name a file in it{hint}")
    known, name = {path.name for folder in folders for path in _worlds_in(folder)}, Path(text).name
    near = did_you_mean(name, known, listing="worlds that exist are")
    raise ResourceError(
        f"world file '{text}' was not found as a path, in GZ_SIM_RESOURCE_PATH, or among the built-in worlds"
        f"{f'; {name}, without a folder, is found' if name in known else near}"
    )


def known_worlds() -> dict[str, str]:
    """Return the worlds that are found by a name: name -> the first sentence of the comment at the top of its file."""
    found: dict[str, str] = {}
    for folder in (Path(), *resource_paths(), BUILT_IN_WORLDS):
        for path in sorted(_worlds_in(folder)):
            with contextlib.suppress(OSError):
                text = path.read_bytes()[:_MOST_READ].decode("utf-8", "replace")
                if "<world" in text:
                    comment = " ".join(text.partition("<!--")[2].partition("-->")[0].split())
                    found.setdefault(path.name, comment.split(": gz ")[0].split(". ")[0].removesuffix("."))
    return found


def _worlds_in(folder: Path) -> Iterator[Path]:
    for each in (folder, folder / "worlds"):
        if each.is_dir():
            yield from each.glob("*.sdf")
            yield from each.glob("*.world")


def find_model(uri: str, relative_to: Path | None) -> Path:
    """Return the SDF, URDF or xacro file that the `<uri>` of an `<include>` refers to.

    A `<uri>` is `model://NAME`, `package://NAME/FILE`, `file://PATH`, an address of Fuel, or a path, absolute or
    relative to the folder `relative_to` of the including file. For a folder the file named in its model.config is
    returned. Raises `ResourceError` without file and line, which the caller adds.
    """
    for candidate in _candidates(uri, relative_to):
        if _exists(candidate):
            return _model_file(candidate, uri)
    if _is_fuel(uri):
        name = _fuel_path(uri).split("/")[0]
        raise ResourceError(
            f"'{uri}' is on Gazebo Fuel, and nothing is downloaded here; save the model as folder '{name}' in a folder "
            "of GZ_SIM_RESOURCE_PATH"
        )
    name = uri.rpartition("://")[2].strip("/")
    known = {path.name for path in BUILT_IN_MODELS.iterdir() if path.is_dir()}
    for folder in resource_paths():
        for pattern in ("*/model.config", "models/*/model.config"):
            known |= {path.parent.name for path in folder.glob(pattern)}
    raise ResourceError(
        f"model '{uri}' was not found in GZ_SIM_RESOURCE_PATH or among the built-in models"
        f"{_path_hint(name, relative_to) or did_you_mean(name, known, listing='models that exist are')}"
    )


def find_resource(uri: str) -> Path:
    """Return the file or folder that a `<uri>` refers to: for `model://NAME` the folder of the model.

    Raises `ResourceError` with the nearest name if there is none.
    """
    for candidate in _candidates(uri, None):
        if _exists(candidate):
            return candidate
    return find_model(uri, None)


def find_file(uri: str, relative_to: Path | None) -> Path:
    """Return the mesh or image that a `<uri>` refers to, in the notations of `find_model`.

    Raises `ResourceError` if there is no such file.
    """
    candidates = list(_candidates(uri, relative_to))
    for candidate in candidates:
        if _is_file(candidate):
            return candidate
    if _is_fuel(uri):
        raise ResourceError(f"'{uri}' would have to be downloaded, which is not done here; save it beside the world")
    for candidate in candidates:
        if kind := special_kind(candidate):
            raise ResourceError(f"'{uri}' is no file but {kind}: {candidate}")
    rest = uri.rpartition("://")[2].strip("/")
    hint = _path_hint(rest, relative_to) if uri.startswith(("model://", "package://")) else ""
    siblings = {path.name for candidate in candidates for path in _listed(candidate.parent)}
    hint = hint or did_you_mean(Path(rest).name, siblings)
    hint = hint or _as_model(uri, relative_to)
    if not hint:
        hint = "; it was looked for in " + ", ".join(dict.fromkeys(str(each.parent) for each in candidates))
    raise ResourceError(f"'{uri}' was not found{hint}")


def _as_model(uri: str, relative_to: Path | None) -> str:
    """Return the end of a sentence on `file://models/NAME/FILE`, which is found as `model://NAME/FILE`."""
    scheme, _, path = uri.partition("://")
    meant = "model://" + path.lstrip("/").removeprefix("models/")
    found = scheme == "file" and any(_is_file(each) for each in _candidates(meant, relative_to))
    return f"; a path after file:// is absolute or begins beside the world; did you mean '{meant}'?" if found else ""


def _candidates(uri: str, relative_to: Path | None) -> Iterator[Path]:
    """Yield the paths that a `<uri>` can refer to, in order of precedence."""
    scheme, separator, rest = uri.partition("://")
    if not separator:
        scheme, rest = "", uri
    path = unquote(rest) if separator else uri
    beside = [relative_to if relative_to is not None else Path()]
    if _is_fuel(uri):
        path = _fuel_path(uri)
    elif scheme in ("", "file"):
        for folder in (*beside, *resource_paths()):
            yield folder / path
        if scheme or "/" in path:
            return  # a name without folder may be that of a built-in model
    path = path.strip("/")
    if not path:
        return
    if scheme == "package":
        yield from (share / path for share in package_shares())
    for folder in resource_paths():
        yield folder / path
        yield folder / "models" / path
    if scheme == "model":
        yield from (share / path for share in package_shares())
    name, slash, inside = path.partition("/")
    yield BUILT_IN_MODELS / (name.lower().replace(" ", "_") + slash + inside)


def _is_fuel(uri: str) -> bool:
    return uri.startswith(("http://", "https://", "fuel://"))


def _fuel_path(uri: str) -> str:
    """Return `NAME` or `NAME/meshes/x.dae` of `https://fuel.../1.0/OWNER/models/NAME[/VERSION[/files/meshes/x.dae]]`."""
    parts = unquote(uri).rstrip("/").split("/")
    if "models" not in parts[:-1]:
        return parts[-1]
    name, *rest = parts[parts.index("models") + 1 :]
    inside = rest[rest.index("files") + 1 :] if "files" in rest else []
    return "/".join((name, *inside))


def _path_hint(path: str, relative_to: Path | None) -> str:
    """Return a hint which folder to add to GZ_SIM_RESOURCE_PATH, if the file is in the model that includes it."""
    name = path.split("/")[0]
    for folder in (relative_to, *relative_to.resolve().parents) if relative_to is not None else ():
        for each in (folder, folder / name):
            if name and each.name == name and _exists(each) and each.is_dir():
                return f"; there is {each}: add {each.parent} to GZ_SIM_RESOURCE_PATH"
    return ""


def _model_file(path: Path, uri: str) -> Path:
    """Return `path` if it is a file, else the file of the highest SDF version named in its model.config."""
    if _is_file(path):
        return path
    config = next((path / name for name in ("model.config", "manifest.xml") if _is_file(path / name)), None)
    if config is None:
        if _is_file(path / "model.sdf"):
            return path / "model.sdf"
        raise ResourceError(f"'{uri}' leads to {path}, which has neither model.config nor model.sdf")
    found: list[tuple[bool, tuple[int, ...], str]] = []
    for entry in parse(read_text(config), str(config)).all("sdf"):
        digits = entry.attributes.get("version", "0").split(".")
        version = tuple(int(digit) if digit.isdigit() and len(digit) < 9 else 0 for digit in digits)
        if _is_file(path / entry.text):
            found.append((version <= NEWEST_SDF, version, entry.text))
    if not found:
        raise ResourceError(f"{config}: it names no <sdf> file that exists, so '{uri}' cannot be included")
    # Of equal versions the first file is used; one of an unsupported newer version only if there is no other.
    known = [each for each in found if each[0]]
    best = max(known, key=lambda each: each[1]) if known else min(found, key=lambda each: each[1])
    return path / best[2]


def read_text(path: Path) -> str:
    """Return the text of an SDF or URDF file in any encoding. Raises `SdfError` if it cannot be read.

    A file with `.xacro` among its suffixes (`robot.urdf.xacro`, `robot.xacro.urdf`) is expanded first.
    """
    if ".xacro" in path.suffixes:
        from gz_course.sim.gz.sim.sdf.urdf.xacro_file import expand  # slow to import, and rarely needed

        return expand(path)
    try:
        if path.stat().st_size > _MOST_BYTES:
            raise SdfError(f"{path}: the file is larger than {_MOST_BYTES // 2**20} MiB; split it into included models")
        data = path.read_bytes()
    except OSError as error:
        raise SdfError(f"{path}: the file cannot be read ({error.strerror or error})") from None
    for encoding in ("utf-8-sig", "utf-16") if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig",):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return data.decode("latin-1")


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # the name is too long or contains a null byte
        return False


def _is_file(path: Path) -> bool:
    return _exists(path) and path.is_file()


def _listed(folder: Path) -> list[Path]:
    try:
        return [path for path in folder.iterdir() if path.is_file()]
    except (OSError, ValueError):
        return []


class Resources(Protocol):
    """The access of a reader to the models, meshes and images that a description names.

    A path is only passed back to the object that returned it; it need not be the path of a file.
    """

    def __hash__(self) -> int:
        """Return the identity of the object, as a key of caches."""

    opens_files: bool
    """True if it reads files of this machine; only then may systems of the world write files."""

    def find_model(self, uri: str, relative_to: Path | None) -> Path:
        """Return the path for the `<uri>` of an `<include>`. Raises `ResourceError` if it does not exist."""

    def find_file(self, uri: str, relative_to: Path | None) -> Path:
        """Return the path for the `<uri>` of a mesh or image. Raises `ResourceError` if it does not exist."""

    def real(self, path: Path) -> Path:
        """Return the canonical path of a file that has several paths."""

    def stamp(self, path: Path) -> tuple[int, ...]:
        """Return numbers that change with the content. Raises OSError if there is no such file."""

    def read_text(self, path: Path) -> str:
        """Return the text of an SDF or URDF file. Raises `SdfError` if it cannot be read."""

    def read_mesh(self, path: Path, submesh: str, center: bool) -> Mesh:
        """Return a mesh like `gz.sim.sdf.meshes.read_mesh`."""

    def read_image(self, path: Path) -> NDArray[np.uint8]:
        """Return the first channel (rows, columns) of an image. Raises `ResourceError` if it cannot be read."""

    def read_texture(self, path: Path) -> NDArray[np.uint8]:
        """Return the colours (rows, columns, 3) of an image. Raises `ResourceError` if it cannot be read."""


class Files:
    """The files of this machine, found by the rules of this module."""

    opens_files = True

    def find_model(self, uri: str, relative_to: Path | None) -> Path:
        return find_model(uri, relative_to)

    def find_file(self, uri: str, relative_to: Path | None) -> Path:
        return find_file(uri, relative_to)

    def real(self, path: Path) -> Path:
        """Return the path with symbolic links resolved."""
        return path.resolve()

    def stamp(self, path: Path) -> tuple[int, ...]:
        """Return the time of the last change [ns] and the size [byte]."""
        stat = path.stat()
        return stat.st_mtime_ns, stat.st_size

    def read_text(self, path: Path) -> str:
        """Return the text; a xacro file is expanded, which executes its expressions."""
        return read_text(path)

    def read_mesh(self, path: Path, submesh: str, center: bool) -> Mesh:
        """Return a mesh in one of the formats of `gz.sim.sdf.meshes`."""
        from gz_course.sim.gz.sim.sdf.meshes import read_mesh

        return read_mesh(path, submesh, center)

    def read_image(self, path: Path) -> NDArray[np.uint8]:
        """Return the first channel of a PNG file."""
        from gz_course.sim.gz.sim.sdf.grey_image import read_image

        return read_image(path)

    def read_texture(self, path: Path) -> NDArray[np.uint8]:
        """Return the colours of a PNG or JPEG file."""
        from gz_course.sim.gz.sim.sdf.textures import read_texture

        return read_texture(path)


FILES = Files()
