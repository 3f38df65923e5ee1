"""The messages of Gazebo (gz.msgs): real protobuf classes, built when they are first asked for.

`from gz.msgs.twist_pb2 import Twist` works as with the official package; `message_class("gz.msgs.Twist")`
finds a class by the type name that travels with every message. The definitions are the texts in `proto/`, one
file for each file of gz-msgs 10 (Harmonic); a file is read, with those it imports, when a class of it is wanted. What
Fortress has too is compared with it, number by number, in `tests/conformance`; what only Harmonic has is not.
`proto/fortress/` holds what was different in Fortress. Nothing else of this project is imported from here.
"""

from gz_course.sim.gz.msgs.pb2_modules import PROTO_MODULES
from gz_course.sim.gz.msgs.registry import UnknownTypeError, canonical_name, message_class, type_names

__all__ = ["PROTO_MODULES", "UnknownTypeError", "canonical_name", "message_class", "type_names"]
