"""Parse, call, map to an exit code."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from quadrics.cli import denoise, evaluate, info, noise, reproduce, segment
from quadrics.errors import InputError, OptionError, OutputError

#: What a shell and a scheduler see.
DONE, FAULT, USAGE, INPUT, OUTPUT, INTERRUPTED = 0, 1, 2, 3, 4, 130

COMMANDS = {
    "segment": segment,
    "info": info,
    "noise": noise,
    "evaluate": evaluate,
    "denoise": denoise,
    "reproduce": reproduce,
}

EXAMPLES = """\
examples:
  quadrics segment scan.stl -o scan/      recognise the surfaces of a scan
  quadrics info scan.stl                  what is in the file, what would be repaired
  quadrics COMMAND --help                 all options of a command

exit codes: 0 done, 1 a fault of ours, 2 wrong usage, 3 the input cannot be used,
4 the output cannot be written, 130 interrupted
"""


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line: the usage of thirty options would bury it."""

    def error(self, message: str) -> NoReturn:
        """Exit with the code for wrong usage."""
        self.exit(USAGE, f"{self.prog}: {message}; see `{self.prog} --help`\n")


def parser() -> Parser:
    """All commands and their options."""
    top = Parser(
        prog="quadrics",
        description="Recognises the surfaces that a scanned mechanical part was made of.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    top.add_argument("--version", action="store_true", help="print the version and stop")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", parser_class=Parser)
    for name, module in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=module.SUMMARY,
            description=f"{module.SUMMARY}.",
            epilog=module.EXAMPLES,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        module.add_arguments(command)
        command.add_argument("--debug", action="store_true", help="show where an error arose")
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code."""
    top = parser()
    options, unknown = top.parse_known_args(arguments)
    if unknown:
        # The parser on top would send the reader to its own help, which lists no options.
        command = f"quadrics {options.command}" if options.command else "quadrics"
        top.exit(USAGE, f"{command}: unknown argument {unknown[0]}; see `{command} --help`\n")
    if options.version:
        from quadrics import _core

        print(f"quadrics {_core.__version__}")
        return DONE
    if options.command is None:
        top.error("a command is missing")
    try:
        COMMANDS[options.command].run(options)
        sys.stdout.flush()
    except KeyboardInterrupt:
        print(f"\nquadrics {options.command}: interrupted, nothing written", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # The reader, such as `head`, has seen enough; Python would complain when it flushes.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except BaseException as error:  # A panic of the core is no Exception to PyO3.
        if options.debug or isinstance(error, SystemExit):
            raise
        print(f"quadrics {options.command}: {_one_line(error)}", file=sys.stderr)
        return _code(error)
    return DONE


def entry() -> NoReturn:
    """Run the program that `quadrics` and `python -m quadrics` are."""
    # NumPy's own threads would spin beside ours, a tenth of a short run, and have nothing to do.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # A terminal that knows no ± must not end a run that took minutes.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
    try:
        code = main()
    except KeyboardInterrupt:  # During the imports, say.
        code = INTERRUPTED
    sys.exit(code)


def _code(error: BaseException) -> int:
    codes = {OptionError: USAGE, InputError: INPUT, OutputError: OUTPUT}
    return next((code for kind, code in codes.items() if isinstance(error, kind)), FAULT)


def _one_line(error: BaseException) -> str:
    text = " ".join(str(error).split())
    if _code(error) != FAULT:
        return text
    if isinstance(error, MemoryError):
        return "out of memory; try a coarser mesh"
    return f"a fault of ours ({type(error).__name__}: {text}); --debug shows where"
