"""The page on evidence names every topic and every fact that a check, a diagnosis or a manifest reads."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/evidence.md").read_text()
NAMED = set(re.findall(r"`([^`]+)`", PAGE))
SCORES = [*(ROOT / "grader/score").rglob("*.py"), *ROOT.glob("exercises/*/grading/*.py")]
MANIFESTS = sorted(ROOT.glob("exercises/*/grading/exercise.toml"))
EXAMPLES = {"estimate"}  # of the manual of a kind of check


def literal_topics(text):
    """Topics in `topics/NAME/FIELD`, without the field; a name that is put in by a variable is none."""
    return {each.strip("/") for each in re.findall(r"\btopics/([a-z0-9_]+)", text)}


@pytest.mark.parametrize("path", SCORES, ids=lambda path: str(path.relative_to(ROOT)))
def test_facts_and_topics_of_checks_are_on_the_page(path):
    text = path.read_text()
    facts = set(re.findall(r"""facts(?:\(\w*\))?(?:\.get\(|\[)["'](\w+)["']""", text))
    assert facts <= NAMED, facts - NAMED
    known = {word for name in NAMED if name.startswith("/") for word in name.split("/")} | NAMED | EXAMPLES
    assert literal_topics(text) <= known, literal_topics(text) - known


@pytest.mark.parametrize("path", MANIFESTS, ids=lambda path: path.parts[-3])
def test_each_exercise_has_a_row_with_its_topics(path):
    manifest, name = tomllib.loads(path.read_text()), path.parts[-3]
    (row,) = [line for line in PAGE.splitlines() if line.startswith(f"| `{name}`")]
    topics = set(manifest["run"].get("observe", {})) | {each.get("ros_topic") for each in manifest.get("script", [])}
    topics |= {each.get("ros_topic") for each in manifest["check"]}
    bridge = path.parents[1] / "bridge.yaml"
    if manifest.get("kind") not in ("table", "launch", "bridge") and bridge.exists():
        entries = yaml.safe_load(bridge.read_text())
        topics |= {each["ros_topic_name"] for each in entries if each["direction"] == "ROS_TO_GZ"}
    missing = [each for each in topics - {None} if f"`{each}`" not in row and f"`{each.rpartition('/')[2]}`" not in row]
    assert not missing
