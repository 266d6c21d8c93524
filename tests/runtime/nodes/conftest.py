"""The messages of a workspace, for tests of nodes that need no workspace."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

DEFINITIONS = Path(__file__).resolve().parents[3] / "templates" / "catkin" / "pursue_msgs" / "msg"


def _make_messages() -> None:
    """Make pursue_msgs from its definitions, as a workspace's build does, where no workspace is sourced."""
    from genpy.dynamic import generate_dynamic

    texts = {file.stem: file.read_text(encoding="utf-8") for file in DEFINITIONS.glob("*.msg")}
    package, messages, services = (ModuleType(f"pursue_msgs{part}") for part in ("", ".msg", ".srv"))
    for whole in ("SystemState", "OrderAnswer"):
        parts = [f"\n{'=' * 80}\nMSG: pursue_msgs/{name}\n{text}" for name, text in texts.items() if name != whole]
        for name, kind in generate_dynamic(f"pursue_msgs/{whole}", texts[whole] + "".join(parts)).items():
            setattr(messages, name.partition("/")[2], kind)
    services.Order = object  # type: ignore[attr-defined]
    package.msg, package.srv = messages, services  # type: ignore[attr-defined]
    sys.modules.update({"pursue_msgs": package, "pursue_msgs.msg": messages, "pursue_msgs.srv": services})


if importlib.util.find_spec("rospy") is not None and importlib.util.find_spec("pursue_msgs") is None:
    _make_messages()
