"""What every test may rely on."""

import signal

# A shell that starts the tests with `&` has SIGINT ignored, here and in every process the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
