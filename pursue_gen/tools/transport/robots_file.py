"""The file that says where the robots listen (robots.yaml), read with a place for every error."""

from __future__ import annotations

import re
import ssl
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, Span, error
from pursue_gen.files import compose_yaml, read_text, reason_of, span_of
from pursue_gen.language.similar import closest
from pursue_gen.tools.transport.client import PORT, Robot, plain
from pursue_runtime.named_files import read_all

FORMAT = 1
TIMEOUT = 5.0
"""Seconds that a robot may take for an answer, by default."""

_LONGEST = 3600.0
_LARGEST = 10**6
"""Letters of the file; robots are few."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,99}", re.ASCII)
_HOST = re.compile(r"[A-Za-z0-9_]([A-Za-z0-9_.-]{0,251}[A-Za-z0-9_])?|[0-9A-Fa-f:.]{2,45}", re.ASCII)
_STRING, _INTEGER, _BOOLEAN = "tag:yaml.org,2002:str", "tag:yaml.org,2002:int", "tag:yaml.org,2002:bool"
_NULL, _FLOAT = "tag:yaml.org,2002:null", "tag:yaml.org,2002:float"
_EXAMPLE = "robots:, and below it lines such as   bot1: {host: bot1.local}"

Entries = Dict[str, Tuple[Any, Any]]
"""Key → its node and its value's."""


def read_robots(file: Path) -> Tuple[Robot, ...]:
    """The robots of a file, in its order. Raises PursueError (exit status 2)."""
    text = read_text(file, "a file of robots, such as robots.yaml")
    hint = f"write {_EXAMPLE}"
    if len(text) > _LARGEST:
        raise PursueError([error("TRN021", f"{file} has more than {_LARGEST} letters", hint=hint)])
    reader = _RobotsReader(file)
    robots = reader.robots(compose_yaml(text, str(file), "TRN021", hint))
    if reader.findings:
        raise PursueError(reader.findings)
    return robots


def chosen(robots: Sequence[Robot], names: str, file: Path) -> Tuple[Robot, ...]:
    """Those of the robots that are named, with commas between, in the file's order. Raises PursueError."""
    known = [robot.name for robot in robots]
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    wrong = [name for name in wanted if name not in known]
    if wrong or not wanted:
        message = f"{file} has no robot {wrong[0]}" if wrong else "--only names no robot"
        raise PursueError([error("TRN025", message, hint=_meant(wrong[0] if wrong else "", known))])
    return tuple(robot for robot in robots if robot.name in wanted)


