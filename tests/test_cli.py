"""What a person at a terminal, or a script, sees."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import meshes
from conftest import Run
from quadrics.cli.main import COMMANDS, main


def test_a_segmentation_end_to_end(part: Path, program: Run) -> None:
    done = program("segment", part, "-o", "out", "--units", "mm")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("plane") == 6
    assert "lengths in mm" in done.stdout
    document = json.loads((part.parent / "out" / "segmentation.json").read_text())
    assert document["input"]["units"] == "mm"
    assert document["input"]["faces"] == len(np.load(part.parent / "out" / "labels.npy"))
    assert {"read_s", "total_s"} <= set(document["timing"])


def test_json_is_one_document_on_stdout(part: Path, program: Run) -> None:
    done = program("segment", part, "-o", "out", "--json")
    assert json.loads(done.stdout) == json.loads(
        (part.parent / "out" / "segmentation.json").read_text()
    )
    assert done.stderr == ""


def test_quiet_is_quiet(part: Path, program: Run) -> None:
    done = program("segment", part, "-o", "out", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_threads_and_repetition_change_nothing(part: Path, program: Run) -> None:
    outputs = []
    for number, threads in enumerate((1, 2, 2)):
        out = part.parent / f"out{number}"
        assert (
            program("segment", part, "-o", out, "--seed", 5, "--threads", threads).returncode == 0
        )
        document = json.loads((out / "segmentation.json").read_text())
        del document["timing"], document["options"]["threads"]
        outputs.append(((out / "labels.npy").read_bytes(), document))
    assert outputs[0] == outputs[1] == outputs[2]


@pytest.mark.parametrize(
    "arguments",
    [
        [], ["frobnicate"], ["segment"], ["segment", "x.stl"], ["segment", "x.stl", "-o"],
        ["segment", "x.stl", "-o", "o", "--regions", "many"],
        ["segment", "x.stl", "-o", "o", "--regions", "0"],
        ["segment", "x.stl", "-o", "o", "--preset", "best"],
        ["segment", "x.stl", "-o", "o", "--alpha", "nan"],
        ["segment", "x.stl", "-o", "o", "--beta", "-1"],
        ["segment", "x.stl", "-o", "o", "--reg", "3"],
        ["segment", "x.stl", "y.stl", "-o", "o"],
        ["info"],
    ],
)  # fmt: skip
def test_wrong_usage_is_one_line_and_exit_2(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main(arguments)
    except SystemExit as stopped:
        code = int(stopped.code or 0)
    assert code == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_labels_of_another_mesh_are_wrong_usage(
    part: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    np.save(part.with_name("labels.npy"), np.zeros(3, int))
    arguments = ["segment", str(part), "-o", str(part.with_name("out")), "--initial-labels"]
    assert main([*arguments, str(part.with_name("labels.npy"))]) == 2
    assert "432 faces" in capsys.readouterr().err


def output_refused(part: Path, out: Path, *more: str) -> bool:
    before = sorted(part.parent.rglob("*"))
    code = main(["segment", str(part), "-o", str(out), *more])
    return code == 4 and sorted(part.parent.rglob("*")) == before


def test_an_output_that_cannot_be_written_is_exit_4(
    part: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (part.parent / "file").write_text("mine")
    (part.parent / "full").mkdir()
    (part.parent / "full" / "mine.txt").write_text("mine")
    for out, more in (("file", ()), ("file/out", ()), ("full", ()), ("full", ("--overwrite",))):
        assert output_refused(part, part.parent / out, *more), out
        assert capsys.readouterr().err.count("\n") == 1
    assert output_refused(part, Path("/proc/quadrics/out"))
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert output_refused(part, part.parent / "new")


def test_an_earlier_result_is_replaced_only_when_told(
    part: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = part.with_name("out")
    assert main(["segment", str(part), "-o", str(out)]) == 0
    assert output_refused(part, out)
    assert "--overwrite" in capsys.readouterr().err
    assert main(["segment", str(part), "-o", str(out), "--overwrite"]) == 0
    assert len(list(out.iterdir())) == 4


def test_a_fault_of_ours_is_one_line_and_a_traceback_with_debug(
    part: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("quadrics._core.inspect", fail)
    assert main(["info", str(part)]) == 1
    assert capsys.readouterr().err.count("\n") == 1
    with pytest.raises(ZeroDivisionError):
        main(["info", str(part), "--debug"])


def test_info_shows_what_is_in_a_file(part: Path, program: Run) -> None:
    done = program("info", part)
    assert done.returncode == 0
    assert "3 x 2 x 1" in done.stdout
    seen = json.loads(program("info", part, "--json").stdout)
    assert (seen["faces"], seen["area"], seen["volume"]) == (
        432,
        pytest.approx(22),
        pytest.approx(6),
    )


def test_help_shows_every_command_and_what_it_takes(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in ([], *([name] for name in COMMANDS)):
        with pytest.raises(SystemExit) as stopped:
            main([*arguments, "--help"])
        assert stopped.value.code == 0
        shown = capsys.readouterr().out
        assert "examples:" in shown
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("quadrics 0.")


def test_an_unknown_option_is_named_with_the_help_of_its_command(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["segment", "part.stl", "-o", "out", "--regios", "5"])
    assert stopped.value.code == 2
    shown = capsys.readouterr().err
    assert shown == "quadrics segment: unknown argument --regios; see `quadrics segment --help`\n"


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys\nfrom quadrics.cli.main import main\n"
        "try: main(['segment', '--help'])\nexcept SystemExit: pass\n"
        "print([m for m in ('numpy', 'rich', 'PIL', 'quadrics._core') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_reader_that_stops_early_is_no_error(part: Path) -> None:
    command = f"{sys.executable} -m quadrics info {part} | head -1"
    done = subprocess.run(
        ["/bin/bash", "-o", "pipefail", "-c", command], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


def heed_ctrl_c() -> None:
    # A shell lets its background jobs ignore Ctrl-C, and children inherit that.
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_ctrl_c_ends_within_a_second_and_leaves_nothing(tmp_path: Path) -> None:
    # Large enough to be still at work when the signal comes.
    (tmp_path / "big.stl").write_bytes(meshes.stl(*meshes.rod(1200, 400)))
    command = [sys.executable, "-m", "quadrics", "segment", "big.stl", "-o", "out"]
    process = subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, text=True, preexec_fn=heed_ctrl_c
    )
    time.sleep(2.5)
    assert process.poll() is None, "the run was over before it could be interrupted"
    process.send_signal(signal.SIGINT)
    sent = time.perf_counter()
    _, shown = process.communicate(timeout=30)
    assert process.returncode == 130
    assert time.perf_counter() - sent < 1
    assert "interrupted" in shown
    assert "Traceback" not in shown
    assert [path.name for path in tmp_path.iterdir()] == ["big.stl"]
