"""Data files as texts."""

from __future__ import annotations

from typing import Any, Dict, Union

import yaml

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # the one in C is many times as quick; not every PyYAML has it


def read(text: Union[str, bytes]) -> Dict[str, Any]:
    """The content of a data file."""
    data: Dict[str, Any] = yaml.load(text, LOADER)
    return data
