"""The words of a command that is one text with substitutions, such as `cmd` of `<executable>`."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.errors import LaunchError

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend.parser import Parser
    from gz_course.sim.ros.launch.substitution import Substitution

_BLANKS = " \t\r\n"
# A word of plain text with its quotes, or blanks between two words.
_PIECE = re.compile(r"""[ \t\r\n]+|(?:[^ \t\r\n'"\\]|\\.|'[^']*'|"(?:[^"\\]|\\.)*"|['"\\])+""", re.DOTALL)


def command_words(text: str, parser: Parser) -> list[list[Substitution]]:
    """Return the words, which blanks outside of quotes separate; the result of a substitution is never split.

    Raises LaunchError for a quote that is not closed.
    """
    from gz_course.sim.ros.launch.substitutions import TextSubstitution

    words: list[list[Substitution]] = []
    is_open = False
    for part in parser.parse_substitution(text):
        pieces = _PIECE.findall(part.text) if isinstance(part, TextSubstitution) else [part]
        for piece in pieces:
            if isinstance(piece, str) and piece[0] in _BLANKS:
                is_open = False
                continue
            if not is_open:
                words.append([])
                is_open = True
            words[-1].append(TextSubstitution(text=_unquoted(piece)) if isinstance(piece, str) else piece)
    return words


def _unquoted(piece: str) -> str:
    try:
        return "".join(shlex.split(piece))
    except ValueError as error:
        raise LaunchError(f"the command cannot be split into words: {error} in {piece[:60]!r}") from None
