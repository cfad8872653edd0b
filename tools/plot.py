#!/usr/bin/env python3
"""plot.py OUT.svg CSV X Y[,Y...] [--log x|y|xy] [--points Y,...] [--range X0 X1 [Y0 Y1]]: columns of a CSV file of a run
as a small picture for the documents. Standard library only."""
import argparse
import csv
import math

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 460, 300, 62, 12, 12, 42
COLOURS = ["#1f5fa8", "#c2452d", "#2c8a4b", "#8051a8", "#b8860b", "#4f6d7a"]

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("out")
parser.add_argument("csv")
parser.add_argument("x")
parser.add_argument("y")
parser.add_argument("--log", default="")
parser.add_argument("--points", default="")
parser.add_argument("--range", nargs="+", type=float, default=[])
parser.add_argument("--label", default="")
a = parser.parse_args()

rows = list(csv.reader(open(a.csv)))
names = [cell.split("[")[0] for cell in rows[0]]
units = [cell.split("[")[1].rstrip("]") if "[" in cell else "" for cell in rows[0]]
data = {name: [float(row[n]) for row in rows[1:]] for n, name in enumerate(names)}
ys = a.y.split(",")


def shown(x, y):
    if not (math.isfinite(x) and math.isfinite(y)):
        return False
    if ("x" in a.log and x <= 0) or ("y" in a.log and y <= 0):
        return False
    return not a.range or a.range[0] <= x <= a.range[1] and (len(a.range) < 4 or a.range[2] <= y <= a.range[3])


series = {y: [p for p in zip(data[a.x], data[y]) if shown(*p)] for y in ys}
points = [p for s in series.values() for p in s]


def axis(values, log):
    low, high = min(values), max(values)
    if log:
        return math.log10(low), math.log10(high), [10.0**k for k in range(math.ceil(math.log10(low) - 1e-9),
                                                                        math.floor(math.log10(high) + 1e-9) + 1)]
    if high == low:
        high = low + 1
    step = 10 ** math.floor(math.log10((high - low) / 4))
    step *= next(f for f in (1, 2, 5, 10) if (high - low) / (step * f) <= 6)
    ticks = [k * step for k in range(math.floor(low / step), math.ceil(high / step) + 1)]
    return min(ticks), max(ticks), ticks


x0, x1, xticks = axis([p[0] for p in points], "x" in a.log)
y0, y1, yticks = axis([p[1] for p in points], "y" in a.log)


def place(x, y):
    x, y = (math.log10(x) if "x" in a.log else x), (math.log10(y) if "y" in a.log else y)
    return (LEFT + (x - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT),
            HEIGHT - BOTTOM - (y - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM))


def named(name):
    unit = units[names.index(name)]
    return name.replace("_", " ") + (f" [{unit}]" if unit not in ("", "1") else "")


def number(v):
    return f"1e{round(math.log10(v))}" if v > 0 and (v >= 1e4 or v < 1e-2) and abs(math.log10(v) % 1) < 1e-9 else f"{v:.4g}"


out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="11">',
       f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
every = max(1, len(xticks) // 8)
for v in xticks[::every]:
    x = place(v, points[0][1])[0]
    out.append(f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
               f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 15}" text-anchor="middle">{number(v)}</text>')
every = max(1, len(yticks) // 8)
for v in yticks[::every]:
    y = place(points[0][0], v)[1]
    out.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
               f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{number(v)}</text>')
out.append(f'<text x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 8}" text-anchor="middle">{named(a.x)}</text>')
for n, (name, line) in enumerate(series.items()):
    colour = COLOURS[n % len(COLOURS)]
    at = [place(*p) for p in line]
    if name in a.points.split(","):
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.2" fill="{colour}"/>' for x, y in at]
    else:
        d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in at)
        out.append(f'<path d="{d}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
    out.append(f'<text x="{WIDTH - RIGHT - 6}" y="{TOP + 16 + 15 * n}" text-anchor="end" fill="{colour}">{named(name)}</text>')
out.append(f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{HEIGHT - TOP - BOTTOM}" fill="none" '
           'stroke="#444"/></svg>')
open(a.out, "w").write("\n".join(out) + "\n")
