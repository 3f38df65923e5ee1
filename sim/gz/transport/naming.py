"""The rules for names of topics, services, namespaces and partitions, and for fully qualified names.

`cmd_vel` in namespace `robot1` and partition `class` is `@/class@/robot1/cmd_vel`.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/TopicUtils.cc
"""

from __future__ import annotations

MAX_NAME_BYTES = 65535
_FORBIDDEN = {"~": "'~'", " ": "a space", "@": "'@'", "//": "'//'", ":=": "':='"}


def broken_rule(name: str, *, may_be_empty: bool) -> str | None:
    """Return the rule that `name` breaks, as half a sentence ("must not contain '//'"), or None if it is valid."""
    if not name and not may_be_empty:
        return "must not be empty"
    if name == "/":
        return "must not be just '/'"
    for text, shown in _FORBIDDEN.items():
        if text in name:
            return f"must not contain {shown}"
    if len(name.encode("utf-8", "surrogatepass")) > MAX_NAME_BYTES:
        return f"must not be longer than {MAX_NAME_BYTES} bytes"
    try:
        name.encode()
    except UnicodeEncodeError:
        return "must be valid Unicode text"
    return None


def is_valid_topic(name: str) -> bool:
    """Return whether `name` is valid for a topic or service."""
    return broken_rule(name, may_be_empty=False) is None


def is_valid_namespace(name: str) -> bool:
    """Return whether `name` is valid for a namespace, which may be empty."""
    return broken_rule(name, may_be_empty=True) is None


def is_valid_partition(name: str) -> bool:
    """Return whether `name` is valid for a partition, which may be empty."""
    return broken_rule(name, may_be_empty=True) is None


def check(name: str, what: str, *, may_be_empty: bool = False) -> str:
    """Return `name`. Raises ValueError with the rule it breaks; `what` is "topic", "partition", ..."""
    rule = broken_rule(name, may_be_empty=may_be_empty)
    if rule is None:
        return name
    nearest = as_valid_topic(name)
    hint = f"; {nearest!r} would be valid" if nearest else ""
    shown = name if len(name) <= 200 else name[:200] + "..."
    raise ValueError(f"The {what} name {shown!r} is not valid: it {rule}{hint}.")


def as_valid_topic(name: str) -> str:
    """Return the valid topic name nearest to `name`, or an empty text if there is none.

    Spaces become underscores; `@`, `~`, `:=` and `//` are removed.
    """
    name = name.replace(" ", "_")
    for text in ("@", "~", ":=", "//"):
        name = name.replace(text, "")
    return name if is_valid_topic(name) else ""


def fully_qualified(partition: str, namespace: str, topic: str, what: str = "topic") -> str:
    """Return the fully qualified name `@/partition@/namespace/topic`.

    A topic that starts with `/` is absolute and ignores the namespace; errors call the topic `what`. Raises ValueError
    if a part breaks a rule or the whole is longer than 65535 bytes.
    """
    check(partition, "partition", may_be_empty=True)
    check(namespace, "namespace", may_be_empty=True)
    check(topic, what)
    if partition and not partition.startswith("/"):
        partition = "/" + partition
    partition = partition.removesuffix("/")
    topic = topic.removesuffix("/")
    if not topic.startswith("/"):
        if not namespace.startswith("/"):
            namespace = "/" + namespace
        if not namespace.endswith("/"):
            namespace += "/"
        topic = namespace + topic
    name = f"@{partition}@{topic}"
    if len(name.encode()) > MAX_NAME_BYTES:
        raise ValueError(
            f"The name {name[:60]!r}... is not valid: partition, namespace and topic together "
            f"must not be longer than {MAX_NAME_BYTES} bytes."
        )
    return name


def partition_prefix(partition: str) -> str:
    """Return the prefix of all fully qualified names of a partition: `@/partition@`."""
    return fully_qualified(partition, "", "/any").removesuffix("/any")


def split(name: str) -> tuple[str, str]:
    """Return (partition without leading slash, topic) of a fully qualified name. Raises ValueError if it is none."""
    first, last = name.find("@"), name.rfind("@")
    if first != 0 or last == first or not name[last + 1 :]:
        raise ValueError(f"{name[:200]!r} is not a fully qualified name: expected '@/partition@/topic'.")
    return name[first + 1 : last].removeprefix("/"), name[last + 1 :]
