"""What `course doctor` looks at: `checks/` are its questions, `probe.py` its hands, `checkup.py` puts them together."""
