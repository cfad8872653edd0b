#!/usr/bin/env python3
"""check_docs.py scene_reference|man|examples|links SOURCE_FOLDER PROGRAM: compares the documents with the program."""
import pathlib
import re
import subprocess
import sys
import tempfile

check, source, program = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]


def output(*arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def options(help_text):
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", help_text))


def scene_reference():
    path = source / "docs/scene-reference.md"
    if path.read_text() != output("--help-scene"):
        return [f"{path} is out of date; write it anew: {program} --help-scene > {path}"]
    return []


def man():
    page = (source / "docs/sandlane.1").read_text().replace("\\-", "-")
    commands = re.findall(r"^  ([a-z]+)  ", output("--help").split("Subcommands:")[1], re.MULTILINE)
    flags = "\n".join(line for line in page.splitlines() if "Fl " in line)
    documented = {"-" + name for name in re.findall(r" (-[a-z][a-z-]+)", flags)}
    missing = [f"{c}: the command" for c in commands if f".Cm {c}" not in page]
    for command in [(), *((c,) for c in commands)]:
        for option in sorted(options(output(*command, "--help")) - documented):
            missing.append(f"{' '.join(command)} {option}")
    return [f"docs/sandlane.1 lacks {m}" for m in missing]


def examples():
    problems = []
    for path in [source / "README.md", *sorted((source / "docs").glob("*.md"))]:
        for scene in re.findall(r"^```toml\n(.*?)^```", path.read_text(), re.MULTILINE | re.DOTALL):
            with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
                file.write(scene)
                file.flush()
                run = subprocess.run([program, "check", file.name], capture_output=True, text=True)
                if run.returncode != 0:
                    problems.append(f"{path}: a scene in it is refused: {run.stderr}")
    return problems


def links():
    problems = []
    for path in [*source.glob("*.md"), *(source / "docs").glob("*.md")]:
        for link in re.findall(r"\]\(([^)#:]+)[)#]", path.read_text()):
            if not (path.parent / link).exists():
                problems.append(f"{path}: there is no {link}")
    return problems


problems = {"scene_reference": scene_reference, "man": man, "examples": examples, "links": links}[check]()
print("\n".join(problems))
sys.exit(1 if problems else 0)
