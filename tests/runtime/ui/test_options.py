"""The UI's options: from parameters and from the command line, refused with what was expected."""

from __future__ import annotations

import io
from types import SimpleNamespace
from typing import Optional

import pytest

from pursue_runtime.parameters import ParameterError
from pursue_runtime.ui import options as ui_options
from pursue_runtime.ui import terminal as ui_terminal
from pursue_runtime.ui.options import read_options
from pursue_runtime.ui.terminal import GOOD, Terminal, on_terminal


def read(arguments=(), params=None, terminal: bool = False, nodes=("observer",)):
    return read_options(list(arguments), params or {}, terminal, nodes)


def test_a_terminal_is_asked_and_none_stands_still() -> None:
    assert (read(terminal=True).mode, read(terminal=True).autostart) == ("ask", False)
    assert (read().mode, read().autostart) == ("still", True)
    assert read().nodes == ("observer",)


def test_the_command_line_wins() -> None:
    options = read(["--mode", "random", "--seed", "7", "--nodes", "a,b c"], {"mode": "still", "seed": 3, "pace": 2})
    assert (options.mode, options.seed, options.pace, options.nodes) == ("random", 7, 2.0, ("a", "b", "c"))


def test_a_trace_says_its_mode() -> None:
    assert read(["--trace", "t.yaml"]).mode == "trace"
    assert read(["--trace", ""], {"mode": "still"}).mode == "still"


def test_flags_are_true_or_false() -> None:
    assert read(["--autostart"], terminal=True).autostart
    assert read(params={"autostart": False}).autostart is False
    assert read(params={"autostart": "true"}, terminal=True).autostart


def test_a_page_is_served_on_loopback_where_it_is_wanted() -> None:
    assert not read().web
    options = read(["--web"])
    assert (options.web, options.host, options.port, options.token) == (True, "127.0.0.1", 8080, "")
    options = read(["--host", "0.0.0.0", "--port", "0", "--token", "123456789"], {"web": True})
    assert (options.web, options.host, options.port, options.token) == (True, "0.0.0.0", 0, "123456789")


def test_whoever_has_a_page_starts_the_mission_there() -> None:
    assert read(["--web"]).autostart is False
    assert read(["--web", "--autostart"]).autostart is True


def test_a_page_outlives_the_mission_where_a_person_at_a_terminal_starts_it() -> None:
    assert read(["--web"], terminal=True).stay is True
    assert read(["--web", "--autostart"], terminal=True).stay is False
    assert read(["--web"]).stay is False, "a script waits for the exit status"
    assert read(["--web", "--stay"]).stay is True
    assert read(["--web"], {"stay": False}, terminal=True).stay is False
    assert read(["--stay"], terminal=True).stay is False, "there is no page"


@pytest.mark.parametrize("arguments, expected", [
    (["--port", "65536"], "--port is '65536'; expected a whole number of at least 0, at most 65535"),
    (["--port", "80.5"], "--port is '80.5'; expected a whole number"),
    (["--port=-1"], "--port is '-1'; expected a whole number of at least 0"),
    (["--port", "http"], "--port is 'http'; expected a whole number"),
    (["--token", "short"], "--token has 5 characters; expected at least 8"),
])
def test_a_wrong_argument_is_refused(arguments: list, expected: str) -> None:
    with pytest.raises(ParameterError) as caught:
        read(arguments)
    assert expected in str(caught.value)


def test_what_is_for_the_one_who_starts_it_is_no_parameter() -> None:
    others = {"trace": "/etc/passwd", "verdict": "/etc/passwd", "host": "0.0.0.0", "port": 80, "token": "known to all"}
    options = read(params={**others, "web": True, "mode": "still"})
    assert (options.trace, options.verdict, options.token) == ("", "", "")
    assert (options.host, options.port) == ("127.0.0.1", 8080)
    assert read(["--trace=none", "--verdict=none", "--token=none"]) == read(), "as launch files have it"


@pytest.mark.parametrize("params, expected", [
    ({"web": "perhaps"}, "web is 'perhaps'; expected true or false"),
    ({"mode": "quick"}, "mode is 'quick'; expected one of ask, still, random, trace"),
    ({"mode": "trace"}, "needs a trace file"),
    ({"seed": "x"}, "seed is 'x'; expected a whole number"),
    ({"wait": -1}, "wait is -1; expected a number of at least 0"),
    ({"pace": 0}, "pace is 0; expected a number"),
    ({"pace": True}, "pace is True; expected a number"),
    ({"autostart": "perhaps"}, "autostart is 'perhaps'; expected true or false"),
    ({"nodes": 7}, "nodes is 7; expected a list of names"),
])
def test_a_wrong_option_is_refused(params: dict, expected: str) -> None:
    with pytest.raises(ParameterError) as caught:
        read(params=params)
    assert expected in str(caught.value)


def test_the_nodes_are_those_of_the_mission_but_for_what_this_launch_knows_better() -> None:
    listed = ("observer", "controller_bot", "simulator")
    assert ui_options.expected({}, listed) == listed
    assert ui_options.expected({"without": "simulator", "also": "recorder"}, listed) == (*listed[:2], "recorder")
    assert ui_options.expected({"nodes": "one, two", "also": "recorder"}, listed) == ("one", "two")
    with pytest.raises(ParameterError, match="without"):
        ui_options.expected({"without": 7}, listed)


def test_help_says_what_there_is(capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit) as left:
        read(["--help"])
    assert left.value.code == 0
    said = capsys.readouterr().out
    assert all(word in said for word in ("--mode", "--trace", "--seed", "Starts the mission", "Exit status"))


class Screen(io.StringIO):
    def isatty(self) -> bool:
        return True


def written(stream: io.StringIO, environment: dict) -> str:
    terminal = Terminal(stream, environment)
    terminal.progress("3.0 on the way")
    terminal.line("done", GOOD)
    terminal.close()
    return stream.getvalue()


def closed() -> Screen:
    screen = Screen()
    screen.close()
    return screen


@pytest.mark.parametrize("stdin, stdout, told", [
    (Screen(), Screen(), True), (io.StringIO(), Screen(), False), (Screen(), io.StringIO(), False),
    (None, Screen(), False), (Screen(), None, False), (closed(), Screen(), False), (Screen(), closed(), False),
])
def test_a_person_is_where_input_and_output_are_a_terminal(
    stdin: Optional[io.StringIO], stdout: Optional[io.StringIO], told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ui_terminal, "sys", SimpleNamespace(stdin=stdin, stdout=stdout))
    assert on_terminal() == told


def test_no_codes_and_no_progress_but_on_a_terminal() -> None:
    assert written(io.StringIO(), {}) == "done\n"


def test_progress_is_replaced_on_a_terminal() -> None:
    text = written(Screen(), {"TERM": "xterm"})
    assert "on the way\r\033[K" in text
    assert "\033[32mdone\033[0m\n" in text


def test_no_colours_where_they_are_not_wanted() -> None:
    text = written(Screen(), {"TERM": "xterm", "NO_COLOR": "1"})
    assert "on the way" in text and "\033[3" not in text


def test_the_terminal_shows_words_unless_a_mode_of_the_thesis_is_asked_for() -> None:
    assert [read().show, read(["--show", "e"]).show, read(params={"show": "f"}).show] == ["words", "e", "f"]
    with pytest.raises(ParameterError, match="~show is 'all'; expected one of words, e, f"):
        read(["--show", "all"])
