"""The server of the page: who may see it, who may speak to it, and what it makes of junk."""

from __future__ import annotations

import asyncio
import json
import socket
import threading
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple

import pytest

from pursue_runtime.ui import web as ui_web
from pursue_runtime.ui.requests import read_request
from pursue_runtime.ui.web import MAX_INVALID, MAX_MESSAGE, Web, WebError

pytest.importorskip("tornado", reason="tornado is not installed")
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from pursue_runtime.ui.page_server import STATIC, format_address, read_address
from tests.waiting import PATIENCE, connected, may_close, rest, until

FOLDER = STATIC
TOKEN = "correct horse"


class Node:
    """What the server asks: a node that remembers what was wanted of it."""

    def __init__(self) -> None:
        self.asked: List[Tuple[str, str, int]] = []
        self.now: Optional[float] = None

    def welcome(self) -> Dict[str, Any]:
        return {"type": "hello"}

    def ask(self, message: Any) -> str:
        request = read_request(message)
        self.asked.append(request)
        return "not now" if request.word == "later" else ""

    def moment(self) -> Optional[float]:
        return self.now


Serve = Callable[..., Any]


@pytest.fixture
def node() -> Node:
    return Node()


@pytest.fixture
def serve(node: Node) -> Iterator[Serve]:
    """`serve(host, token)`: a server on a free port."""
    started = []

    def start(host: str = "127.0.0.1", token: str = "", port: int = 0) -> Any:
        web = Web(FOLDER, host, port, token, node.welcome, node.ask, node.moment)
        web.start()
        started.append(web)
        return web

    yield start
    for web in started:
        web.close()


class Patient(urllib.request.HTTPRedirectHandler):
    """Does not follow."""

    def redirect_request(self, *_: Any) -> None:
        return None


def get(web: Any, path: str = "/", method: str = "GET", data: Optional[bytes] = None, **headers: str) -> Any:
    """The answer, also where it is an error."""
    opener = urllib.request.build_opener(Patient, urllib.request.ProxyHandler({}))
    request = urllib.request.Request(f"http://127.0.0.1:{web.port}{path}", data, headers, method=method)
    try:
        return opener.open(request, timeout=PATIENCE)
    except urllib.error.HTTPError as answer:
        return answer


def talk(web: Any, script: Callable[[Any], Any], origin: str = "", **headers: str) -> Any:
    """Opens the WebSocket, with the headers of our own page if nothing else is said, and plays a script on it."""
    host = headers.get("Host", f"127.0.0.1:{web.port}")
    sent = {"Origin": origin or f"http://{host}", **headers}

    async def run() -> Any:
        told = {name: value for name, value in sent.items() if value != "none"}
        there = await websocket_connect(
            HTTPRequest(f"ws://127.0.0.1:{web.port}/live", headers=told, connect_timeout=PATIENCE)
        )
        try:
            return await asyncio.wait_for(script(there), PATIENCE)
        finally:
            there.close()

    return asyncio.run(run())


def refused(web: Any, **headers: str) -> int:
    """The status with which a WebSocket is refused."""
    with pytest.raises(HTTPClientError) as caught:
        talk(web, lambda there: there.read_message(), **headers)
    return int(caught.value.code)


async def hello(there: Any) -> Any:
    return json.loads(await there.read_message())


# The page

@pytest.mark.parametrize("path, kind", [
    ("/", "text/html"), ("/page.js", "text/javascript"), ("/connection.js", "text/javascript"),
    ("/page.css", "text/css"), ("/missions.js", "text/javascript"), ("/missions.css", "text/css"),
])
def test_the_page_is_served_and_may_load_nothing_but_itself(serve: Serve, path: str, kind: str) -> None:
    answer = get(serve(), path)
    assert (answer.status, answer.headers.get_content_type()) == (200, kind)
    policy = answer.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "script-src 'self'" in policy and "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy and "*" not in policy
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    assert answer.headers["Cache-Control"] == "no-store"
    assert answer.headers["Server"] is None


def test_the_page_names_nothing_outside_and_has_no_scripts_in_its_text() -> None:
    page = Path(FOLDER, "index.html").read_text(encoding="utf-8")
    scripts = sorted(Path(FOLDER).glob("*.js"))
    script = "".join(each.read_text(encoding="utf-8") for each in scripts)
    style = Path(FOLDER, "page.css").read_text(encoding="utf-8")
    for text in (page, style, script.replace("http://www.w3.org/2000/svg", "")):
        assert "http://" not in text and "https://" not in text and "//cdn" not in text
    assert page.count("<script") == len(scripts) and {f"/{each.name}" for each in scripts} <= set(ui_web.FILES)
    assert all(f'<script src="{each.name}" defer>' in page for each in scripts)
    assert "onclick" not in page and "style=" not in page
    for danger in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "new Function"):
        assert danger not in script, "names are text, never markup"


