"""Node.known_publishers returns the publishers without waiting."""

import uuid

from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node, NodeOptions, Scope


def test_publishers_of_this_process_are_known_until_they_close():
    options = NodeOptions(partition=uuid.uuid4().hex, scope=Scope.PROCESS)
    with Node(options) as node, Node(options) as other:
        assert node.known_publishers("/a") == []
        publisher = other.advertise("/a", StringMsg)
        other.advertise("/b", StringMsg)
        (known,) = node.known_publishers("/a")
        assert (known.topic, known.msg_type_name) == ("/a", "gz.msgs.StringMsg")
        publisher.close()
        assert node.known_publishers("/a") == []
