"""`python -m roulement` is the program `roulement`."""

from .program import main

main()
