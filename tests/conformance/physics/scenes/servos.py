"""Velocity servos with and without limits, and forces against limits."""

from gz_course.tests.conformance.physics.bricks import apply_force, arm, inertial, joint_controller, model
from gz_course.tests.conformance.physics.scene import Force, Measure, Scene, Servo


def rotor(limit: str, plugin: str, inertia: float = 0.0005) -> str:
    return model(
        "rotor",
        "0 0 1 0 0 0",
        f"<link name='link'>{inertial(1.0, inertia, inertia, inertia)}</link><joint name='joint' type='revolute'>"
        f"<parent>world</parent><child>link</child><axis><xyz>0 1 0</xyz><limit>{limit}</limit></axis></joint>{plugin}",
    )


def turns(name: str, limit: str, speed: float, closed: float, inertia: float = 0.0005) -> Scene:
    return Scene(
        name,
        rotor(limit, joint_controller("joint"), inertia),
        2.0,
        (Measure("turned [rad]", lambda t: t.angle()[-1], 0.003, closed=closed),),
        (Servo("rotor::joint", speed),),
        joints=("rotor::joint",),
    )


SCENES = (
    turns("a servo without limits", "", 1.0, 2.0),
    turns("a light rotor, effort 10", "<effort>10</effort>", 1.0, 2.0),
    turns("a heavy rotor, effort 0.5", "<effort>0.5</effort>", 1.0, 2.0 - 1.0, 1.0),
    turns("a limit of velocity, 0.5", "<velocity>0.5</velocity>", 1.0, 1.0),
    turns("an effort of 0", "<effort>0</effort>", 1.0, 0.0),
    turns("a velocity of 0", "<velocity>0</velocity>", 1.0, 0.0),
    Scene(
        "a servo lifts an arm",
        arm(plugin=joint_controller("joint")),
        2.0,
        (Measure("angle [rad]", lambda t: t.angle()[-1], 0.005, closed=-0.8),),
        (Servo("arm::joint", -0.4),),
        joints=("arm::joint",),
    ),
    Scene(
        "a servo holds an arm",
        arm(plugin=joint_controller("joint")),
        2.0,
        (Measure("angle [rad]", lambda t: t.angle()[-1], 0.005, closed=0.0),),
        (Servo("arm::joint", 0.0),),
        joints=("arm::joint",),
    ),
    Scene(
        "a servo that is too weak for its arm",
        arm(limit="<effort>3</effort>", plugin=joint_controller("joint")),
        0.5,
        (Measure("angle [rad]", lambda t: t.angle()[-1], 0.01),),
        (Servo("arm::joint", 0.0),),
        joints=("arm::joint",),
    ),
    Scene(
        "a force is cut at the effort",
        rotor("<effort>0.1</effort>", apply_force("joint"), 0.1),
        1.0,
        (Measure("turned [rad]", lambda t: t.angle()[-1], 0.01, closed=0.5),),
        (Force("rotor::joint", 5.0),),
        joints=("rotor::joint",),
    ),
)
