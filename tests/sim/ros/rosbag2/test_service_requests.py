"""Recorded events of a service are played: as they are, or as calls of the service."""

import threading

import pytest
from rclpy.serialization import serialize_message

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.playing.player import Player, PlayOptions
from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
from gz_course.sim.ros.rosbag2.storage.metadata import Topic
from gz_course.sim.ros.rosbag2.storage.offered_qos import QosProfile
from gz_course.sim.ros.rosbag2.stored_types import installed_class, service_class
from gz_course.tests.sim.ros.rosbag2.bags import START

TOPIC = "/switch/_service_event"


@pytest.fixture
def bag(tmp_path):
    """A bag with the events of three calls: told by client and service, told by the service, and without contents."""
    from std_srvs.srv import SetBool

    writer = BagWriter(tmp_path / "calls")
    writer.add_topic(Topic(TOPIC, "std_srvs/srv/SetBool_Event", qos=(QosProfile(),)), ("unknown", ""))
    for number, (kind, requests) in enumerate(
        [(0, [SetBool.Request(data=True)]), (1, [SetBool.Request(data=True)]), (2, []), (1, [])]
    ):
        event = SetBool.Event(request=requests)
        event.info.event_type = kind
        writer.write(TOPIC, START + number, 0, serialize_message(event))
    writer.close()
    return Bag(writer.folder)


def test_events_are_played_as_requests_or_as_they_are(nodes, bag, capfd):
    from std_srvs.srv import SetBool

    asked = []

    def switch(request, response):
        asked.append(request.data)
        return response

    service = nodes.other.create_service(SetBool, "/switch", switch)
    for source in ("service_introspection", "client_introspection"):
        player = Player(nodes.own, bag, PlayOptions(requests_of=source, acknowledged=0.001), installed_class)
        assert player.topics() == [TOPIC]
        (requests,) = player._requests.values()
        nodes.until(requests.client.service_is_ready)
        asked.clear()
        player.play()
        nodes.until(lambda: asked == [True])
        nodes.own.destroy_client(requests.client)
    assert capfd.readouterr().err.count("recorded without their contents") == 1
    nodes.other.destroy_service(service)

    player = Player(nodes.own, bag, PlayOptions(requests_of="service_introspection"), installed_class)
    nodes.until(lambda: not player._requests[TOPIC].client.service_is_ready())
    player.play()
    assert "because the '/switch' service is not ready" in capfd.readouterr().err
    nodes.own.destroy_client(player._requests[TOPIC].client)

    events = []
    end = nodes.other.create_subscription(SetBool.Event, TOPIC, events.append, 10)
    player = Player(nodes.own, bag, PlayOptions(), installed_class)
    nodes.until(lambda: player._publishers[TOPIC].get_subscription_count() and end.get_publisher_count())
    thread = threading.Thread(target=player.play)
    thread.start()
    nodes.until(lambda: len(events) == 4)
    thread.join()
    assert [event.info.event_type for event in events] == [0, 1, 2, 1]
    nodes.other.destroy_subscription(end)
    nodes.own.destroy_publisher(player._publishers[TOPIC])


def test_what_is_no_service():
    for name in ("std_msgs/msg/String", "std_srvs/srv/SetBool", "std_srvs/srv/Nothing_Event", "../x/srv/Y_Event"):
        with pytest.raises(BagError, match=r"not the type of the events of a service|is not known here"):
            service_class(name)
