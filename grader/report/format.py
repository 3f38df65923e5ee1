"""Report formats, and the command-line options that the formats in `formats/` contribute."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from gz_course.grader.registry import in_order, modules

if TYPE_CHECKING:
    from gz_course.grader.report.report import Report


@dataclass(frozen=True)
class Format:
    """A format of reports.

    `as_text` returns the bytes of the file if it is no text; it raises UsageError if a recording it needs cannot be
    read. `file` is the name of the report in a student's folder of a class. `help` describes the option of `course
    grade` and `course score`, `class_help` that of `course grade-all` (None: no such option). `before` names the
    formats whose options and reports come later; `prepare` does what can be done before there is a report.
    """

    as_text: Callable[[Report], str | bytes]
    file: str
    help: str
    class_help: str | None = None
    before: tuple[str, ...] = ()
    prepare: Callable[[], None] = lambda: None


@functools.cache
def formats() -> dict[str, Format]:
    from gz_course.grader.report import formats

    found: dict[str, Format] = {name: module.FORMAT for name, module in modules(formats).items()}
    return {name: found[name] for name in in_order({name: each.before for name, each in found.items()})}


def with_report_files(command: Callable[..., None]) -> Callable[..., None]:
    """Replace the parameter `reports` of a command by one option per format that names a file.

    The command gets `reports` as a dict of the files the user asked for, by format.
    """
    return _with_options(command, Path | None, None, {name: each.help for name, each in formats().items()})


def with_report_flags(command: Callable[..., None]) -> Callable[..., None]:
    """Replace the parameter `reports` of a class's command by one flag for each format that has `class_help`.

    The command gets `reports` as a dict of True for each format the user asked for.
    """
    helps = {name: each.class_help for name, each in formats().items() if each.class_help}
    return _with_options(command, bool, False, helps)


def _with_options(command: Callable[..., None], kind: Any, default: Any, helps: dict[str, str]) -> Callable[..., None]:
    """Return the command with a signature, read by typer, that has options in the place of `reports`."""
    import typer

    @functools.wraps(command)
    def with_options(**values: Any) -> None:
        asked = {name: values.pop(name) for name in helps}
        command(**values, reports={name: value for name, value in asked.items() if value})

    signature = inspect.signature(command, eval_str=True)
    parameters = [each for name, each in signature.parameters.items() if name != "reports"]
    for name, text in helps.items():
        annotation: Any = Annotated[kind, typer.Option(f"--{name}", help=text)]
        parameters.append(
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)
        )
    with_options.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    with_options.__annotations__ = {each.name: each.annotation for each in parameters}
    return with_options
