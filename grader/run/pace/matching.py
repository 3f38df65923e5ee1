"""Prediction of which endpoints DDS connects: lock-step waits for those matches, and for no others.

`lockstep.py` asks it about the endpoints that the submission's processes report.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.grader.run.agent.course_agent.endpoint_description import qos_can_match
from gz_course.grader.run.processes.progress import Endpoint

if TYPE_CHECKING:
    from gz_course.grader.run.grader_endpoints import GraderEndpoints


def can_match(endpoint: Endpoint, ros: GraderEndpoints) -> bool:
    """Return whether DDS will ever connect this endpoint with the grader's."""
    ours = ros.listens if endpoint.kind == "publisher" else ros.publishes
    if endpoint.kind == "subscription" and endpoint.reliability == "RELIABLE" and not ros.reliable(endpoint.topic):
        return False
    return ours(endpoint.topic) == endpoint.type and qos_can_match(
        endpoint.kind, endpoint.reliability, endpoint.durability, ros.keeps(endpoint.topic) > 0
    )


def will_match(publisher: Endpoint, subscription: Endpoint) -> bool:
    """Return whether DDS will connect a publisher with a subscription of the student's own."""
    return (
        publisher.topic == subscription.topic
        and publisher.type == subscription.type
        and not (publisher.reliability == "BEST_EFFORT" and subscription.reliability == "RELIABLE")
        and not (publisher.durability == "VOLATILE" and subscription.durability == "TRANSIENT_LOCAL")
    )