@pytest.mark.parametrize("path, method, status", [
    ("/nothing", "GET", 404), ("/../scripts/UI", "GET", 404), ("/page.js/..", "GET", 404),
    ("/%2e%2e/config", "GET", 404), ("/", "POST", 405), ("/", "PUT", 405), ("/live", "POST", 405),
    ("/live", "GET", 400),
])
def test_there_is_nothing_else(serve: Serve, path: str, method: str, status: int) -> None:
    web = serve()
    answer = get(web, path, method, b"x=1" if method != "GET" else None, Origin=f"http://127.0.0.1:{web.port}")
    assert answer.status == status


# Who may

def test_loopback_needs_no_token(serve: Serve) -> None:
    web = serve()
    assert web.token == ""
    assert web.url == f"http://127.0.0.1:{web.port}/"
    assert talk(web, hello)["type"] == "hello"


def test_any_other_address_gets_one(serve: Serve) -> None:
    web = serve("0.0.0.0")
    assert len(web.token) >= 20 and web.token in web.url
    assert serve("0.0.0.0").token != web.token
    assert get(web).status == 401
    assert get(web, "/page.js").status == 401
    assert refused(web) == 401


def test_a_given_token_is_not_reported(serve: Serve) -> None:
    assert TOKEN not in serve("0.0.0.0", TOKEN).url


def test_the_token_becomes_a_cookie_and_leaves_the_address(serve: Serve) -> None:
    web = serve(token=TOKEN)
    answer = get(web, "/?token=correct%20horse")
    assert (answer.status, answer.headers["Location"]) == (303, "/")
    cookie, *flags = answer.headers["Set-Cookie"].split("; ")
    assert TOKEN not in cookie and "horse" not in cookie
    assert {"HttpOnly", "SameSite=Lax"} <= set(flags)
    assert get(web, Cookie=cookie).status == 200
    assert talk(web, hello, Cookie=cookie)["type"] == "hello"


def test_a_wrong_token_is_refused(serve: Serve) -> None:
    web = serve(token=TOKEN)
    for path in ("/?token=wrong", "/?token=", "/page.js?token=wrong", "/?token=%C3%A9", "/nothing?token=wrong"):
        assert get(web, path).status == 403
        assert get(web, path).headers["Set-Cookie"] is None
    assert get(web, "/?token=%ff").status in (400, 403)
    assert get(web).status == 401
    assert b"token" in get(web).read()
    assert get(web, Cookie=f"{web.cookie}=wrong").status == 401
    assert get(web, Cookie=f"{web.cookie}={TOKEN.replace(' ', '')}").status == 401
    assert refused(web, Cookie=f"{web.cookie}=wrong") == 401
    assert get(web, "/nothing").status == 401, "strangers are not told what there is"


# Other sites

@pytest.mark.parametrize("origin", [
    "http://evil.example", "null", "https://127.0.0.1.evil.example", "http://127.0.0.1", "file://", "none",
    "http://127.0.0.1:1",
])
def test_pages_of_others_cannot_listen_or_speak(serve: Serve, node: Node, origin: str) -> None:
    assert refused(serve(), origin=origin) == 403
    assert node.asked == []


@pytest.mark.parametrize("host", [
    "evil.example", "evil.example:8080", "127.0.0.1.evil.example", "[", "a b", "localhost.evil.example",
])
def test_a_name_that_was_pointed_here_is_refused(serve: Serve, host: str) -> None:
    web = serve()
    assert get(web, Host=host).status in (400, 403)
    assert refused(web, origin=f"http://{host}", Host=host) in (400, 403)


def test_our_own_names_are_served_through_any_port(serve: Serve) -> None:
    web = serve()
    for host in (f"localhost:{web.port}", "127.0.0.1:9", "[::1]:9", socket.gethostname(), "10.1.2.3"):
        assert get(web, Host=host).status == 200, host
    assert talk(web, hello, Host="localhost:9", origin="http://localhost:9")["type"] == "hello"


# What is said

def test_what_is_asked_reaches_the_node_and_remarks_come_back(serve: Serve, node: Node) -> None:
    async def script(there: Any) -> Any:
        await there.read_message()
        await there.write_message('{"do": "say", "word": "thief_a2b", "seq": 3}')
        await there.write_message('{"do": "say", "word": "later", "seq": 4}')
        return json.loads(await there.read_message())

    assert talk(serve(), script) == {"type": "remark", "text": "not now"}
    assert node.asked == [("say", "thief_a2b", 3), ("say", "later", 4)]


def test_a_page_to_which_nothing_has_come_for_a_while_is_answered_at_once(serve: Serve, node: Node) -> None:
    async def script(there: Any) -> Any:
        await there.read_message()
        await there.write_message("alive?")
        return json.loads(await there.read_message())

    assert talk(serve(), script) == {"type": "alive"}
    assert node.asked == []


