"""UPPAAL's files: networks (`TGA.xml`) and queries (`TCTL.q`)."""

from pursue_gen.tga.uppaal_read import read_network, read_query
from pursue_gen.tga.uppaal_write import write_network, write_query

__all__ = ["read_network", "read_query", "write_network", "write_query"]
