"""What every test may rely on."""

import signal

from hypothesis import settings

from gz_course.tests.process_guard import watch_over_this_process

# A shell's `&` has SIGINT ignored, and `nohup` SIGHUP: here, and in every process the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

# Whoever turns a test red has changed something: the examples are the same each time. `make fuzz` looks for new ones.
# No deadline: how long an example takes is a matter of what else the machine does.
settings.register_profile("new_examples", settings.default, deadline=None)
settings.register_profile("repeatable", derandomize=True, deadline=None, max_examples=50)
settings.load_profile("repeatable")


def pytest_configure():
    watch_over_this_process()


def pytest_terminal_summary(terminalreporter):
    """Print the table of attacks, if tests of `hostile/` have run at several levels."""
    from gz_course.tests.hostile.attack_table import print_table

    kinds = ("passed", "failed", "error", "skipped")
    reports = [each for kind in kinds for each in terminalreporter.getreports(kind) if hasattr(each, "user_properties")]
    print_table(terminalreporter.write_line, reports)
