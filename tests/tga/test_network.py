"""Networks as values: what they remember of themselves stays in their process."""

from __future__ import annotations

import pickle
import subprocess
import sys

from pursue_gen.tga.network import Edge, Guard, Test

EDGE = Edge("here", "there", assign=(("Pbot", 2),))


def test_an_edge_names_each_variable_once_in_its_order() -> None:
    tested = Edge(
        "here",
        "there",
        Guard(integers=((Test("b", 1), Test("a", 2)), (Test("b", 3),))),
        assign=(("c", 1), ("a", 0)),
    )
    assert tested.variables == ("b", "a", "c")


def test_an_edge_from_another_process_is_the_same() -> None:
    hash(EDGE)  # texts hash otherwise in another process, which must not take over this number
    look = "import pickle, sys; sys.stdout.write(str(hash(pickle.load(sys.stdin.buffer)) == hash(eval(sys.argv[1]))))"
    text = "__import__('pursue_gen.tga.network', fromlist=['Edge']).Edge('here', 'there', assign=(('Pbot', 2),))"
    command = [sys.executable, "-c", look, text]
    environment = {"PYTHONHASHSEED": "7", "PYTHONPATH": ":".join(filter(None, sys.path))}
    done = subprocess.run(command, input=pickle.dumps(EDGE), stdout=subprocess.PIPE, env=environment, check=True)
    assert done.stdout == b"True"
