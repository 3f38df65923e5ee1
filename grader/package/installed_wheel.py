"""The installed course as a wheel again, with the versions of what it needs, for a machine that has no checkout.

Left out are what lies outside the folder of packages (an installer makes the commands anew, and settings of JupyterLab
grade nothing), compiled modules, and what the installer has noted about itself.

Source: Python Packaging User Guide, "Binary distribution format" and "Recording installed projects" (RECORD)
"""

from __future__ import annotations

import base64
import hashlib
import io
import re
import zipfile
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.package.question import WHEN

NAME = "gz-ros2-course"
_NOTES = ("INSTALLER", "REQUESTED", "RECORD", "direct_url.json")
_REQUIREMENT = re.compile(r"\s*([A-Za-z0-9][A-Za-z0-9._-]*)")


def installed_wheel() -> tuple[str, bytes]:
    """Return the name of the wheel and the wheel. Raises UsageError unless a wheel of the course is installed."""
    course = _course()
    entries: dict[str, tuple[bytes, int]] = {}
    folder = ""
    for file in course.files or ():
        if file.parts[0] == ".." or file.suffix == ".pyc":
            continue
        if file.parent.name.endswith(".dist-info"):
            folder = folder or file.parent.name
            if file.name in _NOTES:
                continue
        path = Path(str(file.locate()))
        entries[file.as_posix()] = path.read_bytes(), path.stat().st_mode
    if not folder or not any(name.startswith("gz_course/grader/") for name in entries):
        raise UsageError(f"{NAME} is neither a checkout nor installed from a wheel; package from one of the two")
    record = [f"{name},sha256={_digest(data)},{len(data)}" for name, (data, _) in sorted(entries.items())]
    record.append(f"{folder}/RECORD,,")
    entries[f"{folder}/RECORD"] = "\n".join([*record, ""]).encode(), 0o100644
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, (data, mode) in sorted(entries.items(), key=lambda each: (each[0].startswith(folder), each[0])):
            info = zipfile.ZipInfo(name, WHEN)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = mode << 16
            archive.writestr(info, data)
    return f"{folder.removesuffix('.dist-info')}-py3-none-any.whl", content.getvalue()


def installed_versions() -> bytes:
    """Return pip's constraints: all that the course needs, directly or not, in the versions that are installed."""
    found: dict[str, str] = {}
    ahead = [_course()]
    while ahead:
        for requirement in ahead.pop().requires or ():
            named = _REQUIREMENT.match(requirement)
            if named is None or (key := _normal(named[1])) in found:
                continue
            try:
                needed = distribution(named[1])
            except PackageNotFoundError:  # of an extra, or for another platform
                continue
            found[key] = needed.version
            ahead.append(needed)
    return "".join(f"{name}=={version}\n" for name, version in sorted(found.items()) if name != NAME).encode()


def _course() -> Distribution:
    try:
        return distribution(NAME)
    except PackageNotFoundError:
        raise UsageError(f"{NAME} is neither a checkout nor installed; package from one of the two") from None


def _digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()
