"""Members of a node that hide those of rclpy's Node, as found by running it."""

import pytest
import rclpy
from rclpy.node import Node

from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.slips.nodes.hidden_members import ASKED, READ

TEXT = """\
class Base(Node):
    pass


class Driver(Base):
    {member}

    def __init__(self):
        super().__init__("driver")
"""


def said(member):
    return [each["said"] for each in slips(TEXT.format(member=member).encode()) if " hides " in each["said"]]


@pytest.mark.parametrize("name", sorted(READ))
def test_a_hidden_property_is_named(name):
    assert said(f"def {name}(self):\n        return 3") == [
        f"Driver.{name} hides the {name} of Node, which rclpy itself reads: give it another name"
    ]
    assert said(f"{name} = []") == said(f"{name}: list = []") != []


@pytest.mark.parametrize("name", sorted(ASKED))
def test_a_hidden_method_that_returns_nothing_is_named(name):
    assert said(f"def {name}(self):\n        print(1)") != []
    assert said(f"def {name}(self, *given):\n        return super().{name}(*given)") == []


@pytest.mark.parametrize(
    "member", ["speed = 3", "timers: list", "@property\n    def clients(self):\n        return []", "..."]
)
def test_what_hides_nothing(member):
    assert said(member) == []


def test_a_class_that_is_no_node():
    assert not [each for each in slips(b"class A:\n    timers = []\n") if " hides " in each["said"]]


def test_the_names_are_those_of_the_node():
    properties = {name for name in dir(Node) if isinstance(getattr(Node, name), property)}
    assert properties == READ
    assert all(callable(getattr(Node, name)) for name in ASKED)


@pytest.mark.parametrize("name", ["handle", "executor"])
def test_rclpy_really_fails_with_it(name):
    context = rclpy.Context()
    context.init()
    hiding = type("Hiding", (Node,), {name: lambda self: None})
    with pytest.raises((AttributeError, TypeError)):
        hiding("hiding", context=context)
    context.try_shutdown()
