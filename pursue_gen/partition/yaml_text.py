"""Data as YAML that people can follow: the writer of the data files of a workspace.

Any reader of YAML 1.1 finds in the text what was written. The bytes do not depend on whether PyYAML was built with
libyaml, as long as no key is empty, contains a line break, or has more than 100 letters.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Dict, Iterator, List, Mapping, Sequence, Union

import yaml

EMITTER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
"""libyaml's emitter, many times faster; the one in Python where PyYAML was built without it."""

_READABLE = re.compile(r"[\n -~\xa1-\u2027\u2030-\ud7ff\uff00-\uffef]*")
"""Texts that may stand as they are; others are escaped, since the two emitters differ in when they would do so."""
_OPEN = ("\n", "\n\n")
"""How texts end that libyaml closes with a mark of its own if they are blocks."""
_RESOLVER: Any = yaml.resolver.Resolver()
_WIDTH = 1_000_000
"""Columns of the longest line: nothing is folded, a key and its value share one line."""


class _InlineMap(Dict[str, Any]):
    """A map in one line."""


class _InlineList(List[Any]):
    """A list in one line."""


def inline(value: Union[Mapping[str, Any], Sequence[Any]]) -> Any:
    """The same map or list, to be written in one line with all that is in it; it is equal to the value."""
    return _InlineMap(value) if isinstance(value, Mapping) else _InlineList(value)


def yaml_text(data: Union[Mapping[str, Any], Sequence[Any]], head: Sequence[str] = (), emitter: Any = EMITTER) -> str:
    """The data as a YAML document, one key or item a line in their order, below comments with the lines of `head`.

    `data` holds maps with texts as keys, lists, texts, numbers, Booleans and None; what is `inline` stands in one line.
    """
    comments = "".join(f"# {line}\n" for line in head)
    start = [yaml.StreamStartEvent(), yaml.DocumentStartEvent(explicit=False)]
    end = [yaml.DocumentEndEvent(explicit=False), yaml.StreamEndEvent()]
    text: str = yaml.emit([*start, *_events(data), *end], Dumper=emitter, width=_WIDTH, allow_unicode=True)
    return comments + text


def _events(value: Any) -> Iterator[yaml.Event]:
    """What the emitter is to write for the value."""
    flow = isinstance(value, (_InlineMap, _InlineList))
    if isinstance(value, dict):
        yield yaml.MappingStartEvent(None, None, True, flow_style=flow)
        for key, part in value.items():
            yield _scalar(key)
            yield from _events(part)
        yield yaml.MappingEndEvent()
    elif isinstance(value, list):
        yield yaml.SequenceStartEvent(None, None, True, flow_style=flow)
        for part in value:
            yield from _events(part)
        yield yaml.SequenceEndEvent()
    else:
        yield _scalar(value)


def _scalar(value: Union[str, int, float, bool, None]) -> yaml.Event:
    if isinstance(value, str):
        return _text(str(value))  # a symbol is one, which libyaml does not know
    node = yaml.representer.SafeRepresenter().represent_data(value)
    return yaml.ScalarEvent(None, None, (True, False), node.value)


@lru_cache(maxsize=4096)
def _text(value: str) -> yaml.Event:
    """The text: a block where it has several lines, in quotes where PyYAML would read something else without."""
    style = "|" if "\n" in value else None
    if not _READABLE.fullmatch(value) or value[-2:] in _OPEN:
        style = '"'
    plain = _RESOLVER.resolve(yaml.ScalarNode, value, (True, False)) == "tag:yaml.org,2002:str"
    return yaml.ScalarEvent(None, None, (plain, True), value, style=style)
