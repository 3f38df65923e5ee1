"""Print information about available plugins to the screen."""

from __future__ import annotations

import argparse

_PLUGINS = {
    "storage": {"mcap": "read and write", "sqlite3": "read and write"},
    "converter": {"cdr": "as messages are sent; there is nothing to convert to"},
    "compressor": {"zstd": "of chunks: `--storage-preset-profile zstd_fast` or `zstd_small`"},
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("plugin_type", choices=_PLUGINS, help="Type of plugin")
    parser.add_argument("--verbose", action="store_true", help="Also display what it does")


def main(arguments: argparse.Namespace) -> None:
    for name, about in _PLUGINS[arguments.plugin_type].items():
        print(f"{name}: {about}" if arguments.verbose else name)
