"""Mutants of a solution: the same file with one planted defect. A defect that no check notices is not tested for.

`python.py` and `yaml.py` know the places; a file is mutated by what its name ends in. `proof.py` grades what is chosen
here.
"""

from gz_course.grader.verify.mutants.mutant import MOST, Mutant, choose, mutants_of

__all__ = ["MOST", "Mutant", "choose", "mutants_of"]
