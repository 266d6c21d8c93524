"""A headless Chromium, driven over the DevTools protocol: what a person does with a page, and what they see."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional

from tornado.websocket import WebSocketClientConnection, websocket_connect

from tests.waiting import PATIENCE


def program() -> Optional[str]:
    """Where Chromium is on this machine."""
    found = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))
    return next((path for path in found if path), None)


class Browser:
    """One page of one Chromium. `complaints` are exceptions of scripts, and what the browser refused."""

    def __init__(self, folder: Path) -> None:
        path = program()
        assert path is not None
        options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"]
        options += ["--disable-background-networking", "--remote-debugging-port=0", f"--user-data-dir={folder}"]
        self.complaints: List[str] = []
        self._number = 0
        self._session = ""
        self._socket: Optional[WebSocketClientConnection] = None
        self._loop = asyncio.new_event_loop()
        self._process = subprocess.Popen(
            [path, *options, "about:blank"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, start_new_session=True,
        )
        try:
            self._socket = self._run(self._connect(folder / "DevToolsActivePort"))
            target = self._call("Target.createTarget", url="about:blank")["targetId"]
            self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
            for domain in ("Page", "Runtime", "Log"):
                self._call(f"{domain}.enable")
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Ends Chromium and its children."""
        try:
            if self._socket is not None:
                self._run(self._drain(self._socket), 5.0)
        except asyncio.TimeoutError:
            pass  # it is ended all the same
        finally:
            for sign in (signal.SIGTERM, signal.SIGKILL):
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self._process.pid, sign)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._process.wait(10)
                    break
            self._loop.close()

    # What a person does -----------------------------------------------------------------------------------------------

    def open(self, url: str) -> None:
        """Goes to a page."""
        answer = self._call("Page.navigate", url=url)
        assert "errorText" not in answer, answer
        self.wait("document.readyState === 'complete'")

    def screen(self, width: int, height: int) -> None:
        """Looks at it on a screen of this size; a narrow one is a phone's."""
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                   mobile=width < 500)

    def dark(self, on: bool) -> None:
        """Looks at it on a device that prefers dark colours, or light ones."""
        feature = {"name": "prefers-color-scheme", "value": "dark" if on else "light"}
        self._call("Emulation.setEmulatedMedia", features=[feature])

    def click(self, selector: str) -> None:
        """Presses the left button in the middle of an element."""
        middle = ("(() => { const e = document.querySelector(%s); e.scrollIntoView({block: 'center'}); "
                  "const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()")
        x, y = self.value(middle % json.dumps(selector))
        for kind in ("mousePressed", "mouseReleased"):
            self._call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def key(self, key: str, code: int, text: str = "", modifiers: int = 0) -> None:
        """Presses a key; `modifiers`: 2 for Ctrl, 8 for Shift, or their sum."""
        more = {"windowsVirtualKeyCode": code, "text": text, "modifiers": modifiers}
        for kind in ("keyDown", "keyUp"):
            self._call("Input.dispatchKeyEvent", type=kind, key=key, code=key, **more)

    def write(self, text: str) -> None:
        """Types a text where the cursor is."""
        self._call("Input.insertText", text=text)

    def press(self, x: float, y: float, *to: float) -> None:
        """Presses the left button at a point of the window; holds it while going to another one (`to`: x, y)."""
        self._call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", clickCount=1)
        if to:
            for part in (0.3, 0.7, 1.0):
                x_, y_ = x + part * (to[0] - x), y + part * (to[1] - y)
                self._call("Input.dispatchMouseEvent", type="mouseMoved", x=x_, y=y_, button="left", buttons=1)
        x, y = to or (x, y)
        self._call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, button="left", clickCount=1)

    def touch(self, *paths: List[List[float]]) -> None:
        """Fingers, each along a path of points [x, y] of the same length, all at once."""
        for step in range(len(paths[0])):
            points = [{"x": path[step][0], "y": path[step][1], "id": k} for k, path in enumerate(paths)]
            self._call("Input.dispatchTouchEvent", type="touchMove" if step else "touchStart", touchPoints=points)
        self._call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    # What they see ----------------------------------------------------------------------------------------------------

    def value(self, expression: str) -> Any:
        """The value of an expression in the page."""
        answer = self._call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def text(self, selector: str) -> str:
        """What an element says."""
        return str(self.value(f"document.querySelector({json.dumps(selector)}).textContent"))

    def wait(self, expression: str, patience: float = PATIENCE) -> Any:
        """Waits until an expression is true; its value."""
        deadline = time.monotonic() + patience
        while True:
            value = self.value(expression)
            if value:
                return value
            if time.monotonic() > deadline:
                seen = self.value("document.body.innerText")
                raise AssertionError(f"not within {patience} s: {expression}\n{self.complaints}\n{seen}")
            time.sleep(0.05)

    def axe(self, file: str) -> List[str]:
        """What axe-core (the file of its program) finds that keeps people from using the page."""
        self._call("Runtime.evaluate", expression=Path(file).read_text(encoding="utf-8"))
        where = "one.nodes.map((node) => node.target).join(' ')"
        found = f"({{violations}}) => violations.map((one) => `${{one.id}}: ${{{where}}}`)"
        return list(self.value(f"axe.run(document, {{resultTypes: ['violations']}}).then({found})"))

    def picture(self, whole: bool = False) -> bytes:
        """A PNG of what is seen, or of the whole page."""
        return base64.b64decode(self._call("Page.captureScreenshot", captureBeyondViewport=whole)["data"])

    # The protocol -----------------------------------------------------------------------------------------------------

    def _run(self, work: Any, patience: float = PATIENCE) -> Any:
        return self._loop.run_until_complete(asyncio.wait_for(work, patience))

    async def _connect(self, file: Path) -> WebSocketClientConnection:
        while not (file.is_file() and len(file.read_text().splitlines()) == 2):
            assert self._process.poll() is None, "Chromium has ended"
            await asyncio.sleep(0.05)
        port, path = file.read_text().splitlines()
        return await websocket_connect(f"ws://127.0.0.1:{port}{path}", max_message_size=1 << 26)

    def _call(self, method: str, **params: Any) -> Dict[str, Any]:
        self._number += 1
        message: Dict[str, Any] = {"id": self._number, "method": method, "params": params}
        if self._session:
            message["sessionId"] = self._session
        answer: Dict[str, Any] = self._run(self._answer(json.dumps(message)))
        return answer

    @staticmethod
    async def _drain(connection: WebSocketClientConnection) -> None:
        connection.close()
        while await connection.read_message() is not None:
            pass
        await asyncio.sleep(0.1)

    async def _answer(self, message: str) -> Dict[str, Any]:
        assert self._socket is not None
        await self._socket.write_message(message)
        while True:
            text = await self._socket.read_message()
            assert text is not None, "Chromium has closed the connection"
            heard = json.loads(text)
            if heard.get("id") == self._number:
                assert "error" not in heard, (message, heard)
                result: Dict[str, Any] = heard["result"]
                return result
            if heard.get("method") == "Page.javascriptDialogOpening":  # whoever leaves a page leaves it all the same
                leave = {"id": 0, "method": "Page.handleJavaScriptDialog", "params": {"accept": True}}
                await self._socket.write_message(json.dumps({**leave, "sessionId": self._session}))
            if heard.get("method") == "Runtime.exceptionThrown":
                self.complaints.append(str(heard["params"]["exceptionDetails"]))
            if heard.get("method") == "Log.entryAdded" and heard["params"]["entry"]["source"] != "network":
                self.complaints.append(str(heard["params"]["entry"]["text"]))


@contextlib.contextmanager
def browser(folder: Path) -> Iterator[Browser]:
    """A Chromium for as long as it is needed."""
    there = Browser(folder)
    try:
        yield there
    finally:
        there.close()
