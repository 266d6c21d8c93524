"""PuRSUE-gen: from a scenario in PuRSUE-ML to a ROS 1 workspace with one proven controller per robot.

All names of `api` are here, too (docs/api.md): `import pursue_gen`, then `pursue_gen.read("my_floor.pur")`.
"""

import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, List


def _use_own_runtime() -> None:
    """Import the run time that was installed with this package: beside it, or by catkin within it.

    A sourced workspace puts its own copy, which may be older, on PYTHONPATH.
    """
    package = Path(__file__).resolve().parent
    within = package / "_runtime" / "pursue_runtime"
    folder = within if within.is_dir() else package.parent / "pursue_runtime"
    imported = sys.modules.get("pursue_runtime")
    if imported is not None and Path(imported.__file__ or "").resolve().parent == folder:
        return
    spec = importlib.util.spec_from_file_location(
        "pursue_runtime", folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    if spec is None or spec.loader is None or not folder.is_dir():
        return  # installed elsewhere: Python finds it
    for name in [name for name in sys.modules if name.split(".")[0] == "pursue_runtime"]:
        del sys.modules[name]
    module = importlib.util.module_from_spec(spec)
    sys.modules["pursue_runtime"] = module
    spec.loader.exec_module(module)


_use_own_runtime()

from pursue_runtime import __version__ as __version__  # noqa: E402 (the own one)

if TYPE_CHECKING:
    from pursue_gen.api import *  # noqa: F403


def __getattr__(name: str) -> Any:
    """A name of `api`, which is imported now: whoever wants a part of the project alone need not wait for it."""
    if name.startswith("_") or importlib.util.find_spec(f"{__name__}.{name}") is not None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")  # a part that is imported by its name
    api = importlib.import_module(f"{__name__}.api")
    if name not in api.__all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(api, name)


def __dir__() -> List[str]:
    return sorted({*globals(), *importlib.import_module(f"{__name__}.api").__all__})
