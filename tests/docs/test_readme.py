"""The README is true: its links, its picture, its syllabus, and the targets of make that it names."""

import re
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
LARGEST = 150_000  # [bytes] of a picture


@pytest.fixture(scope="module")
def readme():
    return (ROOT / "README.md").read_text()


def test_what_it_links_to_is_there(readme):
    links = [target.partition("#")[0] for target in re.findall(r"\]\(([^)\s]+)\)", readme)]
    assert links and [each for each in links if ":" not in each and each and not (ROOT / each).exists()] == []


def test_it_opens_with_a_small_picture_that_is_told_in_words(readme):
    words, path = re.match(r"# [^\n]+\n\n!\[([^\]]+)\]\(([^)]+)\)", readme).groups()
    assert len(words.split()) > 8
    assert (ROOT / path).stat().st_size <= LARGEST


def test_every_chapter_stands_in_its_syllabus(readme):
    rows = re.findall(r"\| \[([^\]]+)\]\(([^)]+)\) \|.*\| (\d+) min \|", readme)
    notebooks = sorted((ROOT / "chapters").glob("*/*.ipynb"))
    assert [ROOT / path for _, path, _ in rows] == notebooks
    for (title, _, minutes), path in zip(rows, notebooks, strict=True):
        head = nbformat.read(path, as_version=4).cells[0].source
        assert head.startswith(f"# {title}\n") and f"about {minutes} minutes" in head


def test_the_targets_of_make_exist(readme):
    there = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert set(re.findall(r"`make ([a-z-]+)", readme)) <= there
