"""The Content-Security-Policy of a page that runs a program of others: whatever it asks for, it asks this machine.

The program itself is on this machine, from a wheel, so it may run as it likes (inline, `eval`, WebAssembly, workers).

Source: https://www.w3.org/TR/CSP3/
"""

from __future__ import annotations

LOOPBACK_SOURCES = "http://127.0.0.1:* http://localhost:*"
"""Servers of this machine on any port."""


def policy(connect: str = "", *more: str) -> str:
    """Return the policy of a page that asks its own server, and `connect` for data; `more` are directives."""
    own = "'self' blob: data:"
    directives = [
        f"default-src {own}",
        f"script-src {own} 'unsafe-inline' 'unsafe-eval'",
        f"style-src {own} 'unsafe-inline'",
        f"connect-src {own} {connect}".strip(),
        "form-action 'self'",
        *more,
    ]
    return "; ".join(directives)
