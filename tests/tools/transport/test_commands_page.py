"""docs/commands.md tells every option of the commands that bring missions to machines."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Iterator, Tuple

import pytest
from typer.main import get_command

from pursue_gen.cli.app import app

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "commands.md").read_text(encoding="utf-8")


def options(command: Any) -> Iterator[Tuple[str, ...]]:
    """Each option's spellings, of the command and of those below it; the classes are click's, or a copy of them."""
    for below in getattr(command, "commands", {}).values():
        yield from options(below)
    for parameter in command.params:
        if parameter.param_type_name == "option":
            yield tuple(parameter.opts)


@pytest.mark.parametrize("name", ["keys", "bundle", "send", "ws"])
def test_every_option_is_reported(name: str) -> None:
    whole: Any = get_command(app)
    told = list(options(whole.get_command(None, name)))
    assert len(told) > 2
    for spellings in told:
        if "--help" not in spellings:
            assert any(re.search(rf"(?<![\w-]){re.escape(one)}(?![\w-])", PAGE) for one in spellings), spellings
