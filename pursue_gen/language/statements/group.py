"""`group "rooms": room1, room2`: things of one kind under one name, which `language.groups` writes out."""

from __future__ import annotations

from typing import Any

from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import FILLINGS, Filling, Template
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


def _nothing(reader: TreeReader, tree: Any) -> None:
    """Nothing is read of it."""


class _WrittenOut(StatementKind):
    """A kind of statement of which nothing is read: other statements come of it before."""

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Any:
        return ()


class Group(_WrittenOut):
    """Things of one kind. Statements that name it are written out before they are read."""

    own_words = (Word("group", "Several of one kind under one name: places, agents, events, states or things.", True),)
    template = Template(
        'group {name="rooms"}: {members=room1, room2}', members=FILLINGS["POIs"]._replace(behind=("group",))
    )
    forms = (Form("things under one name", 'group "{=rooms}": {POI}'),)


class ForEach(_WrittenOut):
    """A statement for each member of a group: what is read are the statements that `language.groups` makes of it."""

    own_words = (
        Word("for", "A statement for each of a group; a rule for each robot or agent; a way or place for these only."),
        Word("except", "A way, or a place, for all but these agents.", True),
        Word("each", "Every member of a group; in a rule every robot or agent, and each has its own turn.", True),
        Word("two", "Every pair of a group once.", True),
        Word("of", "The one that belongs to a member: call of room1 is call_room1.", True),
        Word("all", "Every member: all of a group.", True),
        Word("none", "Not one member: none of a group.", True),
        Word("robots", "All agents that are controllable and not human: a group that needs no declaration.", True),
    )
    template = Template(
        'for each {ranges:ranges=r in rooms}: {statement:statement=event "call" of r}',
        ranges=Filling(
            '(TWO (ROBOTS WORD "," WORD | WORD "," WORD "in" ref) | _range ("," _range)*)',
            _nothing,
            rules='_range: WORD "in" ref | ROBOT WORD',
        ),
        statement=Filling("_each", _nothing),
    )
    note = (
        "or any other statement; for each two a, b in rooms: every pair; for each robot r, for each two robots a, b"
    )
    forms = (
        Form("an event for each of a group", 'for each {=r} in {group}: event "{=call}" of {=r} location {=r}'),
        Form("an objective for each two robots", "for each two robots {=x}, {=y}: objective: {=x} never_with {=y}"),
    )
