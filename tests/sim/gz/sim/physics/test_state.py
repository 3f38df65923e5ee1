"""The state of a model is copied to another model by name, for all kinds and orders of joints."""

from __future__ import annotations

import mujoco
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.physics.state import copy_state

BODIES = {
    "free": '<freejoint name="free"/>',
    "ball": '<joint name="ball" type="ball"/>',
    "hinge": '<joint name="hinge" type="hinge"/>',
    "slide": '<joint name="slide" type="slide"/>',
}
QPOS = {"free": 7, "ball": 4, "hinge": 1, "slide": 1}
DOFS = {"free": 6, "ball": 3, "hinge": 1, "slide": 1}


def build(names: list[str]) -> tuple[mujoco.MjModel, mujoco.MjData]:
    bodies = "".join(
        f'<body name="{name}" pos="{number} 0 0">{BODIES[name]}<geom size=".1" mass="1"/></body>'
        for number, name in enumerate(names)
    )
    actuators = "".join(
        f'<general name="{name}" joint="{name}" dyntype="integrator"/><motor name="{name}_motor" joint="{name}"/>'
        for name in names
        if name in ("hinge", "slide")
    )
    pins = "".join(f'<connect name="{name}_pin" body1="{name}" anchor="0 0 1" active="false"/>' for name in names)
    text = (
        f"<mujoco><worldbody>{bodies}</worldbody><equality>{pins}</equality><actuator>{actuators}</actuator></mujoco>"
    )
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def of(model: mujoco.MjModel, data: mujoco.MjData, name: str) -> dict[str, list[float]]:
    """Return everything on which the future of one body depends."""
    joint = model.joint(name)
    q, v = int(joint.qposadr[0]), int(joint.dofadr[0])
    dofs = slice(v, v + DOFS[name])
    found = {
        "qpos": data.qpos[q : q + QPOS[name]].tolist(),
        "xfrc": data.xfrc_applied[model.body(name).id].tolist(),
        "pin": [float(data.eq_active[model.equality(f"{name}_pin").id])],
    }
    for field in ("qvel", "qacc_warmstart", "qfrc_applied", "qacc"):
        found[field] = getattr(data, field)[dofs].tolist()
    if name in ("hinge", "slide"):
        found["ctrl"] = [float(data.ctrl[model.actuator(each).id]) for each in (name, f"{name}_motor")]
        found["act"] = [float(data.act[int(model.actuator(name).actadr[0])])]
    return found


orders = st.lists(st.sampled_from(sorted(BODIES)), unique=True, max_size=4)


@settings(deadline=None, max_examples=60)
@given(orders, orders, st.integers(0, 2**32 - 1))
def test_what_is_in_both_goes_on_and_what_is_new_starts(before: list[str], after: list[str], seed: int) -> None:
    old_model, old = build(before)
    random = np.random.default_rng(seed)
    for field in ("qpos", "qvel", "qacc_warmstart", "qacc", "qfrc_applied", "ctrl", "act"):
        getattr(old, field)[:] = random.normal(size=getattr(old, field).shape)
    old.xfrc_applied[:] = random.normal(size=old.xfrc_applied.shape)
    old.eq_active[:] = random.integers(0, 2, size=old.eq_active.shape)
    mujoco.mj_normalizeQuat(old_model, old.qpos)
    old.time = 12.5
    model, data = build(after)
    start = {name: of(model, data, name)["qpos"] for name in after}
    copy_state(old_model, old, model, data)
    assert data.time == 12.5
    for name in after:
        if name in before:
            assert of(model, data, name) == of(old_model, old, name)
        else:
            assert of(model, data, name)["qpos"] == start[name] and not any(of(model, data, name)["qvel"])


def test_a_joint_that_became_another_kind_starts_anew() -> None:
    one = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body><joint name="j" type="ball"/><geom size="1"/></body></worldbody></mujoco>'
    )
    other = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body><joint name="j" type="hinge"/><geom size="1"/></body></worldbody></mujoco>'
    )
    old, data = mujoco.MjData(one), mujoco.MjData(other)
    old.qvel[:] = 1.0
    copy_state(one, old, other, data)
    assert data.qpos.tolist() == [0.0] and data.qvel.tolist() == [0.0]
