"""Mutants of a solution: the same file with one planted defect. A defect that no check notices is not tested for.

`python.py` and `yaml.py` mutate files of their type, chosen by the file's suffix. `proof.py` grades the mutants that
are chosen here.
"""

from gz_course.grader.verify.mutants.mutant import MOST, Mutant, choose, mutants_of

__all__ = ["MOST", "Mutant", "choose", "mutants_of"]
