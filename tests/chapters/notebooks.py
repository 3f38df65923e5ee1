"""The chapters' notebooks: read, copied beside the exercises as a student has them, and executed in a real kernel."""

import re
import shutil
from pathlib import Path

import nbformat
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "chapters").glob("*/*.ipynb"))
CELL_DEADLINE = 1200  # [s] of a hanging cell; a busy machine may need long


def read(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    return notebook


def code_cells(path):
    return [cell for cell in read(path).cells if cell.cell_type == "code"]


def printed(cell):
    text = "".join(output.get("text", "") for output in cell.outputs)
    return re.sub(r"\x1b\[[0-9;]*m", "", text)


def copy_of_course(path, tmp_path):
    """Copy a chapter and the exercises; return the folder of the chapter."""
    folder = tmp_path / "chapters" / path.stem
    shutil.copytree(path.parent, folder, ignore=shutil.ignore_patterns("runs", "*.py", ".*"))
    shutil.copytree(ROOT / "exercises", tmp_path / "exercises", ignore=shutil.ignore_patterns("runs", "__pycache__"))
    return folder


def client_of(notebook, folder):
    """Return what executes a notebook in this folder."""
    return NotebookClient(notebook, timeout=CELL_DEADLINE, resources={"metadata": {"path": str(folder)}})
