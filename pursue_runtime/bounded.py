"""The one reader of JSON and YAML: whatever a text holds, it is read within bounds, or refused with the reason.

Size, depth and the number of values are bounded before anything is built of the text. Refused are keys that stand
twice, numbers that are not finite, and whole numbers that do not fit 64 bits. YAML is read as the data that JSON has:
anchors, aliases and tags are refused, and what only YAML takes for a number or a date (`1:30`, `010`, `0x1f`, `.nan`,
`1999-12-31`) is text.
"""

from __future__ import annotations

import json
import math
import re
from functools import lru_cache
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, NoReturn, Optional, Tuple, Union

import yaml

from pursue_runtime.needs import PYYAML, require
from pursue_runtime.numbers import quoted, whole

require(PYYAML)


class Bounds(NamedTuple):
    """What a text may hold: bytes, levels that are nested in each other, values."""

    size: int
    depth: int
    values: int


DATA = Bounds(64 * 2**20, 64, 4_000_000)
"""For what programs write: data files, plans, requests and answers."""
SETTINGS = Bounds(2**20, 16, 30_000)
"""For what people write: robots.yaml, machines.yaml, poses.yaml, traces."""


class BadText(ValueError):
    """A text is refused: `reason` is why; `line` and `column` are where, from 1 on, or 0 where that is not known."""

    def __init__(self, reason: str, line: int = 0, column: int = 0) -> None:
        super().__init__(f"line {line}, column {column}: {reason}" if line else reason)
        self.reason, self.line, self.column = reason, line, column


# JSON -----------------------------------------------------------------------------------------------------------------

_MARK = re.compile(r'\\.|["\[\]{}]', re.DOTALL)
_NO_BRACKETS = re.compile(r"[^\[\]{}]+")
_HALF = re.compile(r"\\u[dD][89a-fA-F]")


def read_json(content: Union[str, bytes], bounds: Bounds = DATA) -> Any:
    """The value in a JSON text (bytes: in UTF-8). Raises BadText."""
    text = _text(content, bounds)
    _check_depth(text, bounds.depth)
    if text.count(",") >= bounds.values:
        raise BadText(_too_many(bounds))
    hooks: Dict[str, Any] = {"parse_int": whole, "parse_float": _finite, "parse_constant": _not_finite}
    try:
        value = json.loads(text, object_pairs_hook=_once, **hooks)
        if _HALF.search(text):  # two halves make one character, one alone cannot be written anywhere
            json.dumps(value, ensure_ascii=False).encode("utf-8")
    except json.JSONDecodeError as problem:
        raise BadText(f"this is not JSON: {problem.msg}", problem.lineno, problem.colno) from None
    except (ValueError, RecursionError) as problem:
        raise BadText(_reason(problem)) from None
    return value


def json_object(content: Union[str, bytes], bounds: Bounds = DATA) -> Optional[Dict[str, Any]]:
    """The object in a JSON text; None for anything else."""
    try:
        value = read_json(content, bounds)
    except BadText:
        return None
    return value if isinstance(value, dict) else None


def _text(content: Union[str, bytes], bounds: Bounds) -> str:
    """The content as text. Raises BadText where it is too large, or not UTF-8."""
    try:
        size = len(content.encode("utf-8") if isinstance(content, str) else content)
        if size > bounds.size:
            raise BadText(f"it has {size} bytes; at most {bounds.size} are read")
        return content if isinstance(content, str) else content.decode("utf-8")
    except UnicodeError as problem:
        raise BadText(_reason(problem)) from None


def _check_depth(text: str, most: int) -> None:
    """Raises BadText where more brackets than that are open at once; no value is built for that."""
    if text.count("[") + text.count("{") <= most:
        return
    outside = "".join(text.replace("\\\\", "").replace('\\"', "").split('"')[::2])  # of strings
    brackets = _NO_BRACKETS.sub("", outside).replace("{", "[").replace("}", "]")
    for _ in range(most):
        brackets = brackets.replace("[]", "")
    if brackets:  # too deep, or not closed
        _find_depth(text, most)


def _find_depth(text: str, most: int) -> None:
    """Raises BadText at the bracket that is one too many."""
    depth, inside = 0, False
    for match in _MARK.finditer(text):
        mark = match.group()
        if mark == '"':
            inside = not inside
        elif inside or mark[0] == "\\":
            continue
        elif mark in "]}":
            depth -= 1
        elif depth == most:
            line_start = text.rfind("\n", 0, match.start())
            raise BadText(_too_deep(most), text.count("\n", 0, match.start()) + 1, match.start() - line_start)
        else:
            depth += 1


