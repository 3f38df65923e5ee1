"""Imports without the collector leave everything as it was, also when one fails."""

import gc
import os
import sys

import pytest

from gz_course.grader.process.many_imports import many_imports


@pytest.mark.parametrize("given", [None, "egl"])
def test_collector_and_environment_are_as_before(monkeypatch, given):
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "")
    if given:
        monkeypatch.setenv("MUJOCO_GL", given)
    frozen = gc.get_freeze_count()
    try:
        with pytest.raises(ImportError), many_imports():
            assert not gc.isenabled() and os.environ["MUJOCO_GL"] == (given or "disabled")
            assert os.environ["OPENBLAS_NUM_THREADS"] == "1"
            monkeypatch.setitem(sys.modules, "just_imported", None)
            raise ImportError
        assert gc.isenabled() and gc.get_freeze_count() > frozen
        assert os.environ.get("MUJOCO_GL") == given and os.environ["OPENBLAS_NUM_THREADS"] == ""
        frozen = gc.get_freeze_count()
        with many_imports():
            pass
        assert gc.get_freeze_count() <= frozen, "nothing was imported, and garbage stays garbage"
    finally:
        gc.unfreeze()
