#!/usr/bin/env bash
# Runs once, when Gradescope builds the autograder: puts the course into an environment of its own.
set -euo pipefail
root="${AUTOGRADER_ROOT:-/autograder}"

new_enough() { command -v "$1" >/dev/null && "$1" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; }
find_python() {
    for python in python3 python3.13 python3.12 python3.11; do
        if new_enough "$python"; then echo "$python"; return; fi
    done
    return 1
}

if ! python="$(find_python)"; then
    export DEBIAN_FRONTEND=noninteractive
    apt-get update
    apt-get install -y python3.12 python3.12-venv || apt-get install -y python3.11 python3.11-venv
    python="$(find_python)"
fi
# With it submissions are locked in more firmly.
command -v bwrap >/dev/null || apt-get install -y bubblewrap || true

# The programs are a wheel, or the folder itself; who unpacks a zip may drop what is a program, and `ros2 run` starts these.
course="$(ls "$root"/source/course/*.whl 2>/dev/null || echo "$root/source/course")"
if [ -d "$course" ]; then grep -rlIZ '^#!' "$course/sim/ros/prefix" | xargs -0 chmod +x; fi

"$python" -m venv "$root/venv"
"$root/venv/bin/pip" install --disable-pip-version-check --constraint "$root/source/course/constraints.txt" "$course"
chmod -R go-rwx "$root/source"  # submissions that run as another user do not read it
COURSE_ROOT="$root/source/course" "$root/venv/bin/course" doctor || true
echo "Submissions are graded in a sandbox of level @DEMAND@ or better. If the course doctor names a lower one for this"
echo "machine, every grading is refused: then package the exercise again with --demand and that level."
