"""Every reader with every hostile text: it ends with an error that has a reason. A watchdog ends what hangs.

`test_bounded.py` has the reader of JSON and YAML alone; `tests/language/test_hostile.py` has scenarios.
"""

from __future__ import annotations

import ast
import base64
import faulthandler
import hashlib
import json
import subprocess
import sys
from pathlib import Path
from typing import Callable, Dict, Iterator, List

import pytest

pytest.importorskip("cryptography", reason="cryptography is not installed")

from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing.floor_picture import read_floor
from pursue_gen.language.parser import parse
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.tga.uppaal import read_network, read_query
from pursue_gen.tools.replay.game import read_game
from pursue_gen.tools.replay.read import read_recording
from pursue_gen.tools.transport.client import Unreached, _object
from pursue_gen.tools.transport.poses_file import read_poses
from pursue_gen.tools.transport.robots_file import read_robots
from pursue_gen.workspace.machines import parse_machines
from pursue_runtime import bundle
from pursue_runtime.bounded import DATA, read_json, read_yaml
from pursue_runtime.data import DataError, parse_data, read_data
from pursue_runtime.event_words import parse_word
from pursue_runtime.manager.manager import parse_status
from pursue_runtime.missions import MANIFEST, Missions, Source
from pursue_runtime.model import Model
from pursue_runtime.numbers import exact, whole
from pursue_runtime.observer.planner import _read as read_answer
from pursue_runtime.reader.contents import StoreError, manifest, read_state
from pursue_runtime.reader.reader import check_data
from pursue_runtime.strategy import Strategy, parse_plan, read_cover
from pursue_runtime.ui.environment import TraceError, read_trace
from pursue_runtime.ui.requests import read_request
from pursue_runtime.zones import parse_zone
from tests.partition.games import game
from tests.runtime.reader_stage import Robot, mission
from tests.tools.transport.test_mission_bundle import KEY, KEYS, sealed, zipped

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 300

REFUSALS = (DataError, PursueError, StoreError, TraceError, Unreached, bundle.Refused, ValueError)

NESTED = 100_000
HOSTILE: Dict[str, str] = {
    "brackets": "[" * NESTED,
    "closed brackets": "[" * NESTED + "]" * NESTED,
    "braces": '{"a":' * NESTED,
    "both": '[{"a":' * NESTED,
    "a key twice": '{"a": 1, "a": 2}',
    "a huge number": "9" * 1_000_000,
    "a large number": "9" * 19,
}
"""Values in JSON and YAML that nobody may read, wherever they stand."""
JSON_ONLY = {"not a number": "NaN", "infinity": "-Infinity", "overflow": "1e999", "half a character": '"\\ud800"'}
YAML_ONLY = {
    "an anchor": "&a [1]",
    "a tag": "!!python/object/apply:os.system [ls]",
    "a bomb of aliases": "[&a [x,x], &b [*a,*a], &c [*b,*b], &d [*c,*c]]",
}


class Refusal(Exception):
    """What a reader that does not raise returns for a text that it refuses."""


def refusing(value: object, reason: str = "") -> None:
    """Raises Refusal where the reader has returned no value; some give a reason."""
    if value is None:
        raise Refusal(reason or "it returned no value")


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def as_mission(folder: Path, text: str) -> None:
    """A controller's strategy in a bundle that a trusted desk has signed."""
    made = mission(more={"controller_bot1/strategy.yaml": text.encode()})
    answer = Robot(folder).order("prepare", made.digest, made.bundle)
    if not answer.ok:
        raise Refusal(answer.message)


def as_manifest(folder: Path, text: str) -> None:
    content = text.encode()
    bundle.unpack(zipped([(bundle.MANIFEST, content), (bundle.SIGNATURE, sealed(content))]), KEYS)


def as_order(folder: Path, text: str) -> None:
    body = text.encode()
    parts = (base64.urlsafe_b64encode(part).decode() for part in (body, KEY.sign(b"pursue-order-1\0" + body)))
    said, signature = parts
    bundle.read_order(f"{said}.{bundle.fingerprint(KEY.public_key())}.{signature}", KEYS)


def as_message(folder: Path, text: str) -> None:
    raise Refusal(Robot(folder).reader.on_message(text, 0.0).message)


def as_stored_state(folder: Path, text: str) -> None:
    written(folder, "state.json", text)
    read_state(str(folder))


