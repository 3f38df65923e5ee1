"""Rules that a test drops into a room, as a file of its own."""

import importlib
import sys

import pytest


@pytest.fixture
def drop(tmp_path, monkeypatch):
    """Return a function that puts a file into a package until the test ends, for these rooms of rules."""
    dropped = []

    def drop(package, name, source, *rooms):
        (tmp_path / f"{name}.py").write_text(source)
        module = importlib.import_module(package)
        monkeypatch.setattr(module, "__path__", [*module.__path__, str(tmp_path)])
        for room in rooms:
            monkeypatch.setattr(room, "_found", None)
            dropped.append((room, f"{package}.{name}"))
        importlib.invalidate_caches()

    yield drop
    for room, name in dropped:
        room._rules.pop(name, None)
        sys.modules.pop(name, None)
