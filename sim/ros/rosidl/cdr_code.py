"""The text of a function that grows piece by piece: what writes or reads a message is generated."""

from __future__ import annotations

from typing import Any


class Code:
    """The text of a function that grows, and the objects that it uses."""

    def __init__(self, names: dict[str, Any]) -> None:
        self.names = dict(names)
        self._lines: list[str] = []
        self._depth = 1
        self._made = 0

    def add(self, line: str) -> None:
        self._lines.append("    " * self._depth + line)

    def block(self, line: str) -> None:
        self.add(line)
        self._depth += 1

    def end(self) -> None:
        self._depth -= 1

    def local(self) -> str:
        """Return a name for a variable that is used nowhere else."""
        self._made += 1
        return f"v{self._made}"

    def constant(self, value: Any) -> str:
        self._made += 1
        name = f"C{self._made}"
        self.names[name] = value
        return name

    def function(self, argument: str, before: list[str], after: str) -> Any:
        lines = [f"def made({argument}):", *(f"    {line}" for line in before), *self._lines, f"    {after}"]
        exec(compile("\n".join(lines), "<cdr>", "exec"), self.names)
        return self.names["made"]
