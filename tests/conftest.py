"""What every test may rely on."""

import gc
import signal
import sys
from pathlib import Path

import pytest
from _pytest.assertion import rewrite
from hypothesis import settings
from hypothesis.internal.conjecture import providers

from gz_course.tests.process_guard import watch_over_this_process

# A shell's `&` has SIGINT ignored, and `nohup` SIGHUP: here, and in every process the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

# Whoever turns a test red has changed something: the examples are the same each time. `make fuzz` looks for new ones.
# No deadline: how long an example takes is a matter of what else the machine does.
settings.register_profile("new_examples", settings.default, deadline=None)
settings.register_profile("all_examples", derandomize=True, deadline=None, max_examples=50)
settings.register_profile("repeatable", settings.get_profile("all_examples"))
settings.load_profile("repeatable")
MOST_EXAMPLES = 20  # of a test, unless the profile is another; `make verify` asks for all that a test names

gc.disable()  # until everything is imported: it would find nothing to collect


@pytest.hookimpl(trylast=True)  # when the profile is that of the command line
def pytest_configure(config):
    watch_over_this_process(config._tmp_path_factory.getbasetemp())
    if hasattr(config, "workerinput") and not sys.dont_write_bytecode:
        compile_share(config)
    if settings.get_current_profile_name() == "repeatable":
        fewer = property(lambda each: min(each._max_examples, MOST_EXAMPLES))
        type.__setattr__(settings, "max_examples", fewer)
    if settings().derandomize:
        # Hypothesis also draws numbers and texts that stand in the modules which are loaded. Those are others in each
        # worker and change with any file: a test would be asked for other examples than the last time.
        providers._get_local_constants = providers.Constants


def compile_share(config):
    """Compile what is not compiled yet of every n-th test module, so that each worker does not compile them all."""
    number, count = int(config.workerinput["workerid"].removeprefix("gw")), config.workerinput["workercount"]
    for path in sorted(Path(__file__).parent.rglob("test_*.py"))[number::count]:
        compiled = rewrite.get_cache_dir(path) / f"{path.stem}{rewrite.PYC_TAIL}"
        if rewrite._read_pyc(path, compiled) is None and rewrite.try_makedirs(compiled.parent):
            checksum, code = rewrite._rewrite_test(path, config)
            rewrite._write_pyc(config.stash[rewrite.assertstate_key], code, checksum, compiled)


def pytest_collection_finish():
    gc.enable()
    gc.collect()
    gc.freeze()  # what is imported stays: no collection needs to look at it again


def pytest_terminal_summary(terminalreporter):
    """Print the table of attacks, if tests of `hostile/` have run at several levels."""
    from gz_course.tests.hostile.attack_table import print_table

    kinds = ("passed", "failed", "error", "skipped")
    reports = [each for kind in kinds for each in terminalreporter.getreports(kind) if hasattr(each, "user_properties")]
    print_table(terminalreporter.write_line, reports)
