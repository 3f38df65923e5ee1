"""Tracebacks of the submission without the agent's own frames, as if the program had been started alone."""

from __future__ import annotations

import runpy
import sys
import traceback
from pathlib import Path


def print_traceback(error: BaseException) -> None:
    shown = traceback.TracebackException.from_exception(error)
    seen: set[int] = set()
    chain: list[traceback.TracebackException | None] = [shown]
    while chain:
        part = chain.pop()
        if part is None or id(part) in seen:
            continue
        seen.add(id(part))
        frames = [f for f in part.stack if not _is_ours(f.filename)]
        part.stack = traceback.StackSummary.from_list(frames)
        chain += [part.__cause__, part.__context__]
    sys.stdout.flush()
    print("".join(shown.format()), end="", file=sys.stderr, flush=True)


def _is_ours(file: str) -> bool:
    return file in (runpy.__file__, "<frozen runpy>") or Path(file).parent == Path(__file__).parent
