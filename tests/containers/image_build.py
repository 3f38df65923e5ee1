"""Runs the steps of a Dockerfile without Docker: each stage is a layer on top of a minimal Debian.

It understands what our Dockerfile uses, and refuses anything else. The base image is replaced by the Debian, which has
the same Python in another place.

Source: Docker, "Dockerfile reference", https://docs.docker.com/reference/dockerfile/
"""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from gz_course.tests.containers.minimal_root import Layer

PATH = "/usr/local/bin:/usr/local/sbin:/usr/sbin:/usr/bin:/sbin:/bin"


@dataclass
class Stage:
    """A stage that is built: its layer, and what its instructions have set."""

    layer: Layer
    environment: dict[str, str] = field(default_factory=lambda: {"PATH": PATH, "HOME": "/root"})
    user: int = 0
    folder: str = "/"
    command: list[str] = field(default_factory=list)

    def run(
        self, command: str, *, network: bool = True, given: Path | None = None, given_by: Layer | None = None
    ) -> str:
        """Run a shell command as the stage's user; return its output. Raises AssertionError if it fails."""
        words = ["sh", "-c", f'cd "$0" && {command}', self.folder]
        done = self.layer.run(
            words, user=self.user, environment=self.environment, network=network, given=given, given_by=given_by
        )
        assert done.returncode == 0, f"{command}\n{done.stdout[-3000:]}"
        return done.stdout


def instructions(text: str) -> list[tuple[str, str]]:
    """Return the instructions of a Dockerfile: name and rest of the line, continued lines joined."""
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    joined = re.sub(r"\\\n\s*", " ", "\n".join(lines))
    pairs = (line.split(None, 1) for line in joined.splitlines() if line.strip())
    return [(name.upper(), rest) for name, rest in pairs]


def context(checkout: Path, to: Path) -> Path:
    """Copy what `.dockerignore` lets through; it names what is allowed, after a `*`."""
    lines = (checkout / ".dockerignore").read_text().splitlines()
    allowed = [line[1:] for line in lines if line.startswith("!")]
    assert "*" in lines and not any("*" in each for each in allowed)
    known = subprocess.run(["git", "ls-files", "-z"], cwd=checkout, check=True, capture_output=True, text=True).stdout
    for name in filter(None, known.split("\0")):
        if any(PurePosixPath(name).is_relative_to(each) for each in allowed) and (checkout / name).is_file():
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(checkout / name, to / name)
    return to


def build(text: str, files: Path, base: Path, folder: Path) -> dict[str, Stage]:
    """Build all stages of a Dockerfile; `files` is the context, `base` the root in place of the base image."""
    stages: dict[str, Stage] = {}
    stage: Stage | None = None
    for name, rest in instructions(text):
        if name == "FROM":
            image, _, alias = rest.partition(" AS ")
            below = stages[image] if image in stages else Stage(Layer(folder / f"base of {alias}", [base]))
            layer = Layer(folder / alias, below.layer.all)
            stage = stages[alias] = replace(below, layer=layer, environment=dict(below.environment))
            continue
        assert stage is not None
        if name == "WORKDIR":
            stage.folder = str(PurePosixPath(stage.folder, rest))
            replace(stage, folder="/").run(f"mkdir -p {shlex.quote(stage.folder)}")
        elif name == "COPY":
            _copy(stage, rest.split(), files, stages)
        elif name == "RUN":
            stage.run(rest)
        elif name == "ENV":
            for each in shlex.split(rest):
                key, _, value = each.partition("=")
                stage.environment[key] = value.replace("$PATH", stage.environment["PATH"])
        elif name == "USER":
            stage.user = int(rest.partition(":")[0])
            stage.environment["HOME"] = "/home/student"
        elif name == "CMD":
            stage.command = re.findall(r'"([^"]*)"', rest)
        else:
            assert name == "EXPOSE", f"an instruction that is not understood: {name}"
    return stages


def _copy(stage: Stage, words: list[str], files: Path, stages: dict[str, Stage]) -> None:
    source, target = words[-2:]
    as_root = replace(stage, user=0)
    if words[0].startswith("--from="):
        other = stages[words[0].removeprefix("--from=")].layer
        as_root.run(f"mkdir -p {target} && cp -a /given/. {target}", given=Path(source), given_by=other)
    elif (files / source).is_file():
        as_root.run(f"cp /given/{source} {target}", given=files)
    else:
        as_root.run(f"mkdir -p {target} && cp -r /given/. {target}", given=files / source)
