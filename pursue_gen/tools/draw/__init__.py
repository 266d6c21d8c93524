"""`pursue-gen draw`: a page on which a scenario is drawn and written at the same time.

`operations` changes a text, `view` says what the page shows of it; neither knows HTTP. `page` answers the page's
requests, `server` carries them, `work` solves in a process of its own.
"""
