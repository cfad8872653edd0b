#!/usr/bin/env python3
"""clang-tidy over src/ and simd/dispatch.cpp, only where something changed since the last clean run.

A file is known clean by a hash over itself, every header of ours it reaches, its compile command, the configuration
and the version of clang-tidy; build/tidy/ holds one empty file per such hash.
"""
import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
commands_folder = root / "build/clang"
clean_folder = root / "build/tidy"
include = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def reach(path, seen):
    """Adds path and all it includes with quotes to seen."""
    if path in seen:
        return
    seen.add(path)
    for name in include.findall(path.read_text()):
        for folder in (path.parent, root / "src", root):
            if (folder / name).is_file():
                reach((folder / name).resolve(), seen)
                break


def key(entry, common):
    files = set()
    reach(pathlib.Path(entry["file"]), files)
    digest = hashlib.sha256(common + entry["command"].encode())
    for path in sorted(files):
        digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def tidy(entry):
    run = subprocess.run(["clang-tidy", "--quiet", "-p", str(commands_folder), entry["file"]],
                         capture_output=True, text=True)
    return run.returncode, run.stdout + ("" if run.returncode == 0 else run.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    version = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    # The line naming the host's processor says nothing about the checks.
    common = b"".join(line for line in version.splitlines() if b"CPU" not in line) + (root / ".clang-tidy").read_bytes()
    clean_folder.mkdir(parents=True, exist_ok=True)

    entries = []
    for entry in json.loads((commands_folder / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        if (root / "src" in path.parents or path == root / "simd/dispatch.cpp") and path.is_file():
            entries.append((entry, clean_folder / key(entry, common)))
    todo = [(entry, mark) for entry, mark in entries if not mark.exists()]
    print(f"{len(todo)} of {len(entries)} files to look at", flush=True)

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for (entry, mark), (status, text) in zip(todo, pool.map(tidy, (entry for entry, _ in todo))):
            if status == 0:
                mark.touch()
            else:
                failed += 1
                print(text.rstrip(), flush=True)
    for mark in set(clean_folder.iterdir()) - {mark for _, mark in entries}:
        mark.unlink()
    if failed:
        print(f"{failed} files with complaints")
    return 1 if failed else 0


sys.exit(main())
