"""What every test may rely on."""

import signal

# A shell's `&` has SIGINT ignored, and `nohup` SIGHUP: here, and in every process the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)
