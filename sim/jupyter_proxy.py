"""The address under which a browser on another machine reaches a page of this one: through jupyter-server-proxy.

On a JupyterHub, on Binder and in a container only Jupyter's port is reachable. The variable COURSE_PROXY is then the
path of that Jupyter server, such as `/`; JupyterHub and Binder say it themselves, in JUPYTERHUB_SERVICE_PREFIX. There
the address is a path without a host, which a notebook's page and a frame in it complete; a hub that knows its public
address (JUPYTERHUB_PUBLIC_URL) completes it here.

Source: jupyter-server-proxy, "Accessing arbitrary ports or hosts",
https://jupyter-server-proxy.readthedocs.io/en/latest/arbitrary-ports-hosts.html
Source: JupyterHub, "Environment variables of a single-user server",
https://jupyterhub.readthedocs.io/en/stable/reference/spawners.html
"""

from __future__ import annotations

import os
from urllib.parse import urlsplit

LOOPBACK = {"127.0.0.1", "localhost", "::1"}


def is_between() -> bool:
    """Return whether a proxy is between this machine and the user's browser."""
    return bool(_server())


def reachable(address: str) -> str:
    """Return the address of a page of this machine as the user's browser reaches it; without a proxy it is the same."""
    parts = urlsplit(address)
    if not is_between() or parts.hostname not in LOOPBACK:
        return address
    base = os.environ.get("JUPYTERHUB_PUBLIC_URL") or f"/{_server().strip('/')}"
    path = f"{base.rstrip('/')}/proxy/{parts.port}{parts.path}"
    return f"{path}?{parts.query}" if parts.query else path


def _server() -> str:
    """Return the path of the Jupyter server, empty without a proxy."""
    return os.environ.get("COURSE_PROXY") or os.environ.get("JUPYTERHUB_SERVICE_PREFIX", "")
