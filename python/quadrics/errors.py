"""What can go wrong, by whose fault it is; the command line turns each into its exit code."""


class QuadricsError(Exception):
    """The parent of all of them: one line that says what is wrong, where, and what to do."""


class InputError(QuadricsError, ValueError):
    """The input cannot be used (exit code 3)."""


class OutputError(QuadricsError, OSError):
    """The output cannot be written (exit code 4)."""


class OptionError(QuadricsError, ValueError):
    """An option, or a start, does not fit (exit code 2)."""
