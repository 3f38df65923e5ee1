"""The action that includes another launch file."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.actions.opaque_coroutine import OpaqueCoroutine
from gz_course.sim.ros.launch.actions.opaque_function import OpaqueFunction
from gz_course.sim.ros.launch.actions.set_launch_configuration import SetLaunchConfiguration
from gz_course.sim.ros.launch.errors import LaunchError, MissingArgumentError, NotTextError
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.frontend.named_values import named_values
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.launch_description_source import LaunchDescriptionSource
from gz_course.sim.ros.launch.launch_description_sources.any_launch_description_source import AnyLaunchDescriptionSource
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.this_launch_file import CURRENT_FILE
from gz_course.sim.ros.launch.substitutions.this_launch_file_dir import CURRENT_FOLDER
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser

_CHAIN = "launch_file_chain"
_DEEPEST = 50
Pairs = Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]]


@expose_action("include")
class IncludeLaunchDescription(Action):
    """Visits the launch description of `launch_description_source`, a source or a path.

    `launch_arguments` are pairs or a dict. The included file shares the scope of the including one: it sees all
    configurations, and its changes remain; use GroupAction to limit them.
    """

    includes_description = True

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Pairs | Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.launch_description_source = _as_source(launch_description_source)
        pairs = launch_arguments.items() if isinstance(launch_arguments, Mapping) else (launch_arguments or ())
        self.launch_arguments = [_as_pair(pair) for pair in pairs]  # values are looked at on execution

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<include file=>`, which can hold `<arg name= value=/>` or `<let name= value=/>`."""
        _, options = super().parse(entity, parser)
        options["launch_description_source"] = parser.parse_substitution(entity.get_attr("file"))
        options["launch_arguments"] = [
            pair
            for name in ("arg", "let")
            for pair in named_values(
                entity.get_attr(name, data_type=list[Entity], optional=True) or (),
                parser,
            ).items()
        ]
        return cls, options

    def describe(self) -> str:
        return f"IncludeLaunchDescription({self.launch_description_source.location})"

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the launch description if it can be loaded now; errors are reported on execution."""
        try:
            description = self.launch_description_source.try_get_launch_description_without_context(self._file)
        except Exception as error:
            launch_logging.get_logger("launch").debug(
                f"{self.launch_description_source.location} cannot be looked into: {error}"
            )
            return []
        return [] if description is None else [description]

    @property
    def _file(self) -> str | None:
        """Return the file that creates the action, in whose folder ThisLaunchFileDir is before the launch runs."""
        return None if self._place is None else self._place[0]

    @property
    def _known_location(self) -> str | None:
        return self.launch_description_source.known_location(self._file)

    def leads_back_into(self, chain: Iterable[IncludeLaunchDescription]) -> bool:
        """Return whether one of the including files is the file itself."""
        own = self._known_location
        others = [each._known_location for each in chain]
        return own is not None and any(other is not None and _same(own, other) for other in others)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Load the launch file; return its arguments and its launch description.

        Raises MissingArgumentError, LaunchError for endless recursion of files, and the errors of loading the file.
        """
        outside = context.get_locals_as_dict()
        before = {name: outside.get(name) for name in (CURRENT_FILE, CURRENT_FOLDER, _CHAIN)}
        description = self.launch_description_source.get_launch_description(context)
        location = self.launch_description_source.location
        inside: dict[str, Any] = {_CHAIN: self._extended_chain(before[_CHAIN] or (), context)}
        if location != "''":
            inside |= {CURRENT_FILE: location, CURRENT_FOLDER: os.path.dirname(location)}  # noqa: PTH120
        pairs = [_normalized(pair) for pair in self.launch_arguments]
        given = [perform_substitutions(context, name) for name, _ in pairs]
        self._warn_of_unknown(description, given)
        self._check_required(description, given, context)
        context.extend_locals(inside)
        setting = [SetLaunchConfiguration(name, value) for name, value in pairs]

        def leave(context: LaunchContext) -> None:
            context.extend_locals(before)

        return [*setting, description, OpaqueFunction(function=leave)]

    def _extended_chain(self, chain: tuple[tuple[str, str], ...], context: LaunchContext) -> tuple:
        """Return the files being included with their configurations. Raises LaunchError for endless recursion."""
        configurations = repr(sorted(context.launch_configurations.items(), key=lambda item: item[0]))
        here = (self.launch_description_source.location, configurations)
        if here[0] == "''":
            return chain
        if here in chain or len(chain) >= _DEEPEST:
            names = " -> ".join(path for path, _ in (*chain[-4:], here))
            raise LaunchError(f"the launch files include each other without end: {names}")
        return (*chain, here)

    def _check_required(self, description: LaunchDescription, given: list[str], context: LaunchContext) -> None:
        declared = description.get_launch_arguments_with_include_launch_description_actions(only_search_local=True)
        for argument, _ in declared:
            if argument._conditionally_included or argument.default_value is not None:
                continue
            if argument.name not in given and argument.name not in context.launch_configurations:
                raise MissingArgumentError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(given)}]"
                )

    def _warn_of_unknown(self, description: LaunchDescription, given: list[str]) -> None:
        """Warn about an argument that has no effect, probably because of a typo in its name."""
        if not given or _may_use_anything(description, [self]):
            return
        known = {argument.name for argument in description.get_launch_arguments()}
        unknown = [name for name in dict.fromkeys(given) if name not in known]
        file = Path(self.launch_description_source.location)
        if not unknown or not file.is_file():
            return
        source = file.read_text(encoding="utf-8", errors="replace")
        for name in unknown:
            if not re.search(rf"""["']{re.escape(name)}["']""", source):
                listing = did_you_mean(name, known, listing="its arguments are") or "; it has no arguments"
                launch_logging.get_logger("launch").warning(
                    f"'{name}' is not an argument of {file} and has no effect there{listing}"
                )


