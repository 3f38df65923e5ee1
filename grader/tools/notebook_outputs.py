"""A filter for git: takes a notebook from standard input and writes it to standard output as it is committed.

That is without outputs, numbers of execution and metadata of an editor, so that a chapter that was run is no change.
`make setup` names it to git as the filter `notebook-outputs`, which `.gitattributes` asks for. It needs nothing but
Python. What is not a notebook is passed on unchanged.

Git takes a file of another size for a modified one and asks no filter until it is added. So Jupyter, as `make chapters`
starts it, calls `after_save`.

Source: the Jupyter Notebook format, https://nbformat.readthedocs.io/en/latest/format_description.html; git,
"gitattributes", section "filter".
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from typing import Any

METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}


def as_committed(text: str) -> str:
    """Return the text of a notebook without what a run leaves in it; other texts as they are."""
    try:
        notebook: dict[str, Any] = json.loads(text)
        for cell in notebook["cells"]:
            cell["metadata"] = {}
            if cell["cell_type"] == "code":
                cell["outputs"], cell["execution_count"] = [], None
    except (ValueError, TypeError, KeyError):
        return text
    notebook["metadata"] = METADATA
    return json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def after_save(os_path: str, **_: Any) -> None:
    """Let git note that a saved notebook is as committed, if it is; leave it alone otherwise."""
    git = ["git", "-C", os.path.dirname(os_path)]  # noqa: PTH120 - without imports that a filter does not need
    with contextlib.suppress(OSError):
        unchanged = subprocess.run([*git, "diff", "--quiet", "--", os_path], capture_output=True, check=False)
        if unchanged.returncode == 0:
            subprocess.run([*git, "add", "--update", "--", os_path], capture_output=True, check=False)


if __name__ == "__main__":
    sys.stdout.buffer.write(as_committed(sys.stdin.buffer.read().decode()).encode())
