"""Namespaces as text."""

from __future__ import annotations


def is_namespace_absolute(namespace: str) -> bool:
    return namespace.startswith("/")


def is_root_namespace(namespace: str) -> bool:
    return namespace == "/"


def make_namespace_absolute(namespace: str | None) -> str | None:
    """Return a namespace with a / before it; None stays None."""
    if namespace is None or is_namespace_absolute(namespace):
        return namespace
    return f"/{namespace}"


def prefix_namespace(base: str | None, namespace: str | None) -> str | None:
    """Return a namespace below `base`; an absolute one stays as it is, and None is `base`."""
    if namespace is None or base is None:
        return base if namespace is None else namespace
    if is_namespace_absolute(namespace) or not base:
        return namespace
    return f"{base.rstrip('/')}/{namespace}".rstrip("/") or "/"
