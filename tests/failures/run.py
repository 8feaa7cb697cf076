#!/usr/bin/python3
"""One failure case: run.py PROGRAM FOLDER. FOLDER/case.txt holds

  arguments: check scene.prm --set 'Contact/Law=x'
  exit: 2
  message: a regular expression that the one line on standard error must match

The case runs in a copy of its folder; afterwards the files of the copy must be unchanged, so that a
wrong input never destroys anything. A case may have `prepare:`, a shell line that is run first."""
import hashlib
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile


def read_case(file):
    case = {"exit": "2"}
    for line in file.read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            key, _, value = line.partition(":")
            case[key.strip()] = value.strip()
    return case


def contents(folder):
    return {
        str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in folder.rglob("*")
        if p.is_file() and p.name != ".lock"
    }


def faults(program, case, folder):
    if "prepare" in case:
        subprocess.run(case["prepare"], shell=True, check=True, cwd=folder)
    before = contents(folder)
    run = subprocess.run(
        [program, *shlex.split(case["arguments"])],
        cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120)
    lines = [line for line in run.stderr.splitlines() if line.strip()]
    if run.returncode != int(case["exit"]):
        yield f"exit code {run.returncode}, expected {case['exit']}"
    if len(lines) != 1:
        yield f"{len(lines)} lines on standard error, expected one"
    if not re.search(case["message"], run.stderr):
        yield f"no match for: {case['message']}"
    after = contents(folder)
    lost = [name for name in before if after.get(name) != before[name]]
    if lost:
        yield f"changed or removed: {', '.join(lost)}"
    print(f"$ trackbed {case['arguments']}\n{run.stderr}", end="")


def main():
    program, source = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / source.name
        shutil.copytree(source, folder)
        found = list(faults(program, read_case(source / "case.txt"), folder))
    for fault in found:
        print("FAULT:", fault)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
