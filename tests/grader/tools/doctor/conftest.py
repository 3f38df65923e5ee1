"""Probes for a test: processes and folder are gone when it ends."""

import psutil
import pytest

from gz_course.grader.tools.doctor import probe
from gz_course.grader.tools.doctor.probe import Probes


@pytest.fixture(autouse=True)
def plenty_of_processors(monkeypatch):
    """Whatever else this machine does, a probe that hangs is told as one."""
    monkeypatch.setattr(probe, "crowded", lambda: False)


@pytest.fixture
def probes_with():
    """`probes_with(seconds)` makes probes; afterwards nothing that they started may be left."""
    made = []

    def make(deadline=60.0):
        made.append(Probes(deadline))
        return made[-1]

    yield make
    before = [each._process.pid for probes in made for each in probes._started]
    for probes in made:
        probes.close()
    assert [pid for pid in before if psutil.pid_exists(pid)] == []
    assert [probes.folder for probes in made if probes.folder.exists()] == []
