"""Makes `from gz.msgs.twist_pb2 import Twist` work without generated files.

An import hook: the module `<file>_pb2` of this package is assembled from `proto/<file>.proto` when it is imported. It
holds what a module written by protoc holds: the message classes, top-level enums with their values, DESCRIPTOR.
"""

from __future__ import annotations

import importlib.machinery
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from types import ModuleType

from google.protobuf import message_factory
from google.protobuf.internal import enum_type_wrapper

from gz_course.sim.gz.msgs import registry

_PREFIX = f"{__package__}."
_SUFFIX = "_pb2"


class ProtoModules(MetaPathFinder, Loader):
    """Finds and fills the modules `gz.msgs.<file>_pb2`."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """A module specification for the names this hook knows, None for all others."""
        if not (fullname.startswith(_PREFIX) and fullname.endswith(_SUFFIX)):
            return None
        stem = fullname.removeprefix(_PREFIX).removesuffix(_SUFFIX)
        source = registry.PROTO_FOLDER / f"{stem}.proto"
        if not source.is_file():
            return None
        return importlib.machinery.ModuleSpec(fullname, self, origin=str(source))

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType | None:
        """The default module object is the right one."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """Fills the module with the classes and enums of its file."""
        stem = module.__name__[len(_PREFIX) : -len(_SUFFIX)]
        file = registry.load_file(stem)
        module.__doc__ = f"The messages of gz/msgs/{stem}.proto."
        contents = vars(module)
        contents["DESCRIPTOR"] = file
        for name, descriptor in file.message_types_by_name.items():
            contents[name] = message_factory.GetMessageClass(descriptor)
        for name, descriptor in file.enum_types_by_name.items():
            contents[name] = enum_type_wrapper.EnumTypeWrapper(descriptor)
            contents.update({value.name: value.number for value in descriptor.values})


PROTO_MODULES = ProtoModules()
sys.meta_path.append(PROTO_MODULES)
