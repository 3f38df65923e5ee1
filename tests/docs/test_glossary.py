"""The glossary: short entries, and a link from the first use of each term in the chapters, and from nowhere else."""

import re

import nbformat
import pytest

from gz_course.tests.docs.glossary import LINK, NOT_MEANT, Use, anchor, entries, first_use
from gz_course.tests.import_arrows import ROOT

GLOSSARY = ROOT / "chapters" / "glossary.ipynb"
NOTEBOOKS = sorted((ROOT / "chapters").glob("*/*.ipynb"))
MOST_SENTENCES, LONGEST = 3, 45  # words
TERMS = entries(GLOSSARY)
ASKED_FOR = {"IMU", "odometry", "SDF", "executor", "QoS", "topic", "node", "frame", "transform", "bridge"}


def links():
    """Each link to the glossary: the notebook, the words that it shows and the anchor."""
    for notebook in NOTEBOOKS:
        for cell in nbformat.read(notebook, as_version=4).cells:
            for found in LINK.finditer(cell.source):
                yield notebook.stem, found["words"], found["anchor"]


def test_the_terms_are_sorted_and_explained_in_few_words():
    assert TERMS.keys() >= ASKED_FOR and list(TERMS) == sorted(TERMS, key=str.lower)
    for term, text in TERMS.items():
        assert 1 <= len(re.findall(r"[.:](?: |\n|$)", text)) <= MOST_SENTENCES + 1, term
        assert 5 <= len(text.split()) <= LONGEST, term
    assert [cell.cell_type for cell in nbformat.read(GLOSSARY, as_version=4).cells] == ["markdown"] * (len(TERMS) + 1)


@pytest.mark.parametrize("term", TERMS)
def test_the_first_use_of_a_term_leads_to_it(term):
    use = first_use(term, NOTEBOOKS)
    assert use is not None, "no chapter uses it: leave it out"
    shown = [found["words"] for found in LINK.finditer(use.paragraph) if found["anchor"] == anchor(term)]
    assert len(shown) == 1 and use.words in shown[0], f"cell {use.cell}: {use.paragraph}"


def test_no_link_leads_to_a_term_that_is_not_there_or_that_was_linked_before():
    led = [anchor for _, _, anchor in links()]
    assert sorted(led) == sorted(map(anchor, TERMS))


def test_words_in_another_sense_are_terms():
    assert NOT_MEANT.keys() <= TERMS.keys()


def test_a_term_without_its_link_is_seen(tmp_path):
    notebook = nbformat.v4.new_notebook()
    texts = ["# Head\n\nA topic.", "## The topic\n\n> **Predict.** A topic.\n\nMore `topic`.", "A node. Two *topics*."]
    notebook.cells = [nbformat.v4.new_markdown_cell(text) for text in texts]
    path = tmp_path / "x.ipynb"
    nbformat.write(notebook, path)
    assert first_use("topic", [path]) == Use(path, notebook.cells[2].id, "A node. Two *topics*.", "topics")
    assert first_use("IMU", [path]) is None
