"""One file for each kind of finding, found by being in this folder.

A file has `RANK` (the smaller, the sooner it is told among findings of equal severity) and
`look(system) -> Iterator[Finding]`, a function of what was observed.
"""
