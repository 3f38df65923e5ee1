"""The topics of a partition, in this process and in others, for the lists of `Node`."""

from __future__ import annotations

from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.advertisement import Advertisement
from gz_course.sim.gz.transport.message_info import MessagePublisher
from gz_course.sim.gz.transport.options import NodeOptions, Scope
from gz_course.sim.gz.transport.reach import network_for
from gz_course.sim.gz.transport.subscription import Subscription
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD


def known_publishers(options: NodeOptions, topic: str) -> list[MessagePublisher]:
    """Return the publishers of a topic that are known now, for a node with these options."""
    name = options.qualified(topic)
    found = [
        MessagePublisher(each.topic, "", each.type_name, "", each.node_uuid, each.scope)
        for each in SWITCHBOARD.all_publishers()
        if each.name == name
    ]
    if network := network_for(options.scope):
        found += network.known_publishers(name)
    return found


def publishers_and_subscribers(options: NodeOptions) -> tuple[list[MessagePublisher], list[MessagePublisher]]:
    """Return the publishers and the subscribers of all topics of the partition; waits until the others had time."""
    process, address = "", ""
    published: list[tuple[str, MessagePublisher]] = []
    subscribed: list[tuple[str, MessagePublisher]] = []
    if network := network_for(options.scope):
        process, address = network.process_uuid, network.address
        published, subscribed = network.known_elsewhere()

    def named(each: Advertisement | Subscription) -> tuple[str, MessagePublisher]:
        reachable = address if each.scope != Scope.PROCESS else ""
        topic = naming.split(each.name)[1]
        return each.name, MessagePublisher(topic, reachable, each.type_name, process, each.node_uuid, each.scope)

    published += map(named, SWITCHBOARD.all_publishers())
    subscribed += map(named, SWITCHBOARD.all_subscriptions())
    own = naming.partition_prefix(options.partition)
    return (
        [info for name, info in published if name.startswith(own)],
        [info for name, info in subscribed if name.startswith(own)],
    )
