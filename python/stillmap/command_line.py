# SPDX-License-Identifier: Apache-2.0
"""Keyword arguments as the options of a command line."""
from __future__ import annotations

import os
from typing import Mapping, Union

from . import _core

Path = Union[str, "os.PathLike[str]"]
Setting = Union[bool, int, float, str]


def options_of(values: Mapping[str, object]) -> list[str]:
    """`some_name=value` as `--some-name value`; True is a flag, False and None are left out."""
    options: list[str] = []
    for name, value in values.items():
        if value is None or value is False:
            continue
        options.append("--" + name.replace("_", "-"))
        if value is not True:
            options.append(os.fspath(value) if isinstance(value, os.PathLike) else str(value))
    return options


def settings_options(settings: Mapping[str, Setting] | None) -> list[str]:
    """Settings as `--set key=value`."""
    options: list[str] = []
    for key, value in (settings or {}).items():
        text = str(value).lower() if isinstance(value, bool) else str(value)
        options += ["--set", f"{key}={text}"]
    return options


def run_command(command: str, folder: Path, options: list[str]) -> int:
    """Runs a command of the program on a folder; gives its exit code."""
    # What begins with a dash is taken for an option.
    place = os.fspath(folder)
    return _core.run_command([command, f"./{place}" if place.startswith("-") else place, *options])