def test_junk_is_answered_and_too_much_of_it_ends_the_talk(serve: Serve, node: Node) -> None:
    async def script(there: Any) -> Any:
        await there.read_message()
        answers = []
        for number in range(MAX_INVALID):
            await there.write_message(b"\xff" if number % 2 else "{", binary=bool(number % 2))
            answers.append(await there.read_message())
        return answers

    web = serve()
    *answers, last = talk(web, script)
    assert all("expected" in json.loads(answer)["text"] for answer in answers) and last is None
    assert node.asked == []
    assert talk(web, hello)["type"] == "hello", "others are served"


def test_messages_that_are_too_long_end_the_talk(serve: Serve, node: Node) -> None:
    async def script(there: Any) -> Any:
        await there.read_message()
        await there.write_message(json.dumps({"do": "say", "word": "x" * MAX_MESSAGE}))
        return await there.read_message()

    web = serve()
    assert talk(web, script) is None
    assert node.asked == []
    assert talk(web, hello)["type"] == "hello"


@pytest.mark.parametrize("junk", [
    b"\x00\xff" * 5000, b"GET / HTTP/1.1\r\nHost: x\r\n" + b"A: " + b"y" * 100000 + b"\r\n\r\n",
    b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999\r\n\r\n", b"GET /live HTTP/1.1\r\n\r\n",
    b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: -1\r\n\r\n", b"\r\n\r\n\r\n",
])
def test_what_is_no_request_of_ours_does_no_harm(serve: Serve, junk: bytes) -> None:
    web = serve()
    with connected(web.port) as there:
        with may_close():
            there.sendall(junk[:65536])
            there.shutdown(socket.SHUT_WR)
        assert b" 200 " not in rest(there)
    assert get(web).status == 200


def test_every_page_receives_what_happens_and_what_time_it_is(serve: Serve, node: Node) -> None:
    web = serve()
    node.now = 12.5

    async def script(there: Any) -> Any:
        await there.read_message()
        threading.Thread(target=web.send, args=({"type": "view", "name": "<b>&"},)).start()
        heard: Dict[str, Any] = {}
        while len(heard) < 2:
            message = json.loads(await there.read_message())
            heard[message["type"]] = message
        return heard

    assert talk(web, script) == {"tick": {"type": "tick", "now": 12.5}, "view": {"type": "view", "name": "<b>&"}}


def test_there_is_room_for_so_many_pages(serve: Serve, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ui_web, "MAX_PAGES", 1)
    web = serve()

    async def second(there: Any) -> Any:
        await there.read_message()
        return await asyncio.get_running_loop().run_in_executor(None, talk, web, lambda other: other.read_message())

    assert talk(web, second) is None
    until(lambda: talk(web, lambda there: there.read_message()) is not None, "whoever has gone leaves room")


def test_a_page_that_does_not_read_is_given_up_and_memory_with_it(
    serve: Serve, node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ui_web, "MAX_BACKLOG", 1 << 16)
    web = serve()
    key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
    with connected(web.port) as there:
        there.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        host = f"127.0.0.1:{web.port}"
        head = f"GET /live HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n"
        head += "Upgrade: websocket\r\nConnection: Upgrade\r\n"
        there.sendall(f"{head}{key}\r\n".encode())
        assert b" 101 " in there.recv(200)
        until(lambda: len(web._pages) == 1, "a page that listens")
        until(lambda: web.send({"type": "view", "padding": "x" * 50000}) or not web._pages, "it is given up")


def test_the_last_word_goes_out_before_the_end(serve: Serve) -> None:
    web = serve()

    async def script(there: Any) -> Any:
        await there.read_message()
        web.send({"type": "view", "status": "won"})
        threading.Thread(target=web.close).start()
        return [await there.read_message(), await there.read_message(), there.close_code]

    assert talk(web, script) == ['{"type": "view", "status": "won"}', None, 1000]
    web.send({"type": "view"})
    web.close()


def test_the_server_has_ended_when_it_is_closed(serve: Serve, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ui_web, "LAST_WORDS", PATIENCE)
    web = serve()
    assert get(web).status == 200
    web.close()
    assert not web._background._thread.is_alive(), "else what was sent is lost with the process"


@pytest.mark.parametrize("text", ["", "x token", "65536 token", "-1 token", "²"])
def test_a_page_before_this_one_is_found_by_its_address_and_by_nothing_else(text: str) -> None:
    assert read_address(format_address(65535, "its token")) == (65535, "its token")
    assert read_address(text) == (0, "")


# What cannot be served

def test_a_port_that_is_taken_is_reported_with_what_to_do(serve: Serve) -> None:
    web = serve()
    with pytest.raises(WebError, match=f"port {web.port}.*choose another --port"):
        serve(port=web.port)


@pytest.mark.parametrize("host", ["192.0.2.1", "no such host", "", "\x00", "x" * 300])
def test_an_address_that_is_not_ours_is_reported(serve: Serve, host: str) -> None:
    if host == "":
        assert serve(host).token, "everywhere: with a token"
        return
    with pytest.raises(WebError, match="choose another"):
        serve(host)
