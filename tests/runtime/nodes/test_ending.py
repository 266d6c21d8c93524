"""A node that is interrupted ends in its own time: rospy's handler of the signal may wait for ever for itself."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from typing import List

import pytest

from tests.waiting import PATIENCE

pytest.importorskip("rospy", reason="ROS is not installed")

PROGRAM = """
import os, signal, sys, time
import rospy
from pursue_runtime.nodes import node
from pursue_runtime.nodes.node import Ending

node.master_is_gone = lambda: False
shutdowns, deep = [], []

def interrupt():
    for sign in (signal.SIGINT, signal.SIGTERM, signal.SIGINT):
        os.kill(os.getpid(), sign)

def shutdown(reason):
    deep.append(len(shutdowns))
    shutdowns.append(reason)
    interrupt()
    shutdowns.pop()

rospy.is_shutdown, rospy.signal_shutdown = lambda: False, shutdown
for sign in (signal.SIGINT, signal.SIGTERM):
    signal.signal(sign, lambda *_: rospy.signal_shutdown("as rospy does it"))
ending = Ending()
assert not ending.called
"""


def run(rest: str) -> List[str]:
    command = [sys.executable, "-c", PROGRAM + rest]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_a_signal_ends_the_node_when_it_waits_and_at_once() -> None:
    assert run("interrupt(); assert ending.called and not deep; print(ending.wait(linger=1000)); print(deep)") == [
        "0", "[0]"
    ]


def test_a_signal_that_does_not_wake_what_it_waits_for_ends_the_node() -> None:
    """Another thread receives it; it is the same with one that comes in the moment before it waits."""
    program = """
import threading
def receive():
    time.sleep(0.5)
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)
threading.Thread(target=receive, daemon=True).start()
print(ending.wait())
"""
    assert run(program) == ["0"]


def test_a_signal_ends_the_node_with_status_1_and_the_reason_where_its_master_is_gone() -> None:
    program = """
rospy.logerr = lambda text, *words: print(text % words)
node.master_is_gone = lambda: True
interrupt()
print(ending.wait(linger=1000), ending.reason)
"""
    reason = "the ROS master is gone"
    assert run(program) == [f"ends here: {reason}", f"1 {reason}"]


def test_a_node_that_ends_by_itself_does_not_look_for_its_master() -> None:
    assert run("node.master_is_gone = lambda: True; ending.end(0); print(ending.wait())") == ["0"]


def test_a_node_is_called_to_end_for_as_long_as_it_ends() -> None:
    assert run("ending.end(3); print(ending.called, ending.wait(), ending.called)") == ["True 3 True"]


def test_signals_that_come_while_it_ends_change_nothing() -> None:
    assert run("ending.end(3); print(ending.wait()); print(deep)") == ["3", "[0]"]


def test_a_thread_that_fails_ends_the_node_with_status_1_and_the_reason() -> None:
    program = """
from pursue_runtime.nodes.node import start_thread
rospy.logfatal = lambda text, *words: print(text % words)
start_thread("alarm", lambda: 1 / 0, ending)
print("status", ending.wait())
"""
    lines = run(program)
    assert lines[0] == "the node ends: its thread alarm failed: ZeroDivisionError('division by zero')"
    assert lines[-1] == "status 1"


def test_a_message_that_cannot_be_handled_ends_the_node_with_status_1_and_the_reason() -> None:
    program = """
from pursue_runtime.nodes.node import subscribe
rospy.logfatal = lambda text, *words: print((text % words).splitlines()[0])
rospy.Subscriber = lambda topic, kind, callback, **options: callback
handle = lambda message, robot: print(robot, 1 / len(message))
receive = subscribe("pursue/state", str, handle, ending, "bot1", queue_size=1)
receive("a")
assert not ending.called
receive("")
print("status", ending.wait())
"""
    assert run(program) == [
        "bot1 1.0",
        "the node ends: what it received on pursue/state could not be handled: ZeroDivisionError('division by zero')",
        "status 1",
    ]


def test_a_node_that_begins_anew_is_the_same_process_with_its_signals_as_they_were() -> None:
    program = """
from pursue_runtime.nodes import node
if node.ANEW in os.environ:
    before = signal.getsignal(signal.SIGTERM)
    node.lower_priority()
    print("again", os.getpid(), os.nice(0), before == signal.SIG_DFL)
else:
    node.lower_priority()
    ending = node.Ending()
    ending.renew()
    assert ending.wait(linger=1000) == 0 and ending.renewed
    print("first", os.getpid(), os.nice(0), flush=True)
    sys.argv = [sys.argv[1], *sys.argv[1:]]
    node.restart_process()
"""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "node.py")
        with open(file, "w", encoding="utf-8") as out:
            out.write(PROGRAM.split("node.master_is_gone")[0])
            out.write("rospy.is_shutdown, rospy.signal_shutdown = lambda: False, lambda _: None\n" + program)
        environment = {name: value for name, value in os.environ.items() if name != "PURSUE_ANEW"}
        command = [sys.executable, file, file]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 0, done.stderr
    (first, *one), (again, *two) = (line.split() for line in done.stdout.splitlines())
    assert (first, again, two) == ("first", "again", [*one, "True"])
