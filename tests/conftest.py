"""What every test may rely on."""

import signal

from hypothesis import settings

# A shell's `&` has SIGINT ignored, and `nohup` SIGHUP: here, and in every process the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

# Whoever turns a test red has changed something: the examples are the same each time. `make fuzz` looks for new ones.
settings.register_profile("new_examples", settings.default)
settings.register_profile("repeatable", derandomize=True)
settings.load_profile("repeatable")
