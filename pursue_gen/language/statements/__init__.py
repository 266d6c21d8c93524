"""The statements of the language: a module for each kind, which says what is different with it (`language.kinds`)."""
