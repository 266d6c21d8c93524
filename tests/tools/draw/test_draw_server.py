"""The page's server: for this machine and this page alone, with one file; no request ends in a fault."""

from __future__ import annotations

import http.client
import json
import os
import re
import stat
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Dict, Iterator, Optional, Tuple

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing.ground import read_ground
from pursue_gen.language.formatter import format_text
from pursue_gen.tools.draw import server as draw_server
from pursue_gen.tools.draw import storage
from pursue_gen.tools.draw.jobs import Jobs
from pursue_gen.tools.draw.page import DrawPage, file_for
from pursue_gen.tools.draw.server import MOST_BYTES, DrawServer
from tests.conftest import ROOT
from tests.large_scenarios import many_walkers
from tests.waiting import PATIENCE, connected, dripping, flooded, rest, until

TEXT = 'poi "a" //[0, 0, 0, 0, 0, 0, 1]\n'
WON = """poi "a"
poi "b"
connect a and b distance 2
event "work" location b
agent "bot" controllable mobile 1 location a can_do work
reach_objective: do work
"""


@pytest.fixture
def served(tmp_path: Path) -> Iterator[DrawServer]:
    file = tmp_path / "floor.pur"
    file.write_text(TEXT, encoding="utf-8")
    jobs = Jobs(file.name, None, 600, 4096)
    with DrawServer(DrawPage(file, None, jobs)) as server:
        threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True).start()
        yield server
        server.shutdown()
    jobs.end()


