"""The course on every Python of this machine: `make pythons`, or `python -m gz_course.tests.pythons`.

Each Python gets a clone of what is committed, with an environment of its own. With those of `SUITE` the whole suite
runs; with the others `make demo` and the solution of each exercise, which must earn full marks.
"""
