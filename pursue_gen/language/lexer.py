"""Colours for PuRSUE-ML wherever Pygments serves: Sphinx, LaTeX's minted, consoles. Needs pygments (optional)."""

from __future__ import annotations

from typing import Any, ClassVar, Dict, Iterator, List, Tuple

from pygments.lexer import Lexer
from pygments.token import Comment, Keyword, Name, Number, Punctuation, String, Text, Whitespace

from pursue_gen.language.kinds import KEYWORDS, STATEMENTS, VALUES
from pursue_gen.language.syntax import tokens_of
from pursue_gen.language.tokens import end_of, start_of

_COLOURS: Dict[str, Any] = {
    **dict.fromkeys(KEYWORDS, Keyword),
    **dict.fromkeys(STATEMENTS, Keyword.Declaration),
    **dict.fromkeys(VALUES, Keyword.Constant),
    **dict.fromkeys(("COLON", "COMMA", "LPAR", "RPAR"), Punctuation),
    "NAME": String, "WORD": Name, "TAIL": Comment.Preproc,
    "POSE": Comment.Special, "LINE_COMMENT": Comment.Single, "BLOCK_COMMENT": Comment.Multiline,
}  # fmt: skip


class PursueLexer(Lexer):  # type: ignore[misc] # pygments has no types
    """For scenarios in PuRSUE-ML, `*.pur`."""

    name = "PuRSUE-ML"
    aliases: ClassVar[List[str]] = ["pursue", "pursue-ml"]
    filenames: ClassVar[List[str]] = ["*.pur"]
    mimetypes: ClassVar[List[str]] = ["text/x-pursue"]
    url = ""

    def get_tokens_unprocessed(self, text: str) -> Iterator[Tuple[int, Any, str]]:
        """(offset, colour, words) of all that is in a text, blanks too."""
        at = 0
        for token in tokens_of(text) or ():
            if at < start_of(token):
                yield at, Whitespace, text[at : start_of(token)]
            number = Number.Float if "." in token else Number.Integer
            yield start_of(token), number if token.type == "NUMBER" else _COLOURS.get(token.type, Text), str(token)
            at = end_of(token)
        if at < len(text):
            yield at, Text if text[at:].strip() else Whitespace, text[at:]
