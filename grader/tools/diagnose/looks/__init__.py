"""The kinds of findings, one file each; every module in this folder is asked.

A file defines `look(system) -> Iterator[Finding]`, a function of what was observed. `BEFORE = ("no_clock",)` names the
looks whose findings of the same severity are printed later; the default order is alphabetical.
"""
