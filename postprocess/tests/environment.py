"""Installs what the tests in Python need into the environment this runs in, without the program.

`pip install --editable` would compile the program, which the tests are given by ALEWIFE_BIN:
packages are those of `pyproject.toml`, our own are found where they lie, and so are the commands.
"""

from __future__ import annotations

import os
import shutil
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


def install_sessions() -> None:
    """Put the extension module that lies beside the program where Python finds it.

    Without one, as where a program is tested that was built by itself, sessions are not tested.
    """
    installed = Path(sysconfig.get_path("platlib")) / "alewife_session.abi3.so"
    beside = Path(os.environ["ALEWIFE_BIN"]).parent
    built = [beside / f"libalewife_session.{kind}" for kind in ("so", "dylib")]
    found = next((one for one in built if one.is_file()), None)
    installed.unlink(missing_ok=True)
    if found is None:
        print(f"note: no libalewife_session beside {beside}; sessions are not tested")
    else:
        shutil.copyfile(found, installed)


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
    install_sessions()
    for script in (ROOT / "postprocess" / "commands" / "scripts").iterdir():
        command = Path(sysconfig.get_path("scripts")) / script.name
        text = script.read_text(encoding="utf-8").removeprefix("#!python\n")
        command.write_text(f"#!{sys.executable}\n{text}", encoding="utf-8")
        command.chmod(0o755)


if __name__ == "__main__":
    main()
