"""What only the one who starts a node may say: programs, keys, files, addresses, tokens. No parameter of ROS does."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Dict, Iterator, Tuple

import pytest

from pursue_runtime.arguments import CONFIG, KEYS, Argument, command, ignored, port, read_arguments
from pursue_runtime.observer import settings
from pursue_runtime.parameters import ParameterError
from pursue_runtime.ui import options

RUN_TIME = Path(__file__).resolve().parents[2] / "pursue_runtime"
KNOWN = (CONFIG, Argument("planner", "COMMAND", "the planner", "pursue-gen replan"))


def test_what_is_not_given_is_as_documented() -> None:
    assert read_arguments("observer", KNOWN, []) == {"config": "", "planner": "pursue-gen replan"}


@pytest.mark.parametrize("words, found", [
    (["--planner", "off", "--config=/a folder"], {"planner": "off", "config": "/a folder"}),
    (["--planner=-x"], {"planner": "-x", "config": ""}),
    (["--config=none", "--planner=none"], {"planner": "pursue-gen replan", "config": ""}),  # as launch files have it
    (["--config="], {"planner": "pursue-gen replan", "config": ""}),
])  # fmt: skip
def test_values_are_taken_as_they_are(words: list, found: Dict[str, str]) -> None:
    assert read_arguments("observer", KNOWN, words) == found


@pytest.mark.parametrize("words, message", [
    (["--plan", "off"], "unrecognized arguments: --plan off"),  # no abbreviation: a later argument may be called so
    (["planner"], "unrecognized arguments: planner"),
    (["--config"], "expected one argument"),
])  # fmt: skip
def test_what_is_not_known_is_refused(words: list, message: str) -> None:
    with pytest.raises(ParameterError, match=message) as caught:
        read_arguments("observer", KNOWN, words)
    assert "--help" in str(caught.value)


def test_help_lists_them(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        read_arguments("observer", KNOWN, ["--help"])
    assert left.value.code == 0 and "--planner COMMAND" in capsys.readouterr().out


def test_a_parameter_of_that_name_is_ignored_and_said_to_be() -> None:
    sentence = ignored(KNOWN, {"planner": "rm -r /", "config": "/", "time_unit": 1.0})
    assert "ignored parameters: ~config, ~planner;" in sentence and "Pass --config, --planner to" in sentence
    assert "rm -r" not in sentence and "time_unit" not in sentence
    assert ignored(KNOWN, {"time_unit": 1.0}) == ignored(KNOWN, {}) == ignored(KNOWN, "a text") == ""


def test_a_command_can_be_split_into_words() -> None:
    assert command({"planner": "timeout 20 'a b'"}, "planner") == "timeout 20 'a b'"
    for value in ("pursue-gen 'replan", "", " "):
        with pytest.raises(ParameterError, match="--planner is .* expected a command, or off"):
            command({"planner": value}, "planner")


def test_a_port_is_a_number() -> None:
    assert port({"port": "8080"}, "port") == 8080
    for value in ("70000", "-1", "http", "80.5", ""):
        with pytest.raises(ParameterError, match="^--port is .* expected a whole number of at least 0, at most 65535"):
            port({"port": value}, "port")


# Which names are arguments, and which may be parameters ---------------------------------------------------------------

SAID_BY_THE_STARTER = {
    "config", "planner", "journal", "launch", "keys", "file", "trace", "verdict", "token", "host", "port",
    "pubsubport", "certificate", "private_key", "forwardedtopics",
}  # fmt: skip
SETTINGS = {
    # flags, numbers, names of nodes, robots, topics and frames
    "received", "again", "stay", "web", "autostart", "ends", "simulated", "time_unit", "tolerance", "on_uncovered",
    "lost_after", "silence", "heartbeat", "planning_limit", "linger", "shared_ends", "mode", "seed", "wait", "pace",
    "nodes", "without", "also", "topics", "reports", "delays", "map_frame", "namespace", "path", "robot", "keep",
    "limit", "patience", "state_topic", "topicName", "connections", "robots", "times", "pause", "start", "actions",
    "speed", "hold", "step", "units", "show", "print_state", "plain_words", "adapter", "command", "state", "name",
}  # fmt: skip
READERS = {"number", "whole", "choice", "flag", "text", "names", "get_param", "get_param_cached", "search_param"}
OWNERS = {"given", "params"}
"""What parameters are called where they are read as a mapping."""


def read_in_the_run_time() -> Iterator[Tuple[str, str]]:
    """Each parameter of a node that the run time reads by its name, with the file."""
    for path in sorted(RUN_TIME.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and path.name not in ("parameters.py", "arguments.py"):
                called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
                texts = [each.value for each in node.args if isinstance(each, ast.Constant)]
                owner = node.func.value if isinstance(node.func, ast.Attribute) else None
                owned_by = owner.attr if isinstance(owner, ast.Attribute) else getattr(owner, "id", "")
                called = "text" if called == "get" and owned_by.strip("_") in OWNERS else called
                if called in READERS and texts and isinstance(texts[0], str):
                    name = texts[0]
                    if not called.endswith(("param", "cached")) or name.startswith("~"):
                        yield name.lstrip("~"), path.name


def test_no_parameter_names_a_program_a_key_a_file_or_an_address() -> None:
    read = {name: file for name, file in read_in_the_run_time() if name}
    assert {"time_unit", "received", "mode", "keep"} <= set(read), "the search finds what is read"
    assert {name: file for name, file in read.items() if name not in SETTINGS} == {}
    assert not SETTINGS & SAID_BY_THE_STARTER


def test_the_arguments_of_all_nodes_are_those_that_are_looked_for() -> None:
    known = {each.name for each in (*settings.ARGUMENTS, *options.ARGUMENTS, CONFIG, KEYS)}
    assert known < SAID_BY_THE_STARTER