def as_current(folder: Path, text: str) -> None:
    written(folder, "pursue/missions/state.json", text)
    Missions(Source("", str(folder)), "observer", str(folder)).current()


def as_stored_manifest(folder: Path, text: str) -> None:
    digest = hashlib.sha256(text.encode()).hexdigest()
    written(folder, f"{digest}/{MANIFEST}", text)
    manifest(str(folder), digest)


def as_planner_answer(text: str) -> None:
    name, _, said = read_answer(1, text.encode(), b"", 0)
    refusing(None if name == "unplanned" else said, str(said))


def as_planner_request(folder: Path, text: str) -> None:
    command = [sys.executable, "-m", "pursue_gen", "replan"]
    done = subprocess.run(command, input=text.encode(), capture_output=True, timeout=PATIENCE, check=False, cwd=ROOT)
    assert done.returncode == 2, done.stderr[-500:]
    raise Refusal(done.stderr.decode())


JSON_READERS: Dict[str, Callable[[Path, str], object]] = {
    "a new plan": lambda _, text: parse_plan(f'{{"format": 1, "plan": 1, "x": {text}}}'),
    "a planner's answer": lambda _, text: as_planner_answer(f'{{"won": true, "x": {text}}}'),
    "a planner's request": lambda folder, text: as_planner_request(folder, f'{{"format": 1, "x": {text}}}'),
    "a bundle's manifest": lambda folder, text: as_manifest(folder, f'{{"format": 1, "x": {text}}}'),
    "an order": lambda folder, text: as_order(folder, f'{{"format": 1, "x": {text}}}'),
    "a message to the reader": lambda folder, text: as_message(folder, f'{{"order": {text}}}'),
    "the store's state": lambda folder, text: as_stored_state(folder, f'{{"format": 1, "current": "", "x": {text}}}'),
    "the state for nodes": lambda folder, text: as_current(folder, f'{{"format": 1, "current": "", "x": {text}}}'),
    "a stored manifest": lambda folder, text: as_stored_manifest(
        folder, f'{{"format": 1, "scenario": "", "files": {{}}, "x": {text}}}'
    ),
    "a request of the page": lambda _, text: read_request(f'{{"do": "start", "x": {text}}}'),
    "a reader's status": lambda _, text: refusing(
        parse_status(f'{{"format": 1, "robot": "", "ticket": "", "x": {text}}}')
    ),
    "a robot's answer": lambda _, text: _object(200, f'{{"x": {text}}}'.encode()),
    "a journal's head": lambda folder, text: read_recording(
        written(folder, "journal.jsonl", f'{{"format": 1, "scenario": "", "x": {text}}}\n')
    ),
    "a journal's line": lambda folder, text: read_recording(
        written(folder, "journal.jsonl", f'{{"format": 1, "scenario": ""}}\n{{"at": 1, "call": "tick", "x": {text}}}\n')
    ),
}

HEAD = "format: 1\n"
POSE = [0, 0, 0, 0, 0, 0, 1]
YAML_READERS: Dict[str, Callable[[Path, str], object]] = {
    "a data file": lambda folder, text: read_data(str(written(folder, "x.yaml", f"{HEAD}x: {text}\n"))),
    "data of a mission": lambda _, text: parse_data(f"{HEAD}x: {text}\n".encode(), "x.yaml"),
    "a signed strategy": lambda folder, text: as_mission(folder, f"{HEAD}strategy: {text}\n"),
    **{
        f"a signed {name}": lambda folder, text, name=name: check_data(  # type: ignore[misc]
            str(written(folder, name, f"{HEAD}x: {text}\n"))
        )
        for name in ("strategy.yaml", "people.yaml", "cover.yaml", "model.yaml", "poses.yaml", "controllers.yaml",
                     "game.yaml", "ui.yaml")
    },
    "a trace": lambda _, text: read_trace(f"- {{at: 1, do: go}}\n- {text}\n", "trace.yaml", ["go"]),
    "machines.yaml": lambda _, text: parse_machines(f"{HEAD}machines: {text}\n", "machines.yaml", ("observer",)),
    "robots.yaml": lambda folder, text: read_robots(written(folder, "robots.yaml", f"{HEAD}robots: {text}\n")),
    "poses.yaml": lambda folder, text: read_poses(written(folder, "poses.yaml", f"poses: {text}\n"), ("a",)),
    "poses of robots": lambda folder, text: read_poses(
        written(folder, "poses.yaml", f"poses: {{a: {POSE}}}\nrobots: {{bot: {text}}}\n"), ("a",), ("bot",)
    ),
    "a signed pose": lambda folder, text: check_data(
        str(written(folder, "poses.yaml", f"{HEAD}poses: {{a: {text}}}\n"))
    ),
    "a signed table of a robot": lambda folder, text: check_data(
        str(written(folder, "poses.yaml", f"{HEAD}poses: {{a: {POSE}}}\nrobots: {{bot: {text}}}\n"))
    ),
    "a map": lambda folder, text: read_floor(written(folder, "map.yaml", f"resolution: {text}\n")),
    "a game": lambda _, text: read_game(f"{HEAD}rules: {text}\n", "game.yaml"),
}  # fmt: skip

