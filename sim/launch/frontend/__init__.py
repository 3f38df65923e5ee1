"""Substitutions written as text, `$(var name)`, in parameter files with `allow_substs`."""

from gz_course.sim.launch.frontend.parse_substitution import expose_substitution, parse_substitution

__all__ = ["expose_substitution", "parse_substitution"]
