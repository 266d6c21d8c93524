"""Programs that a process with ROS's modules becomes behave as those that start by themselves (preloaded.py)."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Dict, Iterator, List

import pytest
from preloaded import preloaded, process_of

from tests.waiting import PATIENCE

SCRIPT = """\
import os, sys, time
import beside
try:
    print(sys.argv[1:], os.getcwd(), os.environ["WORD"], beside.THERE, __name__, os.getpid(), flush=True)
    print("and this", file=sys.stderr, flush=True)
    if sys.argv[1] == "wait":
        time.sleep(600)
except KeyboardInterrupt:
    sys.exit(7)
if sys.argv[1] == "fail":
    raise ValueError("said")
sys.exit(int(sys.argv[1]))
"""


@pytest.fixture(name="variables", scope="module")
def _variables(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Dict[str, str]]:
    path = f"{Path(sys.executable).parent}:/usr/bin:/bin"
    if shutil.which("g++") is None:
        pytest.skip("the programs are compiled, which needs g++")
    with preloaded(tmp_path_factory.mktemp("preloaded"), path, modules=("json",)) as programs:
        yield {"PATH": f"{programs}:{path}", "WORD": "told"}


@pytest.fixture(name="command")
def _command(tmp_path: Path) -> List[str]:
    (tmp_path / "script").write_text(SCRIPT)
    (tmp_path / "beside.py").write_text("THERE = 'imported'\n")
    return ["python3", str(tmp_path / "script")]


def test_a_script_has_its_arguments_folder_variables_and_files(
    variables: Dict[str, str], command: List[str], tmp_path: Path
) -> None:
    done = subprocess.run(
        [*command, "3", "__name:=x"], env=variables, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 3
    assert done.stdout.startswith(f"['3', '__name:=x'] {tmp_path} told imported __main__ ")
    assert done.stderr == "and this\n"


@pytest.mark.parametrize(("end", "status"), [("", 0), ("sys.exit()", 0), ("sys.exit(300)", 44), ("sys.exit('so')", 1)])
def test_threads_and_functions_for_its_end_come_first(
    variables: Dict[str, str], command: List[str], end: str, status: int
) -> None:
    late = "threading.Thread(target=lambda: (time.sleep(0.2), print('thread'))).start()"
    code = f"import atexit, sys, threading, time\natexit.register(print, 'end')\n{late}\nprint('first')\n{end}\n"
    Path(command[1]).write_text(code)
    done = subprocess.run(
        command, env=variables, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False
    )
    assert (done.stdout, done.returncode) == ("first\nthread\nend\n", status)
    assert done.stderr == ("so\n" if status == 1 else "")


def test_what_it_does_not_catch_is_printed(variables: Dict[str, str], command: List[str]) -> None:
    done = subprocess.run([*command, "fail"], env=variables, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.endswith("ValueError: said\n")


@pytest.mark.parametrize(
    ("sign", "status"), [(signal.SIGINT, 7), (signal.SIGTERM, -signal.SIGTERM), (signal.SIGKILL, -signal.SIGKILL)]
)
def test_signals_reach_it(variables: Dict[str, str], command: List[str], sign: signal.Signals, status: int) -> None:
    with subprocess.Popen([*command, "wait"], env=variables, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        child = int(process.stdout.readline().split()[-1])
        assert process_of(process.pid) == child
        process.send_signal(sign)
        assert process.wait(PATIENCE) == status
    deadline = time.monotonic() + PATIENCE
    while _is_there(child):
        assert time.monotonic() < deadline
        time.sleep(0.01)


def test_who_kills_it_by_its_own_number_ends_what_was_started(variables: Dict[str, str], command: List[str]) -> None:
    code = "import os; os.kill(os.getpid(), 9)"
    Path(command[1]).write_text(code)
    assert subprocess.run(command, env=variables, check=False).returncode == -signal.SIGKILL


def test_lines_are_not_kept_back_where_the_variable_says_so(variables: Dict[str, str], command: List[str]) -> None:
    Path(command[1]).write_text("import os\nprint('said')\nos._exit(0)\n")
    said = {
        kept: subprocess.run(
            command, env={**variables, "PYTHONUNBUFFERED": kept}, stdout=subprocess.PIPE, text=True, check=True
        ).stdout
        for kept in ("", "1")
    }
    assert said == {"": "", "1": "said\n"}


def test_other_uses_of_python_are_python_s_own(variables: Dict[str, str]) -> None:
    code = "import sys; print(sys.argv, 'json' in sys.modules)"
    done = subprocess.run(["python3", "-c", code, "x"], env=variables, stdout=subprocess.PIPE, text=True, check=True)
    assert done.stdout == "['-c', 'x'] False\n"


def _is_there(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True