def request(
    server: DrawServer, method: str, path: str, body: Optional[bytes] = None, **headers: str
) -> Tuple[int, Dict[str, str], bytes]:
    """Status, headers and body of an answer; headers as from the page itself unless others are given."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=PATIENCE)
    usual = {"Origin": f"http://{server.hosts[0]}", "Content-Type": "application/json"}
    given = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, {name: value for name, value in {**usual, **given}.items() if value})
    answer = connection.getresponse()
    found = answer.status, {name.lower(): value for name, value in answer.getheaders()}, answer.read()
    connection.close()
    return found


def asked(server: DrawServer, name: str, **body: Any) -> Any:
    status, _, answer = request(server, "POST", f"/{server.token}/{name}", json.dumps(body).encode())
    assert status == 200, answer
    return json.loads(answer)


def saved(server: DrawServer, text: str, version: str, **more: Any) -> str:
    """The version of the file after a text was saved."""
    answer = asked(server, "save", text=text, version=version, **more)
    assert answer["saved"] == "floor.pur"
    return str(answer["version"])


def test_the_page_needs_nothing_from_elsewhere(served: DrawServer) -> None:
    status, headers, body = request(served, "GET", f"/{served.token}/")
    assert status == 200 and headers["content-type"] == "text/html; charset=utf-8"
    assert headers["content-security-policy"].startswith("default-src 'none'; script-src 'self';")
    assert len(served.files) > 8
    for name in served.files:
        status, headers, body = request(served, "GET", f"/{served.token}/{name}")
        assert status == 200 and b"https://" not in body
        assert b"http://" not in body.replace(b"http://www.w3.org/2000/svg", b""), name
        assert headers["x-content-type-options"] == "nosniff" and headers["cache-control"] == "no-store"


@pytest.mark.parametrize(
    ("method", "path", "headers", "status"),
    [
        ("GET", "/", {}, 403),
        ("GET", "/wrong/", {}, 403),
        ("GET", "/{token}", {}, 403),
        ("GET", "/{token}/nothing.js", {}, 404),
        ("GET", "/{token}/../server.py", {}, 404),
        ("GET", "/{token}/floor.png", {}, 404),
        ("GET", "/{token}/", {"Host": "elsewhere.example:80"}, 403),
        ("POST", "/wrong/save", {}, 403),
        ("POST", "/{token}/save", {"Host": "elsewhere.example"}, 403),
        ("POST", "/{token}/save", {"Origin": "http://elsewhere.example"}, 403),
        ("POST", "/{token}/save", {"Origin": ""}, 403),
        ("POST", "/{token}/save", {"Content_Type": "text/plain"}, 415),
        ("POST", "/{token}/save", {"Content_Length": str(MOST_BYTES + 1)}, 413),
        ("POST", "/{token}/save", {"Content_Length": "-1"}, 411),
        ("POST", "/{token}/save", {"Transfer_Encoding": "chunked"}, 411),
        ("PUT", "/{token}/save", {}, 501),
    ],
)
def test_others_are_refused(served: DrawServer, method: str, path: str, headers: Dict[str, str], status: int) -> None:
    body = b'{"text": "", "overwrite": true}' if method != "GET" else None
    assert request(served, method, path.format(token=served.token), body, **headers)[0] == status
    assert served.page.file.read_text() == TEXT


@pytest.mark.parametrize("body", [b"", b"[]", b"{", b"\xff", b"[" * 100_000, b'{"text": NaN}'])
def test_what_cannot_be_understood_is_refused(served: DrawServer, body: bytes) -> None:
    status, _, answer = request(served, "POST", f"/{served.token}/view", body)
    assert status == 400 or "refused" in json.loads(answer)


def test_what_is_missing_or_not_known_is_refused_with_a_reason(served: DrawServer) -> None:
    assert asked(served, "fly")["code"] == "DRW001"
    assert asked(served, "view")["refused"].startswith("the page sent no text")
    assert asked(served, "change", text="", operation={"do": "fly"})["code"] == "DRW001"
    assert asked(served, "change", text="poi a\n", operation={"do": "format"})["code"] == "DRW002"


def test_an_error_of_the_program_leaves_the_page_alive(served: DrawServer, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any) -> Any:
        raise ZeroDivisionError("by zero")

    with monkeypatch.context() as patched:
        patched.setattr(served.page.jobs, "state", broken)
        assert asked(served, "job")["refused"] == "internal error of pursue-gen: ZeroDivisionError: by zero"
    assert asked(served, "job")["state"] == "none"


def test_a_text_is_opened_shown_and_changed(served: DrawServer) -> None:
    opened = asked(served, "open")
    assert (opened["text"], opened["file"], opened["new"]) == (TEXT, "floor.pur", False)
    done = asked(served, "change", text=TEXT, operation={"do": "add place", "x": 3, "y": 4})
    assert done["statement"] == 1 and done["view"]["places"][1]["x"] == 3
    codes = [finding["code"] for finding in asked(served, "view", text=TEXT)["view"]["findings"]]
    assert codes == ["PML130", "PML171"]


def test_any_text_can_be_shown(served: DrawServer) -> None:
    texts = ["\0", "poi", 'poi "a', "/*", "\ufffd", 'poi "a" //[', "connect a and a distance 0", "agent", "\r\n"]
    for text in [*texts, 'agent agent "x" location', "event event", "é\U0001f600" * 5 + "?"]:
        assert "view" in asked(served, "view", text=text)
    half = json.dumps({"text": "\ud800"}).encode()
    assert request(served, "POST", f"/{served.token}/view", half)[0] == 400, "no file can hold it"


def test_offsets_of_findings_are_those_of_javascript(served: DrawServer) -> None:
    (finding, *_) = asked(served, "view", text="/* \U0001f600 */ poi missing\n")["view"]["findings"]
    assert (finding["start"], finding["end"]) == (13, 20)


def test_saving_writes_the_file_and_keeps_its_mode(served: DrawServer) -> None:
    file = served.page.file
    file.chmod(0o640)
    version = saved(served, TEXT + "// é\n", asked(served, "open")["version"])
    assert file.read_text(encoding="utf-8") == TEXT + "// é\n"
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    version = saved(served, TEXT, version)
    assert (asked(served, "open")["text"], asked(served, "open")["version"]) == (TEXT, version)


def test_a_file_that_has_changed_meanwhile_is_replaced_only_where_that_is_wanted(served: DrawServer) -> None:
    file = served.page.file
    version = asked(served, "open")["version"]
    file.write_text("// another hand\n")
    assert asked(served, "save", text="// mine\n", version=version)["code"] == "DRW003"
    assert file.read_text() == asked(served, "open")["text"] == "// another hand\n"
    version = saved(served, "// mine\n", version, overwrite=True)
    file.unlink()
    assert asked(served, "save", text="// mine\n", version=version)["code"] == "DRW003"
    assert not file.exists()
    saved(served, "// mine\n", storage.NOTHING)


def test_two_pages_do_not_replace_what_the_other_one_has_saved(served: DrawServer) -> None:
    version = asked(served, "open")["version"]
    saved(served, "// one\n", version)
    assert asked(served, "save", text="// two\n", version=version)["code"] == "DRW003"


def test_nothing_is_written_through_a_link(served: DrawServer, tmp_path: Path) -> None:
    file, target = served.page.file, tmp_path / "target.pur"
    target.write_text(TEXT)
    file.unlink()
    file.symlink_to(target)
    assert "is a link" in asked(served, "save", text="", overwrite=True)["refused"]
    assert "is a link" in asked(served, "open")["refused"]
    assert target.read_text() == TEXT
    with pytest.raises(PursueError):
        storage.opened(file)


def test_a_new_file_is_written_with_the_first_save(tmp_path: Path) -> None:
    storage.check_new(tmp_path / "new.pur", force=False)
    page = DrawPage(tmp_path / "new.pur", None, Jobs("new.pur", None, 600, 4096), anew=True)
    opened = page.answer("open", {})
    assert (opened["new"], opened["version"]) == (True, "")
    assert not page.file.exists()
    assert page.answer("save", {"text": TEXT, "version": ""})["saved"] == "new.pur"
    assert page.file.read_text() == page.answer("open", {})["text"] == TEXT


def test_a_file_that_is_there_is_not_begun_anew_without_force(tmp_path: Path) -> None:
    file = tmp_path / "map.pur"
    file.write_text(TEXT)
    with pytest.raises(PursueError) as caught:
        storage.check_new(file, force=False)
    assert f"pursue-gen draw {file}" in caught.value.diagnostics[0].hint
    storage.check_new(file, force=True)
    page = DrawPage(file, None, Jobs("map.pur", None, 600, 4096), anew=True)
    opened = page.answer("open", {})
    assert opened["text"] == "" and page.answer("save", {"text": "// anew", "version": opened["version"]})["saved"]
    assert page.answer("open", {})["text"] == file.read_text() == "// anew"


def test_what_cannot_be_opened_is_named(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.pur")
    for path in (tmp_path, tmp_path / "no" / "a.pur", tmp_path / "pipe.pur"):
        with pytest.raises(PursueError) as caught:
            storage.opened(path)
        assert caught.value.exit_status == 2 and str(path) in caught.value.diagnostics[0].message


def test_a_port_that_is_in_use_is_an_error_with_a_way_out(served: DrawServer) -> None:
    with pytest.raises(PursueError) as caught:
        DrawServer(served.page, served.server_address[1])
    assert caught.value.exit_status == 2 and "--port" in caught.value.diagnostics[0].hint


def test_a_scenario_without_a_name_is_called_like_the_map() -> None:
    assert file_for(None, Path("maps/2nd floor.yaml")) == Path("n_2nd_floor.pur")
    assert file_for(None, None) == Path("my_floor.pur")
    assert file_for(Path("a.pur"), Path("map.yaml")) == Path("a.pur")


def test_the_floor_plan_lies_under_the_picture_where_its_origin_and_its_turn_say(tmp_path: Path) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5\n20 10\n255\n" + bytes([254]) * 200)
    (tmp_path / "map.yaml").write_text("image: map.pgm\nresolution: 0.5\norigin: [-2, 1, 0.5]\n")
    page = DrawPage(tmp_path / "a.pur", tmp_path / "map.yaml", Jobs("a.pur", None, 600, 4096))
    assert page.answer("open", {})["floor"] == {"width": 10, "height": 5, "x": -2, "y": 1, "yaw": 0.5}
    assert page.picture is not None and page.picture.startswith(b"\x89PNG")
    text = WON.replace('poi "a"', 'poi "a" //[0, 3, 0, 0, 0, 0, 1]').replace('"b"', '"b" //[99, 0, 0, 0, 0, 0, 1]')
    found = page.answer("view", {"text": text})["view"]["findings"]
    assert "WSP008" in [one["code"] for one in found]
    found = page.answer("view", {"text": re.sub("connect.*\n", "", text)})["view"]["findings"]
    assert {"PML153", "WSP008"} <= {one["code"] for one in found}, "before there are ways, too"


def test_a_text_is_solved_beside_the_page_and_can_be_given_up(served: DrawServer) -> None:
    assert asked(served, "job")["state"] == "none"
    asked(served, "solve", text=WON)
    until(lambda: asked(served, "job").get("report"), "the report")
    done = until(lambda: asked(served, "job")["state"] == "ended" and asked(served, "job"), "the end")
    assert done["verdict"] == "won" and "work happens." in done["lines"]
    status, headers, body = request(served, "GET", f"/{served.token}/report.html")
    assert status == 200 and b"Report on floor" in body and "sandbox" in headers["content-security-policy"]
    asked(served, "solve", text=many_walkers())
    assert asked(served, "cancel")["state"] == "cancelled"
    asked(served, "solve", text=WON.replace("can_do work", ""))
    done = until(lambda: asked(served, "job")["state"] == "ended" and asked(served, "job"), "the end")
    assert done["verdict"] == "errors" and "nobody can do work" in done["lines"][0]


def test_ways_are_measured_on_the_map_as_survey_does(tmp_path: Path) -> None:
    pytest.importorskip("scipy", reason="scipy is not installed")
    rooms = ROOT / "docs" / "survey" / "three_rooms.pur"
    text = rooms.read_text(encoding="utf-8")
    jobs = Jobs(rooms.name, rooms.with_suffix(".yaml"), 600, 4096)
    page = DrawPage(tmp_path / rooms.name, rooms.with_suffix(".yaml"), jobs)
    settings = {"radius": 0.3, "speed": 0.4, "ways": True}
    page.answer("survey", {"text": text, **settings})
    done = until(lambda: page.answer("job", {})["state"] == "ended" and page.answer("job", {}), "the end")
    from pursue_gen.survey.make import Options, surveyed
    from pursue_gen.survey.routes import Drive
    from pursue_gen.workspace.levels import Level
    from pursue_gen.workspace.map_check import read_placed

    ground = read_ground(rooms.with_suffix(".yaml"), whole=True)
    options = Options(ways=True, drive=Drive({"bot1": 0.4, "bot2": 0.4}))
    copy = surveyed(read_placed(text, rooms.name), (Level(ground, Path("three_rooms.yaml")),), options).text
    assert done["surveyed"] == format_text(copy, "copy.pur")
    assert any(line.startswith("hall - shelf") for line in done["lines"])
    path = next(one["line"] for one in done["paths"] if (one["a"], one["b"]) == ("desk", "hall"))
    assert len(path) > 2 and [list(path[0]), list(path[-1])] == [[1.0, 1.0], [6.0, 2.5]]
    page.answer("survey", {"text": "poi", **settings})
    done = until(lambda: page.answer("job", {})["state"] == "ended" and page.answer("job", {}), "the end")
    assert done["verdict"] == "errors" and "surveyed" not in done
    assert page.answer("survey", {"text": text, **settings, "radius": -1})["code"] == "DRW001"


def test_without_a_map_nothing_is_measured(served: DrawServer) -> None:
    assert asked(served, "survey", text=WON, radius=0.3, speed=None, ways=True)["code"] == "DRW001"


def test_a_game_is_played_beside_the_page_and_writes_nothing(served: DrawServer, tmp_path: Path) -> None:
    assert asked(served, "say", line="wait")["code"] == "DRW001"
    asked(served, "play", text=WON)

    def turn(number: int) -> Any:
        return until(lambda: asked(served, "job").get("game", {}).get("turn") == number and asked(served, "job"), "it")

    first = turn(1)["game"]
    assert first["at"] == {"bot": ["a"]} and "The robots can see to it, whatever others do." in first["lines"]
    asked(served, "say", line="wait")
    second = turn(2)["game"]
    assert second["at"] == {"bot": ["a", "b"]} and second["choices"][0][0] == "bot: arrive at b"
    assert second["to"] == [""] * len(second["choices"]), "nobody sets off"
    asked(served, "say", line=f"save {tmp_path / 'game.yaml'}")
    assert "not saved" in turn(3)["game"]["lines"][0] and not (tmp_path / "game.yaml").exists()
    asked(served, "say", line="1")
    asked(served, "say", line="wait")
    assert turn(5)["game"]["over"] is True
    assert asked(served, "cancel")["state"] == "cancelled"
    asked(served, "play", text="poi")
    done = until(lambda: asked(served, "job")["state"] == "ended" and asked(served, "job"), "the end")
    assert done["verdict"] == "errors"


@pytest.mark.parametrize("address", ["127.0.0.1", "127.0.0.2"])
def test_a_flood_keeps_nobody_off_the_page_and_takes_no_threads(served: DrawServer, address: str) -> None:
    before = set(threading.enumerate())
    with flooded(served.server_address[1], address):
        assert request(served, "GET", f"/{served.token}/")[0] == 200
        assert asked(served, "open")["text"] == TEXT
        until(lambda: len(set(threading.enumerate()) - before) <= draw_server.MOST_CONNECTIONS, "few threads")


def test_a_request_under_way_is_not_ended_by_a_flood(served: DrawServer, monkeypatch: pytest.MonkeyPatch) -> None:
    begun, go_on = threading.Event(), threading.Event()

    def slow() -> Dict[str, Any]:
        begun.set()
        return {"waited": go_on.wait(PATIENCE)}

    monkeypatch.setattr(served.page.jobs, "state", slow)
    with ThreadPoolExecutor(1) as pool:
        answer = pool.submit(asked, served, "job")
        assert begun.wait(PATIENCE)
        with flooded(served.server_address[1], "127.0.0.1"):
            assert request(served, "GET", f"/{served.token}/")[0] == 200, "all of them have been accepted"
            go_on.set()
            assert answer.result() == {"waited": True}


@pytest.mark.parametrize("start", [
    "GET /{token}/ HTTP/1.1\r\nA: ",
    "POST /{token}/job HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nContent-Type: application/json\r\n"
    "Content-Length: 9000\r\n\r\n",
])
def test_a_request_that_drips_is_closed_in_time(
    served: DrawServer, monkeypatch: pytest.MonkeyPatch, start: str
) -> None:
    monkeypatch.setattr(draw_server, "REQUEST_TIMEOUT", 1.0)
    with connected(served.server_address[1]) as there:
        there.sendall(start.format(token=served.token, host=served.hosts[0]).encode())
        with dripping(there, b"x"):
            assert rest(there) == b""
