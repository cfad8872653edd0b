"""Stress cases of the specifications, long runs, extreme scales: expected and observed behaviour as a table."""
import csv
import re
import subprocess
import sys
import time

import measure
import tables
import trial
import stability_automata  # noqa: F401 registers its cases
import stability_gases  # noqa: F401
import stability_md  # noqa: F401

page = measure.root / "docs/stability.md"
columns = ("case", "asked for by", "expected", "observed", "verdict")


def row_of(case, folder):
    """What a case did; one that breaks the script is a failure like any other."""
    if isinstance(case, trial.Tested):
        known = trial.exists(case.test)
        return case.name, case.source, case.expected, f"test {case.test}", "tested" if known else "NO SUCH TEST"
    start = time.monotonic()
    try:
        verdict = case.run(trial.clear(folder / case.name.replace(" ", "-").replace(":", "-").replace("/", "-")))
    except subprocess.TimeoutExpired as error:
        verdict = trial.Verdict(f"not at its end after {error.timeout} s", False)
    except (ArithmeticError, LookupError, OSError, StopIteration, ValueError) as error:
        verdict = trial.Verdict(f"{type(error).__name__}: {error}", False)
    seconds = time.monotonic() - start
    print(f"{'ok    ' if verdict.good else 'FAILED'} {seconds:7.1f} s  {case.name}: {verdict.observed}", file=sys.stderr, flush=True)
    return case.name, case.source, case.expected, verdict.observed, "holds" if verdict.good else "FAILS"


def chosen(options):
    if options.case:
        found = [c for c in trial.cases if any(re.search(rf"\b{re.escape(name)}", c.name) for name in options.case)]
        if not found:
            raise SystemExit("no such case; known:\n  " + "\n  ".join(c.name for c in trial.cases))
        return found
    return [c for c in trial.cases if options.soak or isinstance(c, trial.Tested) or not c.soak]


def merged(rows):
    """With the rows of earlier runs that this one did not repeat, in the order of the cases."""
    path = measure.results / "stability.csv"
    known = {}
    if path.exists():
        with open(path) as file:
            known = {row[0]: tuple(row) for row in list(csv.reader(file))[1:]}
    known.update((row[0], row) for row in rows)
    return [known[c.name] for c in trial.cases if c.name in known]


def markdown(rows):
    return tables.head(*columns) + "".join(tables.row(*(cell.replace("|", "\\|") for cell in row)) for row in rows)


def main(options):
    rows = []
    measure.results.mkdir(parents=True, exist_ok=True)
    for one in chosen(options):
        rows.append(row_of(one, measure.results / "stability"))
        everything = merged(rows)
        with open(measure.results / "stability.csv", "w", newline="") as file:
            csv.writer(file).writerows([columns, *everything])
    if options.write:
        tables.fill(page, "stability", f"{measure.machine()}.\n\n{markdown(everything)}")
    print(markdown(rows))
    bad = [row[0] for row in rows if row[-1] not in ("holds", "tested")]
    print(f"{len(rows)} cases, {len(bad)} fail{': ' + '; '.join(bad) if bad else ''}", file=sys.stderr)
    return 1 if bad else 0
