"""`python -m quadrics` is the same program as `quadrics`."""

from quadrics.cli.main import entry

entry()
