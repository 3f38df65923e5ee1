#!/usr/bin/env bash
# Runs once when the container is made: installs the course in .venv.
set -euo pipefail
cd "$(dirname "$0")/.."
python3 -I sim/machine.py
python3 -m venv .venv
.venv/bin/pip install --quiet --constraint constraints.txt --editable '.[hub]'
touch .venv/with-course .venv/with-chapters # what `make` looks for
if ! grep -qs 'course-environment' ~/.bashrc; then
    printf 'source "%s/.venv/bin/activate" # course-environment\n' "$PWD" >>~/.bashrc
fi
