"""Pictures are well-formed whatever names they show, and the same at each run."""

from __future__ import annotations

from typing import List
from xml.etree import ElementTree

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.drawing import look


@given(st.text(), st.lists(st.text(), max_size=12, unique=True))
def test_any_name_gives_well_formed_svg(title: str, names: List[str]) -> None:
    looks = look.agent_looks(names)
    body = [look.patterns(looks, "p")]
    body += [look.text(1, 2, name) + look.mark(looks[name], 3, 4) for name in names]
    picture = look.svg(100, 50, title, title, body, "picture")
    root = ElementTree.fromstring(picture.encode("utf-8"))
    assert root.findtext("{http://www.w3.org/2000/svg}title") == look.clean(title).replace("\r\n", "\n").replace(
        "\r", "\n"
    )
    assert len(list(root.iter("{http://www.w3.org/2000/svg}pattern"))) == len(names)
    assert picture == look.svg(100, 50, title, title, body, "picture")
