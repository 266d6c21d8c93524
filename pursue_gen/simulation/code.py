"""The generated modules that need no ROS, loaded from their texts: nothing is written, and nothing else sees them.

The modules of a workspace import each other by name (`from pursue_library import due`). Here they find each other only
while they are loaded; afterwards `sys.modules` is as it was, so that modules of several workspaces live side by side.
"""

from __future__ import annotations

import re
import sys
from types import ModuleType
from typing import Any, Dict, Iterable, List, Mapping

from pursue_gen.workspace.packages import environment, templates_dir

_IMPORT = re.compile(r"^(?:from|import) +(\w+)", re.MULTILINE)
_SCRIPT = re.compile(r"src/\w+/scripts/(\w+)\.py")


def sources(files: Mapping[str, bytes]) -> Dict[str, str]:
    """module → its text, of a workspace as `workspace.generate` returns it.

    Packages have modules in common; what differs is the package's name in the first docstring, so any copy will do.
    """
    found: Dict[str, str] = {}
    for path, content in sorted(files.items()):
        match = _SCRIPT.fullmatch(path)
        if match:
            found.setdefault(match.group(1), content.decode())
    return found


def rendered(kinds: Iterable[str], values: Mapping[str, Any]) -> Dict[str, str]:
    """file name → text of the scripts of these kinds of packages, rendered with these values."""
    templates = templates_dir()
    jinja = environment(templates)
    return {
        path.stem: jinja.get_template(path.relative_to(templates).as_posix()).render(values)
        for kind in kinds
        for path in sorted((templates / kind / "scripts").glob("*.j2"))
    }


def load(texts: Mapping[str, str], names: Iterable[str]) -> Dict[str, ModuleType]:
    """The modules of these names, and those that they import from the same texts (module → its text).

    Raises ImportError for what is neither here nor installed.
    """
    loaded: Dict[str, ModuleType] = {}
    hidden = {name: sys.modules[name] for name in texts if name in sys.modules}
    try:
        for name in names:
            _load(name, texts, loaded)
    finally:
        for name in texts:
            sys.modules.pop(name, None)
        sys.modules.update(hidden)
    return loaded


def _load(name: str, texts: Mapping[str, str], loaded: Dict[str, ModuleType]) -> None:
    if name in loaded:
        return
    if name not in texts:
        raise ImportError(f"the workspace has no module {name}")
    needs: List[str] = [other for other in _IMPORT.findall(texts[name]) if other in texts and other != name]
    for other in needs:
        _load(other, texts, loaded)
    module = ModuleType(name)
    module.__file__ = f"<generated {name}.py>"
    loaded[name] = sys.modules[name] = module
    exec(compile(texts[name], module.__file__, "exec"), module.__dict__)
