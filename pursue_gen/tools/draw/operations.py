"""Changes that a person makes on the picture or in a form, as changes of the text.

The text that comes out is what `pursue-gen fmt` would write, with all comments and in the person's order.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple, Type

from pursue_gen.diagnostics import NOWHERE, PursueError, error
from pursue_gen.language.draft import Draft, rename
from pursue_gen.language.formatter import format_text, formatted
from pursue_gen.language.kinds import DECLARED, STATEMENTS
from pursue_gen.language.names import KINDS, reserved
from pursue_gen.language.occurrences import GROUP
from pursue_gen.language.poses import read_poses
from pursue_gen.language.rewriting import parts_in, parts_of
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.syntax import Statement
from pursue_gen.language.template import FILLINGS, Filling, Hole
from pursue_gen.language.tokens import bare
from pursue_gen.language.word import HOLE, Form
from pursue_gen.tools.draw import fields
from pursue_gen.tools.draw.fields import Values, refused
from pursue_gen.tools.draw.made import check_place, names, not_there
from pursue_gen.tools.draw.places import with_all_positions, with_position, with_spot
from pursue_gen.tools.draw.statement_edits import added, restated, with_part, without, without_remark
from pursue_gen.tools.draw.ways import connect, second_way

ANYBODY = ("any robot", "no robot", "any agent", "no agent")
"""What may stand in the place of an agent's name in some statements."""


@dataclass(frozen=True)
class Changed:
    """The text after a change, and the number of the statement that it is about (None: of none)."""

    text: str
    statement: Optional[int] = None


def change(text: str, operation: Any, file: str = "scenario.pur") -> Changed:
    """The text after an operation of the page: {"do": its name, …}.

    Raises PursueError where the text has a syntax error (DRW002), the operation makes no sense or would leave one
    (DRW001), or a name is refused.
    """
    does = _OPERATIONS.get(str(operation.get("do"))) if isinstance(operation, Mapping) else None
    if does is None:
        raise refused("the page sent a change that is not known", "load the page again")
    try:
        document = Draft.of(format_text(text, file), file)
    except PursueError as problem:
        first = problem.diagnostics[0]
        where = f" in line {first.span.line}" if first.span else ""
        message = f"the text has an error{where}: {first.message}"
        hint = "correct the text first; until then it cannot be changed in the picture"
        raise PursueError([error("DRW002", message, hint=hint)]) from None
    after, statement = does(document, operation)
    try:
        return Changed(formatted(after), statement)
    except PursueError as problem:
        first = problem.diagnostics[0]
        raise refused(f"this cannot be written: {first.message}", first.hint) from None


Done = Tuple[Draft, Optional[int]]


# Places ---------------------------------------------------------------------------------------------------------------


def _add_place(document: Draft, values: Values) -> Done:
    """{x, y, name?}: a place there; if others have computed positions, these are written down, too."""
    x, y = fields.metres_of(values, "x"), fields.metres_of(values, "y")
    name = _new_name(document, values, "place")
    document = with_all_positions(document)
    return added(document, f'poi "{name}" {with_position(None, x, y)}')


def _move_place(document: Draft, values: Values) -> Done:
    """{name, x, y, yaw?}: the place is there; `yaw` in degrees."""
    name = fields.name_of(values, "name")
    x, y = fields.metres_of(values, "x"), fields.metres_of(values, "y")
    yaw = fields.degrees_of(values, "yaw") if values.get("yaw") is not None else None
    document = with_all_positions(document)
    number = _declared(document, "POI", name)
    pose = parts_of(document.statements[number]).get("POSE")
    return with_part(document, number, "POSE", with_position(str(pose[0]) if pose else None, x, y, yaw)), number


def _move_spot(document: Draft, values: Values) -> Done:
    """{name, robot, x, y}: the robot's own spot at the place is there."""
    name, robot = fields.name_of(values, "name"), fields.name_of(values, "robot")
    x, y = fields.metres_of(values, "x"), fields.metres_of(values, "y")
    number = _declared(document, "POI", name)
    pose = parts_of(document.statements[number]).get("POSE")
    if pose is None or not read_poses(str(pose[0]), NOWHERE, [])[1]:
        raise refused(f"no robot has a spot of its own at {name}", "choose it again")
    comment = with_spot(str(pose[0]), robot, x, y)
    if comment is None:
        raise refused(f"{robot} has no spot of its own at {name}", "choose it again")
    return with_part(document, number, "POSE", comment), number


# Agents and events ----------------------------------------------------------------------------------------------------


def _add_agent(document: Draft, values: Values) -> Done:
    """{location, name?}: a robot there."""
    location = fields.name_of(values, "location")
    check_place(document, location)
    name = _new_name(document, values, "bot")
    return added(document, f'agent "{name}" controllable mobile 1 location {location}')


