"""`course doctor`: `checks/` are its questions, `probe.py` runs programs for them, `checkup.py` asks them all."""
