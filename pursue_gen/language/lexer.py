"""Colours for PuRSUE-ML wherever Pygments serves: Sphinx, LaTeX's minted, consoles. Needs pygments (optional)."""

from __future__ import annotations

from typing import Any, ClassVar, Dict, List

from pygments.lexer import RegexLexer, words
from pygments.token import Comment, Keyword, Name, Number, Punctuation, String, Text, Whitespace

from pursue_gen.language.messages import FORMS, KEYWORDS

_CONSTANTS = ("TRUE", "FALSE", "IS_TRUE", "IS_FALSE")
_OPENS = tuple(sorted(KEYWORDS[kind] for kind in FORMS))
_VALUES = tuple(sorted(KEYWORDS[kind] for kind in _CONSTANTS))
_OTHERS = tuple(sorted(word for kind, word in KEYWORDS.items() if kind not in FORMS and kind not in _CONSTANTS))


class PursueLexer(RegexLexer):  # type: ignore[misc] # pygments has no types
    """For scenarios in PuRSUE-ML, `*.pur`."""

    name = "PuRSUE-ML"
    aliases: ClassVar[List[str]] = ["pursue", "pursue-ml"]
    filenames: ClassVar[List[str]] = ["*.pur"]
    mimetypes: ClassVar[List[str]] = ["text/x-pursue"]
    url = ""

    tokens: ClassVar[Dict[str, Any]] = {
        "root": [
            (r"\s+", Whitespace),
            (r"//[ \t]*\[[^\n]*", Comment.Special),
            (r"//[^\n]*", Comment.Single),
            (r"/\*[\s\S]*?\*/", Comment.Multiline),
            (r"control[ \t]*:[^\n]*", Comment.Preproc),
            (r'"[^"\n]*"', String),
            (words(_OPENS, prefix=r"(?<!\w)", suffix=r"(?!\w|-\w)"), Keyword.Declaration),
            (words(_VALUES, prefix=r"(?<!\w)", suffix=r"(?!\w|-\w)"), Keyword.Constant),
            (words(_OTHERS, prefix=r"(?<!\w)", suffix=r"(?!\w|-\w)"), Keyword),
            (r"[+-]?\d+\.\d+(?![\w.])", Number.Float),
            (r"[+-]?\d+(?![\w.])", Number.Integer),
            (r"[^\W\d]\w*(-\w+)*", Name),
            (r"[():,]", Punctuation),
            (r".", Text),
        ]
    }
