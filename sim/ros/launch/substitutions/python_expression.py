"""The substitution for the result of a Python expression."""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from typing import Any

from gz_course.sim.error_text import named
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class PythonExpression(Substitution):
    """`str()` of the evaluated expression.

    The modules in `python_modules` are available in it, the names of `math` also without `math.`. Text needs quotes
    inside the expression: `["'", LaunchConfiguration("mode"), "' == 'fast'"]`.
    """

    def __init__(
        self, expression: SomeSubstitutionsType, python_modules: Iterable[SomeSubstitutionsType] = ("math",)
    ) -> None:
        self.expression = normalize_to_list_of_substitutions(expression)
        modules = [python_modules] if isinstance(python_modules, str | Substitution) else python_modules
        self.python_modules = [normalize_to_list_of_substitutions(module) for module in modules]

    def describe(self) -> str:
        return f"PythonExpr({describe_substitutions(self.expression)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the result as text. Raises SubstitutionFailure with the assembled expression."""
        text = perform_substitutions(context, self.expression)
        names: dict[str, Any] = {}
        for parts in self.python_modules:
            module_name = perform_substitutions(context, parts)
            try:
                module = importlib.import_module(module_name)
            except ImportError as error:
                raise SubstitutionFailure(f"PythonExpression cannot import '{module_name}': {error}") from None
            names[module_name.partition(".")[0]] = importlib.import_module(module_name.partition(".")[0])
            if module_name == "math":
                names.update({name: value for name, value in vars(module).items() if not name.startswith("_")})
        try:
            return str(eval(text.strip(), names))
        except Exception as error:
            hint = ""
            if isinstance(error, NameError):
                hint = "; text needs quotes inside the expression"
            raise SubstitutionFailure(f"the Python expression {text!r} fails with {named(error)}{hint}") from None
