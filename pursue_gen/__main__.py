"""`python -m pursue_gen` is `pursue-gen`."""

from pursue_gen.cli.app import main

main()
