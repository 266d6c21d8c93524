"""`python -m pursue_gen` is `pursue-gen`."""

from pursue_gen.cli.start import main

main()