NTA = (
    "<nta><declaration>clock x; int v = 0;</declaration><template><name>t</name>"
    '<location id="a"><name>a</name></location><init ref="a"/>'
    '<transition><source ref="a"/><target ref="a"/><label kind="{kind}">{text}</label></transition></template>'
    "<system>system t;</system></nta>"
)


def as_label(kind: str) -> Callable[[Path, str], object]:
    return lambda _, text: read_network(NTA.replace("{kind}", kind).replace("{text}", text), "TGA.xml")


def as_plan(folder: Path, text: str) -> object:
    return read_plan(text, game(), "plan.txt")


def data(text: str) -> Dict[str, object]:
    found = parse_data(f"{HEAD}{text}\n".encode(), "x.yaml")
    return found


OTHER_TEXTS: Dict[str, Callable[[Path, str], object]] = {
    "a guard": as_label("guard"),
    "an assignment": as_label("assignment"),
    "a channel": as_label("synchronisation"),
    "a network": lambda _, text: read_network(text, "TGA.xml"),
    "a query": lambda _, text: read_query(text, "TCTL.q"),
    "a strategy": as_plan,
    "a scenario": lambda _, text: parse(text, "x.pur"),
    "a zone": lambda _, text: parse_zone(text),
    "a word": lambda _, text: refusing(parse_word(text)),
    "a number": lambda _, text: exact(text),
    "a whole number": lambda _, text: whole(text),
}
OTHER_HOSTILE = {
    "parentheses": "(" * NESTED,
    "closed parentheses": "(" * NESTED + "x == 1" + ")" * NESTED,
    "elements": "<a>" * NESTED,
    "entities": '<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><nta>&b;</nta>',
    "a huge bound": "x == " + "9" * 1_000_000,
    "a word with a huge number": "go@" + "9" * 1_000_000,
    "a zero below the line": "x < 1/0",
    "a huge exponent": "1e999999999",
    "blanks": " " * 1_000_000 + "!",
    "brackets": "[" * NESTED,
}


