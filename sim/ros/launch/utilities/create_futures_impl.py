"""Futures for actions that take time."""

from __future__ import annotations

import asyncio


def create_future(loop: asyncio.AbstractEventLoop | None) -> asyncio.Future[None]:
    """Return a future of this loop, or of the running one."""
    return (loop or asyncio.get_running_loop()).create_future()
