"""A trial's seed decides the scripted commands, and nothing else does."""

from hypothesis import given
from hypothesis import strategies as st

from grader.exercise import ScriptedCommand
from grader.trial import SCRIPT_SPREAD, Trial

COMMAND = ScriptedCommand(at=0.5, topic="/model/robot/cmd_vel", linear_x=0.3, angular_z=-0.25)


@given(st.integers())
def test_same_seed_same_command_and_always_near_the_script(seed):
    varied = Trial("public", seed).vary(COMMAND)
    assert varied == Trial("hidden", seed).vary(COMMAND)
    assert (varied.at, varied.topic) == (COMMAND.at, COMMAND.topic)
    for now, before in ((varied.linear_x, COMMAND.linear_x), (varied.angular_z, COMMAND.angular_z)):
        assert abs(now - before) <= abs(before) * SCRIPT_SPREAD + 1e-12


def test_other_seeds_and_other_moments_vary_differently():
    speeds = {Trial("public", seed).vary(COMMAND).linear_x for seed in range(50)}
    assert len(speeds) == 50
    later = ScriptedCommand(**COMMAND.__dict__ | {"at": 4.5})
    assert Trial("public", 0).vary(later).linear_x != Trial("public", 0).vary(COMMAND).linear_x


def test_known_values_do_not_drift():
    """A stored grade is only worth something as long as its seed means the same run."""
    varied = Trial("public", 7).vary(COMMAND)
    assert (round(varied.linear_x, 6), round(varied.angular_z, 6)) == (0.315235, -0.210962)