class _RobotsReader:
    """Goes through the tree and collects what is wrong."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self.findings: List[Diagnostic] = []

    def robots(self, root: Any) -> Tuple[Robot, ...]:
        """All of the file."""
        entries = self._entries(root, ("format", "robots", "timeout"), "the file")
        if root is None or "robots" not in entries:
            self._wrong("TRN022", "no robots are listed", root, f"write {_EXAMPLE}")
            return ()
        self._check_format(root, entries)
        timeout = TIMEOUT
        if "timeout" in entries:
            timeout = self._seconds(entries["timeout"][1])
        listed = self._entries(entries["robots"][1], None, "robots")
        if not listed and not self.findings:
            self._wrong("TRN022", "no robots are listed", entries["robots"][1], f"write {_EXAMPLE}")
        robots = [self._robot(name, key, value, timeout) for name, (key, value) in listed.items()]
        self._check_addresses(robots, listed)
        return tuple(robots)

    def _check_format(self, root: Any, entries: Entries) -> None:
        if "format" not in entries:
            self._wrong("TRN023", "the file does not say its format", root, f"begin it with   format: {FORMAT}")
        elif self._value(entries["format"][1], _INTEGER) != str(FORMAT):
            self._wrong("TRN023", "a format that is not known", entries["format"][1], f"write   format: {FORMAT}")

    def _check_addresses(self, robots: Sequence[Robot], listed: Entries) -> None:
        seen: Dict[Tuple[str, int], str] = {}
        for robot in robots:
            first = seen.setdefault((robot.host.lower(), robot.port), robot.name)
            if first != robot.name and robot.host:
                message = f"{robot.name} has the address of {first}"
                self._wrong("TRN024", message, listed[robot.name][1], "give each its own host or port")

    def _robot(self, name: str, key: Any, value: Any, timeout: float) -> Robot:
        if not _NAME.fullmatch(name):
            hint = "a letter, then letters, digits and _, such as bot1"
            self._wrong("TRN022", f"not a robot's name: {plain(name)[:40]}", key, hint)
        entries = self._entries(value, ("host", "port", "tls", "ca"), f"robot {name}")
        if "host" not in entries and not any(finding.span == self._span(value) for finding in self.findings):
            self._wrong("TRN022", f"robot {name} has no host", value, "write   host: and its name or number")
        host = self._word(entries, "host", _STRING, _HOST.fullmatch, "a machine's name or number, such as bot1.local")
        port = self._word(entries, "port", _INTEGER, _is_port, "a whole number from 1 to 65535")
        tls = self._word(entries, "tls", _BOOLEAN, _is_boolean, "true or false") in ("true", "yes", "on")
        return Robot(name, host, int(port or PORT), tls, self._certificate(entries, tls), timeout)

    def _certificate(self, entries: Entries, tls: bool) -> Optional[Path]:
        """The file of `ca`, beside robots.yaml where its name is relative."""
        name = self._word(entries, "ca", _STRING, bool, "the name of a file with a certificate (PEM)")
        if not name:
            return None
        if not tls:
            self._wrong("TRN022", "a certificate without TLS", entries["ca"][0], "add   tls: true")
        place = self._file.parent / name
        try:
            read_all(place)  # OpenSSL would wait for a pipe
            ssl.create_default_context(cafile=str(place))
        except (OSError, ValueError) as problem:
            why = "there is no certificate in it" if isinstance(problem, ssl.SSLError) else reason_of(problem)
            message = f"the certificate {plain(str(place))} cannot be used: {why}"
            self._wrong("TRN026", message, entries["ca"][1], "name a file in PEM, which begins with -----BEGIN")
        return place

    def _seconds(self, node: Any) -> float:
        text = self._value(node, _INTEGER) or self._value(node, _FLOAT)
        try:
            seconds = float(text or "")
        except ValueError:
            seconds = 0.0
        if not 0 < seconds <= _LONGEST:
            self._wrong("TRN022", "not a time", node, "seconds, such as 5: how long a robot may take for an answer")
            return TIMEOUT
        return seconds

    def _word(self, entries: Entries, key: str, tag: str, good: Callable[[str], object], expected: str) -> str:
        """The text of a value where it is as expected, else "" """
        if key not in entries:
            return ""
        text = self._value(entries[key][1], tag)
        if text is None or not good(text):
            self._wrong("TRN022", f"{key} is not as it should be", entries[key][1], expected)
            return ""
        return text.lower() if tag == _BOOLEAN else text

    def _value(self, node: Any, tag: str) -> Optional[str]:
        """A scalar's text, None where it is something else."""
        return str(node.value) if node.tag == tag and isinstance(node.value, str) else None

    def _entries(self, node: Any, known: Optional[Sequence[str]], what: str) -> Entries:
        """A mapping's entries; raises for all wrong keys together."""
        if node is None or node.tag == _NULL:
            return {}
        if not isinstance(node.value, list) or not node.tag.endswith(":map"):
            hint = "{host: bot1.local}" if what.startswith("robot ") else _EXAMPLE
            self._wrong("TRN022", f"{what} has no lines of the form key: value", node, f"write {hint}")
            return {}
        entries: Entries = {}
        for key, value in node.value:
            name = key.value if isinstance(key.value, str) else ""
            if name in entries:
                first = entries[name][0].start_mark.line + 1
                message = f"{plain(name)[:40]} stands twice in {what}"
                self._wrong("TRN024", message, key, f"the first is in line {first}; delete one")
            elif known is not None and name not in known:
                self._wrong("TRN022", f"{what} has no {plain(name)[:40] or 'such key'}", key, _meant(name, known))
            else:
                entries[name] = (key, value)
        return entries

    def _wrong(self, code: str, message: str, node: Any, hint: str) -> None:
        self.findings.append(error(code, message, self._span(node), hint))

    def _span(self, node: Any) -> Span:
        return span_of(node, str(self._file))


def _meant(word: str, known: Sequence[str]) -> str:
    close = closest(word, tuple(known))
    return f"did you mean {close}?" if close else f"known: {', '.join(known)}"


def _is_port(text: str) -> bool:
    return re.fullmatch(r"[1-9][0-9]{0,4}", text) is not None and int(text) <= 65535


def _is_boolean(text: str) -> bool:
    return text.lower() in ("true", "false", "yes", "no", "on", "off")
