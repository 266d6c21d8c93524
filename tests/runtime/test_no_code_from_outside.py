"""A robot executes nothing that comes from outside: all programs of a workspace, and the planner's, are searched."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Dict, Iterator, List

import pytest

ROOT = Path(__file__).resolve().parents[2]

CALLS = {"eval", "exec", "compile", "__import__", "execfile"}
"""Built-in functions that make code of text."""
MODULES = {"pickle", "cPickle", "_pickle", "marshal", "shelve", "dill", "cloudpickle", "joblib", "imp", "runpy", "code",
           "codeop", "ctypes", "commands", "pty"}  # fmt: skip
METHODS = {"os.system", "os.popen", "yaml.unsafe_load", "yaml.full_load", "yaml.load_all", "yaml.unsafe_load_all",
           "yaml.full_load_all", "subprocess.getoutput", "subprocess.getstatusoutput",
           "asyncio.create_subprocess_shell"}  # fmt: skip
SAFE = ("SafeLoader", "CSafeLoader")


def programs() -> Dict[str, str]:
    """name → text of every Python file that runs on a robot: nodes and their modules, tests, what makes other plans."""
    parts = ("pursue_runtime", "pursue_gen/tools/replanning", "pursue_gen/tools/transport", "templates")
    files = [path for part in parts for path in sorted((ROOT / part).rglob("*.py"))]
    assert len(files) > 60
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in files}


PROGRAMS = programs()


def findings(text: str) -> List[str]:
    """Whatever could execute what it is given, as `line: what`."""
    return [f"{getattr(node, 'lineno', 0)}: {what}" for node in ast.walk(ast.parse(text)) for what in _found(node)]


def _found(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Import):
        yield from (f"import {name.name}" for name in node.names if name.name.split(".")[0] in MODULES)
    elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in MODULES:
        yield f"from {node.module} import"
    elif isinstance(node, ast.Call):
        name = _dotted(node.func)
        if name in CALLS or name in METHODS or name.startswith("builtins."):
            yield name
        if name == "yaml.load" and not _safe(node):
            yield "yaml.load without a safe loader"
        for keyword in node.keywords:
            if keyword.arg == "shell" and not (isinstance(keyword.value, ast.Constant) and not keyword.value.value):
                yield "shell="


def _dotted(node: ast.AST) -> str:
    """`a.b.c` for such an expression, `?.c` where what stands before is none."""
    if isinstance(node, ast.Attribute):
        return f"{_dotted(node.value)}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else "?"


def _safe(call: ast.Call) -> bool:
    """True if each loader that may be used is a safe one: `yaml.SafeLoader`, or getattr(yaml, <one>, <another>)."""
    loaders = [*call.args[1:2], *(keyword.value for keyword in call.keywords if keyword.arg == "Loader")]
    if len(loaders) != 1:
        return False
    choice = loaders[0]
    if isinstance(choice, ast.Call) and _dotted(choice.func) == "getattr" and len(choice.args) == 3:
        named = choice.args[1]
        return isinstance(named, ast.Constant) and named.value in SAFE and _named_safe(choice.args[2])
    return _named_safe(choice)


def _named_safe(loader: ast.expr) -> bool:
    return _dotted(loader) in {f"yaml.{name}" for name in SAFE}


@pytest.mark.parametrize("name", sorted(PROGRAMS))
def test_no_program_on_a_robot_executes_what_it_is_given(name: str) -> None:
    assert findings(PROGRAMS[name]) == []


def test_modules_that_are_chosen_while_it_runs_are_named_in_the_code() -> None:
    """Controllers import the messages of move_base only where a setting asks for them, by names that stand there."""
    for name, text in PROGRAMS.items():
        asked = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)]
        imports = [node for node in asked if _dotted(node.func).endswith("import_module")]
        assert not imports or name in ("pursue_runtime/nodes/robot_link.py", "pursue_runtime/needs.py"), name
        for call in asked:
            if _dotted(call.func).split(".")[-1] == "needed":
                assert all(isinstance(given, ast.Constant) for given in call.args[:2]), (name, call.lineno)


@pytest.mark.parametrize("text", [
    "eval(said)", "exec(open(path).read())", "compile(said, '', 'exec')", "__import__(said)", "import pickle",
    "from marshal import loads", "import yaml\nyaml.load(said)", "import yaml\nyaml.load(said, Loader=yaml.Loader)",
    "import yaml\nyaml.load(said, getattr(yaml, 'CLoader', yaml.SafeLoader))", "import yaml\nyaml.unsafe_load(said)",
    "import subprocess\nsubprocess.run(said, shell=True)", "import os\nos.system(said)",
    "import subprocess\nsubprocess.Popen(said, shell=chosen)",
])  # fmt: skip
def test_the_search_finds_what_it_is_for(text: str) -> None:
    assert findings(text)


@pytest.mark.parametrize("text", [
    "import re\nre.compile(said)", "import yaml\nyaml.safe_load(said)", "import yaml\nyaml.load(said, yaml.SafeLoader)",
    "import yaml\nyaml.load(said, Loader=getattr(yaml, 'CSafeLoader', yaml.SafeLoader))",
    "import subprocess\nsubprocess.run([said])",
])  # fmt: skip
def test_the_search_leaves_the_rest_alone(text: str) -> None:
    assert findings(text) == []
