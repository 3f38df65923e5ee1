"""Where worlds, models and meshes are found: given path, GZ_SIM_RESOURCE_PATH, then the folders that come
built in.

Called by `World.load` for the world's name and by the reader for every `<include><uri>`. Nothing is ever
downloaded: Fuel addresses are matched by their last part against the built-in models (`Ground Plane`, `Sun`).
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from gz.sim.errors import ResourceError, SdfError, nearest
from gz.sim.sdf.element import parse

BUILT_IN_WORLDS = Path(__file__).resolve().parent.parent / "worlds"
BUILT_IN_MODELS = Path(__file__).resolve().parent.parent / "models"


def resource_paths() -> list[Path]:
    """Return the folders named in GZ_SIM_RESOURCE_PATH (separated by `:`), in order."""
    return [Path(part) for part in os.environ.get("GZ_SIM_RESOURCE_PATH", "").split(os.pathsep) if part]


def find_world(name: str | Path) -> Path:
    """Return the file of a world given as a path or a name; raise `ResourceError` with the nearest one."""
    text = str(name)
    names = [text] if text.endswith((".sdf", ".world")) else [text, text + ".sdf"]
    for folder in (Path(), *resource_paths(), BUILT_IN_WORLDS):
        for each in names:
            for candidate in (folder / each, folder / "worlds" / each):
                if candidate.is_file():
                    return candidate
    known = {path.name for folder in (Path(), *resource_paths(), BUILT_IN_WORLDS) for path in _worlds_in(folder)}
    raise ResourceError(
        f"world file '{text}' was not found as a path, in GZ_SIM_RESOURCE_PATH, or among the built-in "
        "worlds; "
        f"{nearest(Path(text).name, known, listing='worlds that exist are')}"
    )


def _worlds_in(folder: Path) -> Iterator[Path]:
    for each in (folder, folder / "worlds"):
        if each.is_dir():
            yield from each.glob("*.sdf")
            yield from each.glob("*.world")


def find_model(uri: str, relative_to: Path | None) -> Path:
    """Return the SDF file that an `<include><uri>` means.

    `model://NAME`, `package://NAME`, a Fuel address, `file://PATH` and plain paths (relative to the including
    file's folder `relative_to`) are understood. Raises `ResourceError`; its text has no file:line (the caller
    knows it).
    """
    if uri.startswith("file://"):
        return _model_file(Path(unquote(uri[7:])), uri)
    for scheme in ("model://", "package://"):
        if uri.startswith(scheme):
            name = unquote(uri[len(scheme) :]).strip("/")
            for folder in resource_paths():
                for candidate in (folder / name, folder / "models" / name):
                    if candidate.exists():
                        return _model_file(candidate, uri)
            return _built_in(name, uri)
    if "://" in uri:
        return _built_in(unquote(uri.rstrip("/").rsplit("/", 1)[-1]), uri)
    for folder in ([relative_to] if relative_to else []) + resource_paths():
        if (folder / uri).exists():
            return _model_file(folder / uri, uri)
    return _built_in(uri, uri)


def _built_in(name: str, uri: str) -> Path:
    folder = BUILT_IN_MODELS / name.lower().replace(" ", "_")
    if name and folder.is_dir():
        return _model_file(folder, uri)
    known = {path.name for path in BUILT_IN_MODELS.iterdir() if path.is_dir()}
    for each in resource_paths():
        known |= {path.parent.name for path in each.glob("*/model.config")}
    raise ResourceError(
        f"model '{uri}' was not found in GZ_SIM_RESOURCE_PATH or among the built-in models; "
        f"{nearest(name, known, listing='models that exist are')}"
    )


def _model_file(path: Path, uri: str) -> Path:
    """Return `path` itself when it is a file, else the file of highest SDF version named by its
    model.config.
    """
    if path.is_file():
        return path
    config = path / "model.config"
    if not config.is_file():
        if (path / "model.sdf").is_file():
            return path / "model.sdf"
        raise ResourceError(f"'{uri}' leads to {path}, which has neither model.config nor model.sdf")
    best: tuple[tuple[int, ...], str] | None = None
    for entry in parse(config.read_text(encoding="utf-8"), str(config)).all("sdf"):
        digits = entry.attributes.get("version", "0").split(".")
        version = tuple(int(digit) if digit.isdigit() else 0 for digit in digits)
        if best is None or version > best[0]:
            best = (version, entry.text)
    if best is None or not (path / best[1]).is_file():
        raise ResourceError(f"{config}: it names no <sdf> file that exists, so '{uri}' cannot be included")
    return path / best[1]


def find_file(uri: str, relative_to: Path | None) -> Path:
    """Return the mesh or image that a `<uri>` means; raise `ResourceError` when there is no such file.

    `model://NAME/meshes/x.stl`, `package://NAME/...`, `file://PATH` and paths (absolute, or relative to the folder
    `relative_to` of the file that names it) are understood; folders are those of GZ_SIM_RESOURCE_PATH.
    """
    scheme, separator, rest = uri.partition("://")
    text = unquote(rest) if separator else uri
    if separator and scheme not in ("file", "model", "package"):
        raise ResourceError(f"'{uri}' would have to be downloaded, which is not done here; save it beside the world")
    if scheme in ("model", "package") and separator:
        text = text.lstrip("/")
        folders = [*resource_paths(), *(folder / "models" for folder in resource_paths()), BUILT_IN_MODELS]
    else:
        folders = [*([relative_to] if relative_to else [Path()]), *resource_paths()]
    for folder in folders:
        if (folder / text).is_file():
            return folder / text
    beside = [(folder / text).parent for folder in folders]
    known = {path.name for folder in beside if folder.is_dir() for path in folder.iterdir() if path.is_file()}
    hint = nearest(Path(text).name, known, listing="files there are") if known else "set GZ_SIM_RESOURCE_PATH"
    raise ResourceError(f"'{uri}' was not found; {hint}")


def read_text(path: Path) -> str:
    """Return the text of an SDF file, whatever its encoding; raise `SdfError` when it cannot be read."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise SdfError(f"{path}: the file cannot be read ({error.strerror or error})") from None
    for encoding in ("utf-8-sig", "utf-16") if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig",):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return data.decode("latin-1")
