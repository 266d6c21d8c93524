"""A group of commands that proposes what was meant. Newer versions of typer do so too; Debian 12's does not."""

from __future__ import annotations

from typing import Any, List, Sequence

from typer.core import TyperGroup


class Commands(TyperGroup):
    """The commands of the program, or of one of its commands."""

    def resolve_command(self, ctx: Any, args: List[str]) -> Any:
        """The command that `args` begin with, as typer has it; one that is not there ends with a proposal."""
        name = args[0]
        if not name.startswith("-") and self.get_command(ctx, name) is None:
            meant = meant_by(name, self.list_commands(ctx))
            hint = f"Did you mean '{meant}'?" if meant else f"'{ctx.command_path} -h' lists them."
            ctx.fail(f"No such command '{name}'. {hint}")
        return super().resolve_command(ctx, args)


def meant_by(word: str, commands: Sequence[str]) -> str:
    """The command that a word most likely means; the empty string: none is like it."""
    import difflib

    lower = word.lower()
    close = difflib.get_close_matches(lower, commands, n=1)
    begun = [name for name in commands if len(lower) > 1 and (name.startswith(lower) or lower.startswith(name))]
    return (close + begun + [""])[0]
