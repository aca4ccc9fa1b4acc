"""Print what pyproject.toml asks for, so that one file names every dependency.

`pip install .[dev]` would build the Rust crate a second time, outside the incremental build.
"""

import re
from pathlib import Path

text = Path("pyproject.toml").read_text(encoding="utf-8")
# Python 3.10 has no tomllib; the two lists are plain enough for this.
for name in ("dependencies", "dev"):
    block = re.search(rf"^{name} = \[\n(.*?)^\]", text, re.MULTILINE | re.DOTALL)
    if block is None:
        raise SystemExit(f"pyproject.toml: no list named {name}")
    print("\n".join(re.findall(r'"([^"]+)"', block[1])))
