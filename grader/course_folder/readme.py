"""The README of a student's folder: how to set it up, its exercises, and how to work with them."""

from __future__ import annotations

from pathlib import Path

from gz_course.grader.exercise import Exercise

TEMPLATE = Path(__file__).with_name("README.md.template")
FROM_A_COPY = """In this folder:

```
python3 -m venv .venv
.venv/bin/pip install -c constraints.txt -e '.[chapters]'
source .venv/bin/activate
course doctor
```

`course doctor` tries everything that the course needs on your machine, and says how to repair what does not work. In
each new terminal, come to this folder and run `source .venv/bin/activate` again."""
FROM_A_WHEEL = """The course is installed with pip, and `course init` has made this folder. In each new terminal,
activate the environment that you have installed it in, and come to this folder.

```
course doctor              # tries everything that the course needs on your machine
course update              # after `pip install --upgrade gz-ros2-course`: newer chapters; your own work is kept
pip install 'gz-ros2-course[chapters]'    # JupyterLab, for the chapters
```"""


def readme(exercises: list[Exercise], setup: str, notebooks: list[str]) -> str:
    """Return the text for these exercises and chapters; `setup` is its section on the installation."""
    rows = [
        f"| `{e.name}` | [{e.title}](exercises/{e.name}/README.md) | {_edited(e)} | {e.max_score:g} |"
        for e in exercises
    ]
    table = "\n".join(["| exercise | task | file you edit | points |", "|---|---|---|---|", *rows])
    text = TEMPLATE.read_text(encoding="utf-8").replace("@SETUP@", setup).replace("@EXERCISES@", table)
    return text.replace("@FIRST@", exercises[0].name).replace("@CHAPTERS@", _chapters(notebooks))


def _edited(exercise: Exercise) -> str:
    return ", ".join(f"`exercises/{exercise.name}/{name}`" for name in exercise.parts)


def _chapters(notebooks: list[str]) -> str:
    if not notebooks:
        return ""
    return f"""
## Read a chapter

Each chapter in `chapters/` is a notebook that leads to the exercise of the same name:

```
jupyter lab {notebooks[0]} --ServerApp.root_dir="$PWD"
```

[The glossary](chapters/glossary.ipynb) explains the terms, and [the cheat sheet](chapters/cheat_sheet.html) has topics,
types and commands on two pages to print: open it in a browser.
"""
