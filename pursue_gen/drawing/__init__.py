"""Layout and SVG of places and people; knows no stage but the language."""
