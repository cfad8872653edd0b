"""What the parts of the laboratory share: numbers of the last run, tables with the Pareto front, CSV and pictures."""
import csv
import json
import math
import shutil
import subprocess
import sys

import accuracy
import measure
import tables

document = measure.root / "docs/accuracy.md"


def remembered(name, options, compute):
    """What compute() returns, plain lists and dictionaries; with --reuse that of the last run, if there is one."""
    accuracy.results.mkdir(parents=True, exist_ok=True)
    path = accuracy.results / f"{name}.json"
    if not (options.reuse and path.exists()):
        path.write_text(json.dumps(compute()))
    return json.loads(path.read_text())


def table(series, ratios, front=(), head=lambda r: f"t_c/{r}", orders=True):
    """Markdown of {program: {ratio: error}}; members (program, ratio) of the front are bold."""
    text = tables.head("", *(head(r) for r in ratios), *(["order"] if orders else []))
    for program, errors in series.items():
        cells = []
        for r in ratios:
            error = errors.get(r, math.nan)
            cell = "refused" if math.isnan(error) else f"{error:.1e}"
            cells.append(f"**{cell}**" if (program, r) in front else cell)
        text += tables.row(accuracy.names.get(program, program), *cells,
                           *([f"{accuracy.order(errors):.2f}"] if orders else []))
    return text


def power(x, y):
    """Slope of log y over log x, least squares."""
    points = [(math.log(a), math.log(b)) for a, b in zip(x, y) if b > 0]
    mean = [sum(p[k] for p in points) / len(points) for k in (0, 1)]
    return (sum((a - mean[0]) * (b - mean[1]) for a, b in points) /
            sum((a - mean[0]) ** 2 for a, _ in points))


def save(name, fields, rows):
    """CSV in build/bench/accuracy."""
    path = accuracy.results / f"{name}.csv"
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(fields)
        writer.writerows(rows)
    return path


def draw(path, x, ys, log, shown=None):
    """A picture of columns of a CSV, copied into the documents under the name `shown`."""
    out = path.with_suffix(".svg")
    subprocess.run([sys.executable, measure.root / "tools/plot.py", out, path, x, ",".join(ys), "--log", log], check=True)
    if shown:
        shutil.copy(out, measure.root / f"docs/pictures/{shown}.svg")


def publish(options, blocks):
    """Prints tables, and with --write puts them into the document: {mark: text}."""
    for name, text in blocks.items():
        print(f"\n{name}\n\n{text.strip()}")
        if options.write:
            tables.fill(document, name, text)


def verdict(wrong, what, value, low, high):
    """A line of --check; returns the number of failures so far."""
    good = low <= value <= high
    print(f"{what:<62}{value:9.3g}, expected {low:.3g} to {high:.3g}{'' if good else '  WRONG'}")
    return wrong + (not good)