def _once(pairs: List[Tuple[Any, Any]]) -> Dict[Any, Any]:
    """The pairs as a dictionary. Raises ValueError where a key stands twice."""
    found: Dict[Any, Any] = {}
    for key, value in pairs:
        if key in found:
            raise ValueError(f"the key {quoted(str(key))} stands twice")
        found[key] = value
    return found


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{quoted(text)} is too large for a number")
    return value


def _not_finite(text: str) -> NoReturn:
    raise ValueError(f"{text} is not a number")


def _too_deep(most: int) -> str:
    return f"more than {most} levels are nested in each other"


def _too_many(bounds: Bounds) -> str:
    return f"it may hold {bounds.values} values at most"


def _reason(problem: Exception) -> str:
    """Why a library has refused a text, in one line."""
    if isinstance(problem, UnicodeDecodeError):
        return f"it is not text in UTF-8 (byte {problem.start + 1})"
    if isinstance(problem, UnicodeEncodeError):
        return "it holds half of a character"
    if isinstance(problem, RecursionError):
        return "it is nested too deeply"
    reason = getattr(problem, "problem", None) or getattr(problem, "reason", None) or str(problem).split("\n")[0]
    return str(reason)[:200]


# YAML -----------------------------------------------------------------------------------------------------------------

_FORMS = (
    ("null", re.compile(r"~|null|Null|NULL|")),
    ("bool", re.compile(r"[Yy]es|YES|[Nn]o|NO|[Tt]rue|TRUE|[Ff]alse|FALSE|[Oo]n|ON|[Oo]ff|OFF")),
    ("int", re.compile(r"[-+]?(?:0|[1-9][0-9]*)")),
    ("float", re.compile(r"(?:[-+]?[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][-+][0-9]+)?")),
)
"""How scalars without quotes stand for values: what YAML 1.1 and JSON have in common."""
_FIRST = frozenset("~nNyYtTfFoO-+.0123456789")
Make = Callable[[Any, Iterator[Any]], Any]
"""Makes something of an event and those that belong to it."""

_TRUE = ("yes", "true", "on")
_TAG = "tag:yaml.org,2002:"
_ENDS = (yaml.SequenceEndEvent, yaml.MappingEndEvent)


def read_yaml(content: Union[str, bytes], bounds: Bounds = DATA) -> Any:
    """The value in a YAML text (bytes: in UTF-8), None in an empty one. Raises BadText."""
    # The C parser is many times faster; it is missing where PyYAML was built without libyaml.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return _document(_value, _events(_text(content, bounds), loader, bounds))


def yaml_tree(text: str, bounds: Bounds = SETTINGS) -> Any:
    """The text as PyYAML's tree of nodes, None for an empty text. Raises BadText.

    Nodes know their places. Keys may stand twice in it: whoever reads it can say where both are.
    """
    # Always PyYAML's own parser: its messages are the same on every machine.
    return _document(_node, _events(_text(text, bounds), yaml.SafeLoader, bounds))


def node_value(node: Any) -> Any:
    """The value of a node of `yaml_tree`. Raises BadText where a key stands twice."""
    if isinstance(node, yaml.ScalarNode):
        try:
            return _scalar(node.value) if node.style is None else node.value
        except ValueError as problem:
            raise _refused(str(problem), node) from None
    if isinstance(node, yaml.SequenceNode):
        return [node_value(item) for item in node.value]
    return _mapping([node_value(part) for pair in node.value for part in pair], node)


