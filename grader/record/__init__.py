"""The recording of a run: written once while it happens, read back by everything that judges it."""