def _add_event(document: Draft, values: Values) -> Done:
    """{location?, name?}: an event, anywhere or there."""
    name = _new_name(document, values, "work")
    location = f" location {fields.name_of(values, 'location')}" if values.get("location") else ""
    return added(document, f'event "{name}"{location}')


def _rename(document: Draft, values: Values) -> Done:
    """{kind, name, new}: another name, wherever it is used."""
    kind, name, new = (fields.text_of(values, field) for field in ("kind", "name", "new"))
    if kind not in KINDS:
        raise refused(f"there is no {kind} {name}", "choose it again")
    number = _declared(document, kind, name)
    return document.changed(*rename(document, document.declared[kind][name].start, new)), number


def _set(document: Draft, values: Values) -> Done:
    """{statement, fields: {…}}: parts of a place, a way, an event or an agent; see _FIELDS."""
    number = fields.index_of(values, "statement", len(document.statements))
    wanted, known = values.get("fields"), _FIELDS.get(document.statements[number].kind, {})
    if not isinstance(wanted, Mapping) or not set(wanted) <= set(known):
        raise refused("the page sent a change that is not known", "load the page again")
    for field in wanted:
        for part, words in known[field](wanted, field).items():
            document = with_part(document, number, part, words)
            if part in ("DISTANCE", "DURATION"):
                document = without_remark(document, number)
    return document, number


Parts = Dict[str, Optional[str]]
"""The word that begins a part of a statement → what stands behind it; None: it is left out."""


def _field(hole: Hole, behind: str) -> Callable[[Values, str], Parts]:
    """The field of what fills a hole of a template: it is left out where it is empty. `behind`: the words behind it."""
    part, filling = hole.begins, hole.filling
    if filling.rule == part:  # a flag
        return lambda values, field: {part: "" if fields.is_set(values, field) else None}
    if filling == FILLINGS["events"]:
        return lambda values, field: {part: ", ".join(fields.names_of(values, field)) or None}
    read = fields.name_of if filling.rule in ("ref", "counted") else _READ.get(filling, fields.text_of)
    return lambda values, field: {part: read(values, field) + behind if values.get(field) else None}


_READ: Mapping[Filling, Callable[[Values, str], str]] = {
    FILLINGS["name"]: fields.label_of,
    FILLINGS["window"]: fields.window_of,
    FILLINGS["metres"]: fields.length_of,
    FILLINGS["count"]: fields.number_of,
}
"""What reads a field, by what fills its hole."""


def _optional(kind: Type[StatementKind]) -> Dict[str, Callable[[Values, str], Parts]]:
    """The fields of all that may be left out in a statement."""
    pieces = [(piece.holes[0], piece.text.partition("{}")[2]) for piece in kind.template.pieces if piece.optional]
    names = {"split": "parts"}
    wanted = ((hole.fields[0], hole, behind) for hole, behind in pieces if hole.fields[0] not in kind.aside)
    return {names.get(field, field): _field(hole, behind) for field, hole, behind in wanted}


def _needed(part: str, read: Callable[[Values, str], str]) -> Callable[[Values, str], Parts]:
    return lambda values, field: {part: read(values, field)}


def _kind(values: Values, field: str) -> Parts:
    kinds: Dict[str, Parts] = {
        "robot": {"HUMAN": None, "CONTROLLABLE": ""},
        "person": {"HUMAN": "", "CONTROLLABLE": ""},
        "free": {"HUMAN": None, "CONTROLLABLE": None},
    }
    value = fields.text_of(values, field)
    if value not in kinds:
        raise refused(f"{field} is '{value}'", f"expected {', '.join(kinds)}")
    return kinds[value]


def _pace(part: str, other: str) -> Callable[[Values, str], Parts]:
    """How fast an agent is, said in one of two ways."""
    return lambda values, field: (
        {part: fields.number_of(values, field), other: None} if values.get(field) else {part: None}
    )


_FIELDS: Mapping[str, Mapping[str, Callable[[Values, str], Parts]]] = {
    "POI": _optional(STATEMENTS["POI"]),
    "CONNECT": {**_optional(STATEMENTS["CONNECT"]), "distance": _needed("DISTANCE", fields.length_of)},
    "EVENT": _optional(STATEMENTS["EVENT"]),
    "AGENT": {
        **_optional(STATEMENTS["AGENT"]),
        "kind": _kind,
        "mobile": _pace("MOBILE", "SPEED"),
        "speed": _pace("SPEED", "MOBILE"),
        "location": _needed("LOCATION", fields.name_of),
    },
}
"""The fields of each kind of statement, and the parts that they are."""


