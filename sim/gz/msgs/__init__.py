"""Messages of Gazebo (gz.msgs): real protobuf classes, built on first use.

`from gz.msgs.twist_pb2 import Twist` works as with the official package; `message_class("gz.msgs.Twist")` finds a class
by the type name that travels with every message. `proto/` holds one file for each file of gz-msgs 10 (Harmonic), read
with its imports when one of its classes is requested. `tests/conformance` compares the fields with Fortress;
`proto/fortress/` holds the definitions that differ there. This package imports nothing else of the project.

Source: https://github.com/gazebosim/gz-msgs/tree/gz-msgs10/proto/gz/msgs
"""

from gz_course.sim.gz.msgs.pb2_modules import PROTO_MODULES
from gz_course.sim.gz.msgs.registry import UnknownTypeError, canonical_name, message_class, type_names

__all__ = ["PROTO_MODULES", "UnknownTypeError", "canonical_name", "message_class", "type_names"]
