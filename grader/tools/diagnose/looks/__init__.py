"""One file for each kind of finding, found by being in this folder.

A file has `look(system) -> Iterator[Finding]`, a function of what was observed. `BEFORE = ("no_clock",)` names the
looks whose findings of the same severity are told later; without it the alphabet decides.
"""