def _may_use_anything(entity: LaunchDescriptionEntity, chain: list[IncludeLaunchDescription]) -> bool:
    """Return whether an entity cannot be inspected and may use any launch configuration."""
    if isinstance(entity, OpaqueFunction | OpaqueCoroutine):
        return True
    if isinstance(entity, IncludeLaunchDescription):
        if entity.leads_back_into(chain):
            return False
        if not entity.launch_description_source.has_plain_location or not entity.get_sub_entities():
            return True
        chain = [*chain, entity]
    groups = [entity.describe_sub_entities(), *[group for _, group in entity.describe_conditional_sub_entities()]]
    return any(_may_use_anything(each, chain) for group in groups for each in group)


def _as_pair(pair: Any) -> tuple[Any, Any]:
    if not isinstance(pair, tuple | list) or len(pair) != 2:
        raise TypeError(
            f"launch_arguments holds {pair!r}; pairs of name and value are expected: "
            'launch_arguments={"name": "value"}.items()'
        )
    return pair[0], pair[1]


def _normalized(pair: tuple[Any, Any]) -> tuple[list[Substitution], list[Substitution]]:
    name, value = pair
    if value is None:
        raise NotTextError(f"the launch argument {name!r} has the value None; leave it out, or give it as text")
    return normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value)


def _same(one: str, other: str) -> bool:
    return os.path.realpath(one) == os.path.realpath(other)


def _as_source(source: Any) -> LaunchDescriptionSource:
    """Return a source for an argument of IncludeLaunchDescription: a source or the path of a launch file."""
    if isinstance(source, LaunchDescriptionSource):
        return source
    if isinstance(source, LaunchDescription):
        return LaunchDescriptionSource(source)
    if isinstance(source, str | os.PathLike | Substitution | list | tuple):
        return AnyLaunchDescriptionSource(source)
    raise TypeError(
        f"IncludeLaunchDescription wants PythonLaunchDescriptionSource(path), not {source!r} of type "
        f"{type(source).__name__}"
    )
