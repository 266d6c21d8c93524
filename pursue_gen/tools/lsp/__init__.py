"""The language server: answers an editor's requests about a scenario while it is written.

Each module answers one kind of question about a `Document` and knows no editor; `server` translates for pygls.
"""
