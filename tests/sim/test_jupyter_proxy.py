"""Addresses of this machine's pages, as a browser on another machine reaches them."""

import pytest

from gz_course.sim.jupyter_proxy import reachable

VIEW = "http://127.0.0.1:40123/token/"
NAMES = ("COURSE_PROXY", "JUPYTERHUB_SERVICE_PREFIX", "JUPYTERHUB_PUBLIC_URL")


@pytest.mark.parametrize(
    ("variables", "address", "expected"),
    [
        ({}, VIEW, VIEW),
        ({"COURSE_PROXY": "/"}, VIEW, "/proxy/40123/token/"),
        ({"COURSE_PROXY": "/lab-of-mine/"}, VIEW, "/lab-of-mine/proxy/40123/token/"),
        ({"JUPYTERHUB_SERVICE_PREFIX": "/user/alice/"}, VIEW + "?a=b", "/user/alice/proxy/40123/token/?a=b"),
        (
            {"JUPYTERHUB_SERVICE_PREFIX": "/user/alice/", "JUPYTERHUB_PUBLIC_URL": "https://hub.example/user/alice/"},
            VIEW,
            "https://hub.example/user/alice/proxy/40123/token/",
        ),
        ({"JUPYTERHUB_SERVICE_PREFIX": "/user/alice/"}, "http://192.0.2.7:80/token/", "http://192.0.2.7:80/token/"),
    ],
)
def test_reachable(monkeypatch, variables, address, expected):
    for name in NAMES:
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert reachable(address) == expected
