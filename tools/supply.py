"""The delivery: wheel and source archive, each installed by pip in an empty environment and run; licences of all.

    python tools/supply.py [--python python3.12 ...]

For every Python named (by default this one) wheel and archive are built, installed with their dependencies, and
`pneumo` simulates and records away from the checkout. Then every distribution that was installed is listed with the
licence it declares, and `pip-audit` asks for known vulnerabilities of these versions, where its service is reachable.
The exit code is 1 when something did not run, a licence is none of those known to go with Apache-2.0, or there are
known vulnerabilities.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CLEAN = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME", "LD_LIBRARY_PATH")}
COMMANDS = (
    ("--help",),
    ("effects", "lugre_friction"),
    ("simulate", "--input", "step:2.5@0.1", "--seconds", "0.5", "--out", "run"),
    ("simulate", "--input", "run", "--out", "again"),
)  # the last one reads the file of the one before
LICENCES = r"Apache|BSD|MIT|ISC|PSF|Python Software|MPL|Mozilla|Zlib|Unlicense|Public Domain|any-OSI"
ASK = """
import importlib.metadata as m, json
def licence(d):
    named = [c.rpartition(" :: ")[2] for c in d.metadata.get_all("Classifier", []) if c.startswith("License ::")]
    return d.metadata.get("License-Expression") or ", ".join(named) or (d.metadata.get("License") or "").split("\\n")[0]
print(json.dumps(sorted({(d.name, d.version, licence(d)[:60]) for d in m.distributions()})))
"""


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", nargs="+", default=[sys.executable], metavar="PYTHON", help="to install for")
    return parser.parse_args()


def run(*command: str | Path, folder: Path) -> str:
    """Output of a command; CalledProcessError when it fails."""
    done = subprocess.run([*map(str, command)], cwd=folder, env=CLEAN, capture_output=True, text=True)
    if done.returncode:
        print(done.stdout[-2000:] + done.stderr[-2000:], file=sys.stderr)
    done.check_returncode()
    return done.stdout


def build(folder: Path) -> list[Path]:
    """Wheel and source archive of a copy of the files in git."""
    tree = folder / "tree"
    tree.mkdir()
    for name in run("git", "ls-files", "-z", folder=ROOT).split("\0"):
        if (ROOT / name).is_file() and name:
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            (tree / name).write_bytes((ROOT / name).read_bytes())
    run(sys.executable, "setup.py", "-q", "sdist", "-d", folder, folder=tree)
    (archive,) = folder.glob("*.tar.gz")
    run(sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", folder, archive, folder=folder)
    return [*folder.glob("*.whl"), archive]


def check(python: str, artifact: Path, folder: Path) -> list[tuple[str, str, str]]:
    """Install and run; name, version and licence of every installed distribution."""
    venv, place = folder / "venv", folder / "place"
    place.mkdir(parents=True)
    run(python, "-m", "venv", venv, folder=folder)
    run(venv / "bin" / "python", "-m", "pip", "install", "-q", artifact, folder=folder)
    for words in COMMANDS:
        run(venv / "bin" / "pneumo", *words, folder=place)
    return [tuple(one) for one in json.loads(run(venv / "bin" / "python", "-c", ASK, folder=place))]


def audit(found: set[tuple[str, str, str]], folder: Path) -> dict[str, list[str]] | None:
    """Known vulnerabilities by distribution, of those that the service knows; None when it cannot be asked."""
    venv, wanted = folder / "audit", folder / "installed.txt"
    wanted.write_text("".join(f"{name}=={version}\n" for name, version, _ in sorted(found) if name != "pneumo_ros"))
    try:
        run(sys.executable, "-m", "venv", venv, folder=folder)
        run(venv / "bin" / "python", "-m", "pip", "install", "-q", "pip-audit", folder=folder)
        command = [venv / "bin" / "pip-audit", "-r", wanted, "--no-deps", "--disable-pip", "-f", "json"]
        said = subprocess.run([*map(str, command)], cwd=folder, env=CLEAN, capture_output=True, text=True).stdout
        answered = [one for one in json.loads(said)["dependencies"] if "skip_reason" not in one]
    except (subprocess.CalledProcessError, ValueError):  # exit code 1 means vulnerabilities, which it then lists
        return None
    return {f"{one['name']} {one['version']}": [v["id"] for v in one["vulns"]] for one in answered} or None


def main() -> int:
    """Build, install, run, list, ask; 1 when something failed."""
    good, found = True, set[tuple[str, str, str]]()
    with tempfile.TemporaryDirectory(prefix="pneumo_ros_supply_") as name:
        folder = Path(name)
        for artifact in build(folder):
            for number, python in enumerate(arguments().python):
                place = folder / f"{artifact.suffix[1:]}_{number}"
                try:
                    found |= set(check(python, artifact, place))
                    said = "installed, simulated, recorded, replayed"
                except subprocess.CalledProcessError as error:
                    said, good = f"FAILED: {Path(str(error.cmd[0])).name} {' '.join(map(str, error.cmd[1:]))}", False
                print(f"{artifact.name:40s} {Path(python).name:12s} {said}", flush=True)
        audited = audit(found, folder)
    print(f"\n{'distribution':24s} {'version':14s} licence")
    for distribution, version, licence in sorted(found):
        known = bool(re.search(LICENCES, licence))
        good &= known
        print(f"{distribution:24s} {version:14s} {licence or '-'}{'' if known else '   UNKNOWN'}")
    if audited is None:
        print("\nknown vulnerabilities: not asked for, pip-audit or its service cannot be reached from here")
        return int(not good)
    bad = {name: known for name, known in audited.items() if known}
    print(f"\nknown vulnerabilities: {sum(map(len, bad.values()))}, in {len(audited)} distributions asked for")
    for name, known in bad.items():
        print(f"{name}: {', '.join(known)}")
    return int(not good or bool(bad))


if __name__ == "__main__":
    sys.exit(main())
