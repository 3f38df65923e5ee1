"""The result of a Python expression that is put together from text and substitutions."""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from typing import Any

from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.substitution import Substitution
from gz_course.sim.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class PythonExpression(Substitution):
    """`str()` of the evaluated expression.

    The modules named in `python_modules` can be used in it; the names of `math` also without `math.`. Text needs
    quotes inside the expression: `["'", LaunchConfiguration("mode"), "' == 'fast'"]`.
    """

    def __init__(
        self, expression: SomeSubstitutionsType, python_modules: Iterable[SomeSubstitutionsType] = ("math",)
    ) -> None:
        self.__expression = normalize_to_list_of_substitutions(expression)
        modules = [python_modules] if isinstance(python_modules, str | Substitution) else python_modules
        self.__modules = [normalize_to_list_of_substitutions(module) for module in modules]

    @property
    def expression(self) -> list[Substitution]:
        """The expression."""
        return self.__expression

    @property
    def python_modules(self) -> list[list[Substitution]]:
        """The names of the modules."""
        return self.__modules

    def describe(self) -> str:
        """`PythonExpr('...')`."""
        return f"PythonExpr({describe_substitutions(self.__expression)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the result as text. Raises SubstitutionFailure with the assembled expression."""
        text = perform_substitutions(context, self.__expression)
        names: dict[str, Any] = {}
        for parts in self.__modules:
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
            raise SubstitutionFailure(
                f"the Python expression {text!r} fails with {type(error).__name__}: {error}{hint}"
            ) from None
