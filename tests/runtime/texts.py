"""Data files as texts."""

from __future__ import annotations

from typing import Any, Dict

import yaml


def read(text: str) -> Dict[str, Any]:
    """The content of a data file."""
    data: Dict[str, Any] = yaml.safe_load(text)
    return data
