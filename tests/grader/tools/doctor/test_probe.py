"""A probe is a process of its own: it may hang, crash or leave children, and nothing of it stays."""

import os
import sys
import threading
import time

import psutil
import pytest

from gz_course.grader.tools.doctor import probe
from gz_course.grader.tools.doctor.probe import STARVED, ProbeError, TooSlow

HANGS = "print('begun', flush=True); import threading; threading.Event().wait()"


def test_it_gives_back_what_was_printed(probes_with):
    code = "import os, sys; print(sys.argv[1], os.environ['GIVEN'])"
    assert probes_with().run(code, "word", environment={"GIVEN": "variable"}) == "word variable"


@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("raise ValueError('planted')", "ValueError: planted"),
        ("import os; os.kill(os.getpid(), 11)", "ended by SIGSEGV"),
        ("import sys; sys.exit('one sentence')", "one sentence"),
        ("import sys; sys.exit(7)", "ended with exit code 7"),
    ],
)
def test_what_goes_wrong_is_its_last_line(probes_with, code, told):
    with pytest.raises(ProbeError, match=f"^{told}$"):
        probes_with().run(code)


def test_what_hangs_is_ended_at_the_deadline(probes_with):
    probes = probes_with(0.7)
    begun = time.monotonic()
    with pytest.raises(ProbeError, match=r"no answer within 0\.7 s"):
        probes.run("import signal; signal.signal(2, signal.SIG_IGN); signal.signal(15, signal.SIG_IGN)\n" + HANGS)
    assert time.monotonic() - begun < 300.0
    with pytest.raises(ProbeError, match="no answer"):
        probes.run("print()")


def test_what_still_computes_at_the_deadline_is_slow_not_broken(probes_with):
    with pytest.raises(
        TooSlow, match=r"no answer within 0\.4 s, but it was at work and had \d\.\d s of processor time"
    ):
        probes_with(0.4).run("while True: pass")


def test_on_a_crowded_machine_nothing_is_broken_for_want_of_an_answer(probes_with, monkeypatch):
    monkeypatch.setattr(probe, "crowded", lambda: True)
    probes = probes_with(0.3)
    for _ in range(2):
        with pytest.raises(TooSlow, match=r"no answer within 0\.3 s.*this machine is crowded|at work"):
            probes.run(HANGS)


def test_a_deadline_of_its_own_is_kept(probes_with):
    with pytest.raises(ProbeError, match=r"no answer within 0\.5 s"):
        probes_with().run(HANGS, within=0.5)


def test_children_go_with_it(probes_with):
    code = f"""
import subprocess, sys
child = subprocess.Popen([sys.executable, "-c", {HANGS!r}], stdout=subprocess.PIPE)
child.stdout.readline()
print(child.pid)
"""
    pid = int(probes_with().run(code))
    alive = [psutil.Process(pid)] if psutil.pid_exists(pid) else []
    alive = psutil.wait_procs(alive, timeout=120)[1]
    assert [p for p in alive if p.status() != psutil.STATUS_ZOMBIE] == []


def test_it_ends_by_itself_if_we_are_killed(probes_with):
    left = int(probes_with(30.0).run("print(signal.alarm(0))"))
    assert 0 < left <= 33 + STARVED


def test_the_folder_we_are_called_in_is_not_imported_from(probes_with, tmp_path, monkeypatch):
    (tmp_path / "string.py").write_text("raise SystemExit('a stranger')")
    monkeypatch.chdir(tmp_path)
    assert probes_with().run("import string; print(string.digits)") == "0123456789"


def test_closing_ends_what_runs(probes_with, tmp_path):
    probes = probes_with()
    probe = probes.start(f"open({str(tmp_path / 'begun')!r}, 'w').close()\n" + HANGS)
    pause, end = threading.Event(), time.monotonic() + 120
    while not (tmp_path / "begun").exists():
        assert time.monotonic() < end
        pause.wait(0.01)
    probes.close()
    assert not psutil.pid_exists(probe._process.pid)
    with pytest.raises(ProbeError):
        probes.start(HANGS)


def test_a_python_that_does_not_start_is_told(probes_with, monkeypatch):
    monkeypatch.setattr(sys, "executable", os.devnull)
    with pytest.raises(ProbeError, match="Python does not start"):
        probes_with().run("print()")
