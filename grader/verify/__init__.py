"""The instructor's proof that an exercise grades as it declares.

`declared.py` reads what the private half declares, `proof.py` compares it with the result of grading, `mutants/`
changes the solution in one place at a time, `jobs.py` grades in several processes.
"""

from gz_course.grader.verify.declared import FEWEST_ACCEPTED, FEWEST_REJECTED, Variant, orphans, variants

__all__ = ["FEWEST_ACCEPTED", "FEWEST_REJECTED", "Variant", "orphans", "variants"]
