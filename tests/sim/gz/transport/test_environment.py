import pwd
import socket

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.transport import environment
from gz_course.sim.gz.transport.environment import NetworkSettings, default_partition


def test_the_partition_is_gz_partition_even_when_empty():
    assert default_partition({"GZ_PARTITION": "class"}) == "class"
    assert default_partition({"GZ_PARTITION": "", "USER": "ann"}) == ""


def test_the_default_partition_is_host_and_user():
    assert default_partition({"USER": "ann", "LOGNAME": "bob"}) == f"{socket.gethostname()}:ann"


def test_without_user_the_account_of_the_uid_counts(monkeypatch):
    monkeypatch.setattr(environment.os, "getuid", lambda: 0)
    assert default_partition({"LOGNAME": "bob"}) == f"{socket.gethostname()}:{pwd.getpwuid(0).pw_name}"


def test_a_uid_without_a_name_gets_a_partition_of_its_own_and_is_told(monkeypatch, capsys):
    monkeypatch.setattr(environment.os, "getuid", lambda: 3999999999)
    assert default_partition({}) != default_partition({})
    assert "set USER or GZ_PARTITION" in capsys.readouterr().err


def test_without_settings_everything_stays_on_this_machine():
    assert NetworkSettings.from_environment({}) == NetworkSettings("127.0.0.1", "239.255.0.7", 10317, 10318, 1000, 1000)


def test_every_setting_is_read(capsys):
    found = NetworkSettings.from_environment(
        {
            "GZ_IP": "10.0.0.7",
            "GZ_DISCOVERY_MULTICAST_IP": "239.1.2.3",
            "GZ_DISCOVERY_MSG_PORT": "20001",
            "GZ_DISCOVERY_SRV_PORT": "20002",
            "GZ_TRANSPORT_SNDHWM": "0",
            "GZ_TRANSPORT_RCVHWM": "7",
        }
    )
    assert found == NetworkSettings("10.0.0.7", "239.1.2.3", 20001, 20002, 0, 7)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(("both", "service"), [("400", 401), ("65535", 65534)])
def test_equal_ports_are_moved_apart(both, service, capsys):
    found = NetworkSettings.from_environment({"GZ_DISCOVERY_MSG_PORT": both, "GZ_DISCOVERY_SRV_PORT": both})
    assert (found.message_port, found.service_port) == (int(both), service)
    assert f"services use {service}" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["GZ_RELAY", "GZ_TRANSPORT_USERNAME"])
def test_what_is_not_supported_is_said(name, capsys):
    assert NetworkSettings.from_environment({name: "1"}) == NetworkSettings()
    assert name in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("GZ_IP", "localhost"),
        ("GZ_DISCOVERY_MSG_PORT", "-1"),
        ("GZ_DISCOVERY_MSG_PORT", "70000"),
        ("GZ_TRANSPORT_SNDHWM", "many"),
    ],
)
def test_a_useless_value_is_reported_and_replaced(name, value, capsys):
    assert NetworkSettings.from_environment({name: value}) == NetworkSettings()
    error = capsys.readouterr().err
    assert name in error
    assert value in error


@given(st.text(), st.text(), st.text())
def test_any_text_gives_usable_settings(ip, port, mark):
    found = NetworkSettings.from_environment({"GZ_IP": ip, "GZ_DISCOVERY_MSG_PORT": port, "GZ_TRANSPORT_RCVHWM": mark})
    socket.inet_aton(found.ip)
    assert 1 <= found.message_port <= 65535
    assert found.message_port != found.service_port
    assert found.receive_high_water_mark >= 0
