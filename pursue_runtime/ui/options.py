"""The options of the UI: arguments of its process, and parameters of its node, over which arguments take precedence."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, Dict, Mapping, Sequence, Tuple

from pursue_runtime.arguments import CONFIG, LOOPBACK, Argument, add_arguments, port, values
from pursue_runtime.parameters import ParameterError, choice, flag, names, number, whole

MODES = {
    "ask": "you choose what the uncontrollable agents do",
    "still": "they stand still",
    "random": "they do something possible at random moments",
    "trace": "they do what a trace file says",
}

IN_WORDS, EVENT_TOPIC, ALL_TOPICS = "words", "e", "f"
SHOWS = {
    IN_WORDS: "what happens, in words",
    EVENT_TOPIC: "each word on pursue/events as well",
    ALL_TOPICS: "all communication: also the robots' actions and the system state",
}
"""What the terminal shows; e and f are modes of the thesis's UI."""

ARGUMENTS = (
    CONFIG,
    Argument("trace", "FILE", "YAML list of {at: time units, do: word}; implies --mode trace"),
    Argument("verdict", "FILE", "write there how the mission ended, when it has"),
    Argument("host", "ADDRESS", "of --web: 127.0.0.1 (default), 0.0.0.0 for all", LOOPBACK),
    Argument("port", "N", "of --web (default 8080; 0: any that is free)", "8080"),
    Argument("token", "WORD", "of --web: who opens the page must know it; one is made for every address but loopback"),
)
"""What only the one who starts the process may say."""

MIN_TOKEN_LENGTH = 8  # characters of a token


@dataclass(frozen=True)
class Options:
    """`wait` is in real seconds, `pace` in time units; a page for browsers on `host` and `port` if `web`;
    it `stay`s after the mission; the file `verdict` gets the verdict."""

    mode: str
    trace: str
    seed: int
    autostart: bool
    wait: float
    nodes: Tuple[str, ...]
    pace: float
    ends: bool
    web: bool = False
    host: str = "127.0.0.1"
    port: int = 8080
    token: str = ""
    verdict: str = ""
    stay: bool = False
    show: str = IN_WORDS


def read_options(arguments: Sequence[str], params: Mapping[str, Any], terminal: bool, nodes: Sequence[str]) -> Options:
    """The options, from the command line, the node's parameters, and what fits a terminal or none.

    Raises ParameterError; argparse ends the program on `--help` and on an unknown argument.
    """
    told, given = read_told(arguments), vars(_parser().parse_args(list(arguments)))
    found = {**params, **{name: value for name, value in given.items() if value is not None}, **told}
    trace = told["trace"]
    usual = "trace" if trace else "ask" if terminal else "still"
    mode = choice({"mode": found.get("mode") or usual}, "mode", usual, tuple(MODES))
    if mode == "trace" and not trace:
        raise ParameterError("~mode trace needs a trace file: --trace FILE")
    web = flag(found, "web", False)
    token = told["token"]
    if token and len(token) < MIN_TOKEN_LENGTH:
        hint = f"expected at least {MIN_TOKEN_LENGTH}, or no token: then one is generated"
        raise ParameterError(f"--token has {len(token)} characters; {hint}")
    autostart = flag(found, "autostart", not terminal and not web)
    return Options(
        mode=mode,
        trace=trace,
        seed=whole(found, "seed", 0, least=None),
        autostart=autostart,
        wait=number(found, "wait", 30.0),
        nodes=expected(found, nodes),
        pace=number(found, "pace", 5.0, above=True),
        ends=flag(found, "ends", False),
        web=web,
        host=told["host"] or LOOPBACK,
        port=port(told, "port"),
        token=token,
        verdict=told["verdict"],
        stay=web and flag(found, "stay", terminal and not autostart),
        show=choice(found, "show", IN_WORDS, tuple(SHOWS)),
    )


def read_told(arguments: Sequence[str]) -> Dict[str, str]:
    """The value of each of ARGUMENTS; argparse ends the program on `--help` and on an unknown argument."""
    return values(ARGUMENTS, vars(_parser().parse_args(list(arguments))))


def expected(params: Mapping[str, Any], listed: Sequence[str]) -> Tuple[str, ...]:
    """The nodes to wait for: ~nodes, or those that the mission lists `~without` some and `~also` others.

    Raises ParameterError.
    """
    if "nodes" in params:
        return names(params, "nodes")
    without, also = names(params, "without"), names(params, "also")
    return tuple(node for node in listed if node not in without) + also


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="rosrun UI UI", description="Starts the mission, shows what happens, and says how it ends.",
        epilog="Exit status: 0 the goal is reached, 1 not, 2 the options are wrong. "
        "Options that name no file, address or token are also parameters of the node (~mode, ~seed and so on).",
    )
    parser.add_argument("--mode", metavar="MODE", help="; ".join(f"{mode}: {what}" for mode, what in MODES.items()))
    parser.add_argument("--show", metavar="WHAT", help="; ".join(f"{what}: {says}" for what, says in SHOWS.items()))
    parser.add_argument("--seed", metavar="N", help="for --mode random (default 0)")
    parser.add_argument("--pace", metavar="T", help="for --mode random: mean time units between two events (default 5)")
    parser.add_argument("--wait", metavar="S", help="seconds to wait for the other nodes (default 30)")
    parser.add_argument("--nodes", metavar="NAMES", help="the nodes to wait for (default: those in ui.yaml)")
    parser.add_argument(
        "--autostart", action="store_true", default=None, help="start as soon as they are ready, without Enter"
    )
    parser.add_argument(
        "--ends", action="store_true", default=None, help="without a simulator: everybody's ends are reported here"
    )
    parser.add_argument("--web", action="store_true", default=None, help="serve a page for browsers as well")
    parser.add_argument("--stay", action="store_true", default=None, help="of --web: the page stays after the mission, "
                        "until it is closed there (default on a terminal, without --autostart)")
    add_arguments(parser, ARGUMENTS)
    return parser