# All other statements -------------------------------------------------------------------------------------------------


def _add_form(document: Draft, values: Values) -> Done:
    """{kind, form, values: […]}: one of the forms of a statement, its holes filled in order."""
    kind = fields.text_of(values, "kind")
    if kind not in STATEMENTS:
        raise refused(f"there is no statement {kind}", "load the page again")
    forms = STATEMENTS[kind].forms
    form = forms[fields.index_of(values, "form", len(forms))]
    return added(document, filled(form, values.get("values")))


def filled(form: Form, given: Any) -> str:
    """The words of a form with values in its holes. Raises PursueError where they do not fit."""
    holes = HOLE.findall(form.words)
    if not isinstance(given, list) or len(given) != len(holes):
        raise refused("not everything is filled in", "choose something in each field")
    words = form.words
    for (example, what), value in zip(holes, given):
        field = {"value": value}
        is_number = bool(example) and what.replace(".", "").isdigit()
        if is_number:
            text = fields.measure_of(field, "value")
        elif what == "agent" and value in ANYBODY:
            text = str(value)
        else:
            text = fields.name_of(field, "value")
        words = HOLE.sub(text, words, count=1)  # names and numbers: nothing in them means something to sub
    return words


def _restate(document: Draft, values: Values) -> Done:
    """{statement, words}: other words for a statement."""
    number = fields.index_of(values, "statement", len(document.statements))
    words = fields.text_of(values, "words")
    if parts_in(document.statements[number].kind):
        raise refused("this statement has a form of its own", "load the page again")
    alone = Draft.of(words, document.file).statements
    if len(alone) != 1 or not words:
        raise refused("expected the words of one statement", "add others on their own")
    return restated(document, number, words), number


def _delete(document: Draft, values: Values) -> Done:
    """{statement}: without it; a place goes with its ways, an agent with its travel times and its battery."""
    number = fields.index_of(values, "statement", len(document.statements))
    statement = document.statements[number]
    goes_along = {"POI": ("CONNECT", "TRAVEL"), "AGENT": ("TRAVEL", "BATTERY")}.get(statement.kind, ())
    using = [use for use in _users(document, number) if document.statements[use].kind not in goes_along]
    if using:
        name = _declares(statement)[1]
        lines = [str(document.lines.of(document.statements[use].start) + 1) for use in using]
        where = f"line{'s' if len(lines) > 1 else ''} {', '.join(lines)}"
        raise refused(f"{name} is used in {where}", "change or delete what uses it first")
    numbers = [number, *_users(document, number)]
    following = number + 1
    if following < len(document.statements) and document.statements[following].kind == "TAIL":
        numbers.append(following)  # the query behind an objective
    return without(document, sorted(set(numbers))), None


def _users(document: Draft, number: int) -> List[int]:
    """The other statements that use the name which a statement declares."""
    kind, name = _declares(document.statements[number])
    others = (use for use in document.occurrences if use.name == name and use.kind == kind and not use.declares)
    return sorted({use.statement for use in others} - {number}) if name else []


def _declares(statement: Statement) -> Tuple[Optional[str], str]:
    """The kind of thing that a statement declares, and its name; "" where it declares nothing."""
    if statement.kind == "GROUP":
        return GROUP, bare(statement.first("NAME"))
    return DECLARED.get(statement.kind), bare(statement.name)


def _format(document: Draft, _: Values) -> Done:
    """{}: the layout alone."""
    return document, None


def _declared(document: Draft, kind: str, name: str) -> int:
    """The number of the statement that declares a name. Raises PursueError where none does."""
    found = document.declared[kind].get(name)
    if found is None:
        raise not_there(document, kind, name)
    return found.statement


def _new_name(document: Draft, values: Values, stem: str) -> str:
    """The name that was typed, or else one that is free."""
    taken = {name for kind in (*KINDS, GROUP) for name in names(document, kind)}
    if not values.get("name"):
        return next(f"{stem}{number}" for number in count(1) if f"{stem}{number}" not in taken)
    name = fields.name_of(values, "name")
    why = reserved(name) or (f"{name} is taken" if name in taken else "")
    if why:
        raise refused(why, "choose another name")
    return name


_OPERATIONS: Mapping[str, Callable[[Draft, Values], Done]] = {
    "add place": _add_place,
    "move place": _move_place,
    "move spot": _move_spot,
    "connect": connect,
    "second way": second_way,
    "add agent": _add_agent,
    "add event": _add_event,
    "rename": _rename,
    "set": _set,
    "add form": _add_form,
    "restate": _restate,
    "delete": _delete,
    "format": _format,
}
"""What the page can send: the name of an operation → what makes it; their docstrings have the values."""