@pytest.fixture(autouse=True)
def watchdog() -> Iterator[None]:
    """What hangs in C code ends the tests, with the place on stderr."""
    faulthandler.dump_traceback_later(PATIENCE, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()


def refused(read: Callable[[Path, str], object], folder: Path, text: str) -> str:
    """Why it is refused, as people see it."""
    try:
        found = read(folder, text)
    except (*REFUSALS, Refusal) as problem:
        findings = problem.diagnostics if isinstance(problem, PursueError) else ()
        why = "; ".join(finding.message for finding in findings) or str(problem)
        assert why.strip()
        assert len(why) < 5000
        return why
    raise AssertionError(f"it was read: {str(found)[:100]}")


@pytest.mark.parametrize("hostile", [*HOSTILE, *JSON_ONLY])
@pytest.mark.parametrize("reader", JSON_READERS)
def test_json(tmp_path: Path, reader: str, hostile: str) -> None:
    refused(JSON_READERS[reader], tmp_path, {**HOSTILE, **JSON_ONLY}[hostile])


@pytest.mark.parametrize("hostile", [*HOSTILE, *YAML_ONLY])
@pytest.mark.parametrize("reader", YAML_READERS)
def test_yaml(tmp_path: Path, reader: str, hostile: str) -> None:
    refused(YAML_READERS[reader], tmp_path, {**HOSTILE, **YAML_ONLY}[hostile])


@pytest.mark.parametrize("hostile", OTHER_HOSTILE)
@pytest.mark.parametrize("reader", OTHER_TEXTS)
def test_other_texts(tmp_path: Path, reader: str, hostile: str) -> None:
    if (reader, hostile) == ("a word", "a huge exponent"):
        return  # a name like any other
    refused(OTHER_TEXTS[reader], tmp_path, OTHER_HOSTILE[hostile])


@pytest.mark.parametrize("number", ["1:30", "010", "0x10", ".nan", ".inf", "2026-01-01", "1e999", "[1]", "{a: 1}"])
@pytest.mark.parametrize("where", [
    lambda number: Strategy(data(f"commands_agents: []\nreaction: {number}\nstrategy: []")),
    lambda number: read_trace(f"- {{at: {number}, do: go}}", "trace.yaml", ["go"]),
    lambda number: read_cover(data(f"cover: [{{state: {{}}, wait: [{number}]}}]")),
    lambda number: Model(data(
        "scenario: s\nclocks: []\nvariables: {}\nobjective: {kind: reach, goal: null, bad: null}\n"
        f"automata: [{{name: a, kind: k, initial: l, locations: {{l: [{number}]}}, edges: []}}]"
    )),
])  # fmt: skip
def test_what_only_yaml_takes_for_a_number_is_none(where: Callable[[str], object], number: str) -> None:
    if number == "010":  # as text it is a number like any other: ten, and not eight
        return
    refused(lambda _, text: where(text), Path(), number)


def test_sexagesimal_numbers_are_never_numbers(tmp_path: Path) -> None:
    robots = "format: 1\nrobots: {b: {host: h, port: 1:30}}\n"
    assert "port" in refused(lambda folder, text: read_robots(written(folder, "r.yaml", text)), tmp_path, robots)
    machines = "format: 1\nmachines: {h: {nodes: [1:30]}}\n"
    assert "1:30" in refused(lambda _, text: parse_machines(text, "m.yaml", ("observer",)), tmp_path, machines)


def test_the_size_of_a_data_file_is_bounded_before_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    with path.open("wb") as file:
        file.truncate(DATA.size + 1)
    assert "bytes" in refused(lambda _, text: read_data(text), tmp_path, str(path))


BY_HAND = {"pursue_runtime/bounded.py", "pursue_runtime/observer/journal.py", "pursue_gen/tools/simulation/nodes.py"}
"""The reader itself, the journal's own lines, and what a simulation keeps in memory."""
CALLS = {
    "json": ("load", "loads", "JSONDecoder"),
    "yaml": ("load", "safe_load", "load_all", "compose", "parse", "scan", "SafeLoader"),
    "expat": ("ParserCreate",),
}


def other_readers(text: str) -> List[str]:
    """The calls of a module that read JSON, YAML or XML by other means."""
    calls = (node for node in ast.walk(ast.parse(text)) if isinstance(node, (ast.Attribute, ast.ImportFrom)))
    found = []
    for node in calls:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.attr in CALLS.get(node.value.id, ()):
                found.append(f"{node.lineno}: {node.value.id}.{node.attr}")
        elif isinstance(node, ast.ImportFrom) and (node.module or "") in ("json", "yaml"):
            found.append(f"{node.lineno}: from {node.module}")
    return found


def test_there_is_one_reader_of_json_and_yaml_and_one_of_xml() -> None:
    found = {
        path.relative_to(ROOT).as_posix(): other_readers(path.read_text(encoding="utf-8"))
        for part in ("pursue_gen", "pursue_runtime")
        for path in sorted((ROOT / part).rglob("*.py"))
    }
    assert len(found) > 200
    elsewhere = {name for name, calls in found.items() if calls} - BY_HAND
    assert elsewhere == {"pursue_gen/tga/uppaal_markup.py"}
    assert other_readers("import json\njson.loads(text)") == ["2: json.loads"]


def test_the_reader_reads_what_others_are_compared_with() -> None:
    """The table above would pass with a reader that refuses everything."""
    assert read_json(json.dumps({"a": [1, 2.5, "x"]})) == read_yaml("a: [1, 2.5, x]") == {"a": [1, 2.5, "x"]}
    assert parse_plan('{"format": 1, "plan": 1}')
    assert parse_zone("x < 1/3") and exact("1/3") and whole("7") == 7
