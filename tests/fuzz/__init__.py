"""Programs that feed the loaders damaged input by the ten thousand: `python -m tests.fuzz.load_worlds --help`."""
