"""Installs what the tests in Python need into the environment this runs in, without the program.

`pip install --editable` would compile the program, which the tests are given by ALEWIFE_BIN:
packages are those of `pyproject.toml`, our own are found where they lie, and so are the commands.
"""

from __future__ import annotations

import subprocess
import sys
import sysconfig
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def requirements(extra: str, project: dict) -> list[str]:
    """What an extra asks for, other extras of this project replaced by what they ask for."""
    found = []
    for wanted in project["optional-dependencies"][extra]:
        name, _, rest = wanted.partition("[")
        if name == project["name"]:
            for other in rest.rstrip("]").split(","):
                found += requirements(other, project)
        else:
            found.append(wanted)
    return found


def main() -> None:
    """Install, unless the same was installed before."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    stamp = Path(sys.prefix) / "installed.toml"
    if not stamp.is_file() or stamp.read_text(encoding="utf-8") != text:
        project = tomllib.loads(text)["project"]
        wanted = project["dependencies"] + requirements("test", project)
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-compile"]
        pip.append("--disable-pip-version-check")
        subprocess.run([*pip, *wanted], check=True)
        stamp.write_text(text, encoding="utf-8")
    sources = Path(sysconfig.get_path("purelib")) / "alewife.pth"
    sources.write_text(f"{ROOT / 'postprocess' / 'src'}\n", encoding="utf-8")
    for script in (ROOT / "postprocess" / "commands" / "scripts").iterdir():
        command = Path(sysconfig.get_path("scripts")) / script.name
        text = script.read_text(encoding="utf-8").removeprefix("#!python\n")
        command.write_text(f"#!{sys.executable}\n{text}", encoding="utf-8")
        command.chmod(0o755)


if __name__ == "__main__":
    main()