def _events(text: str, loader: Any, bounds: Bounds) -> Iterator[Any]:
    """PyYAML's events of the one document in the text, within the bounds. Raises BadText."""
    depth = count = documents = 0
    try:
        event: Any  # PyYAML's stubs know too little of them
        for event in yaml.parse(text, Loader=loader):
            kind = type(event)
            if kind in (yaml.StreamStartEvent, yaml.StreamEndEvent, yaml.DocumentEndEvent):
                continue
            if kind is yaml.DocumentStartEvent:
                documents += 1
                if documents > 1:
                    raise _refused("expected one document; here begins another one", event)
                continue
            if kind in _ENDS:
                depth -= 1
            else:
                count += 1
                if count > bounds.values:
                    raise _refused(_too_many(bounds), event)
                if event.anchor is not None:
                    raise _refused("anchors (&name) and aliases (*name) are not read: write the value itself", event)
                if event.tag is not None:
                    raise _refused(f"tags are not read: write the value without {quoted(event.tag)}", event)
                if kind is not yaml.ScalarEvent:
                    depth += 1
                    if depth > bounds.depth:
                        raise _refused(_too_deep(bounds.depth), event)
                elif not event.value.isascii():
                    event.value.encode("utf-8")  # half of a character ends here
            yield event
    except BadText:
        raise
    except (yaml.YAMLError, ValueError, RecursionError) as problem:
        mark = getattr(problem, "problem_mark", None) or getattr(problem, "context_mark", None)
        place = (mark.line + 1, mark.column + 1) if mark else ()
        raise BadText(f"this is not YAML: {_reason(problem)}", *place) from None


def _refused(reason: str, what: Any) -> BadText:
    """The error at the place of an event or a node."""
    return BadText(reason, what.start_mark.line + 1, what.start_mark.column + 1)


def _document(make: Make, events: Iterator[Any]) -> Any:
    """What `make` makes of all the events, None where there are none."""
    first = next(events, None)
    made = None if first is None else make(first, events)
    assert next(events, None) is None, "a document is one value"
    return made


def _value(event: Any, events: Iterator[Any]) -> Any:
    """The value that begins with this event."""
    if type(event) is yaml.ScalarEvent:
        try:
            return _scalar(event.value) if event.implicit[0] else event.value
        except ValueError as problem:
            raise _refused(str(problem), event) from None
    parts, _ = _parts(_value, events)
    return parts if type(event) is yaml.SequenceStartEvent else _mapping(parts, event)


def _node(event: Any, events: Iterator[Any]) -> Any:
    """The node that begins with this event."""
    start = event.start_mark
    if type(event) is yaml.ScalarEvent:
        kind = _kind(event.value) if event.implicit[0] else "str"
        return yaml.ScalarNode(_TAG + kind, event.value, start, event.end_mark, event.style)  # type: ignore[arg-type]
    parts, end = _parts(_node, events)
    if type(event) is yaml.SequenceStartEvent:
        return yaml.SequenceNode(_TAG + "seq", parts, start, end, event.flow_style)
    pairs = list(zip(parts[::2], parts[1::2]))
    return yaml.MappingNode(_TAG + "map", pairs, start, end, event.flow_style)


def _parts(make: Make, events: Iterator[Any]) -> Tuple[List[Any], Any]:
    """What `make` makes of each part of a list or a mapping (key, value, key, value ...), and where that ends."""
    parts: List[Any] = []
    for event in events:
        if type(event) in _ENDS:
            return parts, event.end_mark
        parts.append(make(event, events))
    raise AssertionError("PyYAML ends every list and mapping")


def _mapping(parts: List[Any], what: Any) -> Dict[Any, Any]:
    """The mapping of these keys and values, whose event or node is `what`. Raises BadText."""
    pairs = list(zip(parts[::2], parts[1::2]))
    if any(isinstance(key, (dict, list)) for key, _ in pairs):
        raise _refused("a key is one word, not a list or a mapping", what)
    try:
        return _once(pairs)
    except ValueError as problem:
        raise _refused(str(problem), what) from None


def _kind(text: str) -> str:
    """What a scalar without quotes is: null, bool, int, float or str."""
    if text and text[0] not in _FIRST:
        return "str"
    return next((kind for kind, form in _FORMS if form.fullmatch(text)), "str")


def _scalar(text: str) -> Union[bool, int, float, str, None]:
    """The value of a scalar without quotes. Raises ValueError for a number that is too large."""
    return _short_scalar(text) if len(text) <= _SHORT else _typed(text)


_SHORT = 40  # letters: of texts with no more the values are kept


@lru_cache(maxsize=8192)
def _short_scalar(text: str) -> Union[bool, int, float, str, None]:
    return _typed(text)


def _typed(text: str) -> Union[bool, int, float, str, None]:
    kind = _kind(text)
    if kind == "null":
        return None
    if kind == "bool":
        return text.lower() in _TRUE
    if kind == "int":
        return whole(text)
    return _finite(text) if kind == "float" else text
