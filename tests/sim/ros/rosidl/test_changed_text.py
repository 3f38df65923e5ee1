"""A definition that changes, or is used by several processes, is read anew by each process; nothing is stored."""

import subprocess
import sys


def fields(package):
    code = f"from {package}.msg import Level; print(Level.get_fields_and_field_types())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=True)
    return done.stdout.strip()


def test_a_changed_text_is_seen_by_the_next_process_and_not_by_this_one(packages):
    package = packages.write({"msg/Level.msg": "float32 level"})
    module = __import__(f"{package}.msg", fromlist=["Level"])
    assert module.Level(level=1.0).level == 1.0
    packages.write({"msg/Level.msg": "float64 height"}, package)
    assert fields(package) == "{'height': 'double'}"
    assert module.Level.get_fields_and_field_types() == {"level": "float"}
    assert module.Level(level=2.0).level == 2.0
