#!/usr/bin/env python3
"""Opens reports in headless Chromium and looks at what is on the page. usage: browser_shows_report.py SAMPLES"""
import html
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Chromium without a screen calls back for one frame only.
frames = "<script>window.requestAnimationFrame = (body) => setTimeout(() => body(performance.now()), 16);</script>"

# Runs in the page when it is ready: uses the controls as a reader would and leaves what it finds in the body.
probe = """
<script>
const started = performance.now();
const timer = setInterval(() => {
  const canvas = document.getElementById("view");
  const failed = !document.getElementById("problems").hidden;
  const ready = document.body.dataset.ready === "yes";
  const waiting = Number(canvas.dataset.frame ?? 0) === 0 && performance.now() - started < 10000;
  if (!failed && (!ready || waiting)) return;
  clearInterval(timer);
  const found = { ready, frame: Number(canvas.dataset.frame ?? -1) };
  found.problems = document.getElementById("problems").textContent;
  found.replay = !document.getElementById("replay").hidden;
  found.plots = [...document.querySelectorAll(".plot")].map((plot) => ({
    title: plot.querySelector("h2").textContent.trim(),
    curves: [...plot.querySelectorAll("path")].map((path) => path.getAttribute("d")),
    labels: [...plot.querySelectorAll("text")].map((text) => text.textContent),
  }));
  const colours = () => {
    if (!canvas.width) return [];
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    const set = new Set();
    for (let at = 0; at < pixels.length; at += 4) set.add(pixels.slice(at, at + 3).join(" "));
    return [...set];
  };
  found.colours = colours().length;
  if (found.replay) {
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
    found.stepped = Number(canvas.dataset.frame);
    const select = document.getElementById("colour");
    found.choices = [...select.options].map((option) => option.textContent);
    select.selectedIndex = select.options.length - 1;
    select.dispatchEvent(new Event("change"));
    found.scale = document.getElementById("scale").textContent;
    found.note = document.getElementById("replay-note").textContent;
  }
  if (found.replay) {
    const picture = () => canvas.toDataURL();
    const pointer = (kind, x) => new PointerEvent(kind, { clientX: x, clientY: 100, bubbles: true });
    const [before, playing] = [picture(), document.getElementById("play-icon").getAttribute("d")];
    canvas.dispatchEvent(pointer("pointerdown", 100));
    canvas.dispatchEvent(pointer("pointermove", 250));
    found.turned = picture() !== before;
    canvas.dispatchEvent(pointer("pointerup", 250));
    if (found.turned) canvas.dispatchEvent(new MouseEvent("click"));
    found.keptStill = document.getElementById("play-icon").getAttribute("d") === playing;
  }
  const plot = document.querySelector(".plot svg");
  if (plot) {
    const box = plot.getBoundingClientRect();
    const middle = { clientX: box.left + box.width / 2, clientY: box.top + 50, bubbles: true };
    plot.dispatchEvent(new PointerEvent("pointermove", middle));
    found.readout = document.querySelector(".plot .legend").textContent;
    plot.dispatchEvent(new MouseEvent("click", middle));
    found.clicked = Number(canvas.dataset.frame ?? -1);
  }
  found.plotsNote = document.getElementById("plots-note").textContent;
  found.hacked = document.body.dataset.hacked ?? document.documentElement.dataset.hacked ?? null;
  found.heading = document.querySelector("h1").textContent;
  found.texts = [...document.querySelectorAll("pre")].map((text) => text.textContent);
  found.elements = document.querySelectorAll("img, iframe, link, object").length;
  document.body.dataset.found = JSON.stringify(found);
}, 50);
</script>
"""


def look(browser, page):
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "page.html"
        text = page.read_text()
        copy.write_text(text.replace("<style>", frames + "<style>", 1) + probe)
        command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                   "--disable-background-networking", "--disable-component-update", "--disable-sync",
                   f"--user-data-dir={folder}/profile", "--window-size=1200,900", "--virtual-time-budget=20000",
                   "--dump-dom", copy.as_uri()]
        dom = subprocess.run(command, capture_output=True, text=True, timeout=120).stdout
    found = re.search(r'data-found="([^"]*)"', dom)
    assert found, f"{page.name}: the page was never ready: {dom[-2000:]}"
    return json.loads(html.unescape(found[1]))


def titles(found):
    return [re.sub(r" \(.*", "", plot["title"]) for plot in found["plots"]]


def check_full(found):
    assert titles(found) == ["Energy", "Contacts", "Largest speed"], titles(found)
    assert all(len(curve) > 100 for plot in found["plots"] for curve in plot["curves"])
    assert [len(plot["curves"]) for plot in found["plots"]] == [2, 2, 1]
    assert "0" in found["plots"][0]["labels"] and any(label.endswith(" s") for label in found["plots"][0]["labels"])
    # Row n has 0.1/(n + 1) mJ and 0.3 n mJ; the pointer is near the middle of 40 rows.
    kinetic, potential = map(float, re.fullmatch(r"kinetic([\d.]+)potential([\d.]+)", found["readout"]).groups())
    row = potential / 0.3
    assert 15 < row < 22 and abs(kinetic - 0.1 / (row + 1)) < 1e-3 * kinetic, found["readout"]
    assert found["replay"] and found["frame"] > 0, "the replay did not advance"
    assert found["stepped"] == found["frame"] - 1, "the arrow key did not step"
    assert found["colours"] > 30, "an empty canvas"
    assert found["clicked"] == 11, "a click on a plot does not seek"
    assert found["choices"] == ["speed", "pressure", "spin", "radius"], found["choices"]
    assert "radius (mm)" in found["scale"], found["scale"]
    assert "grains 7" in found["plotsNote"], found["plotsNote"]


def check_plane(found):
    check_full(found)
    assert not found["turned"], "a plane turned"


def check_space(found):
    check_full(found)
    assert "Drag to turn" in found["note"], found["note"]
    assert found["turned"], "dragging does not turn the view"
    assert found["keptStill"], "the end of a drag counts as a click"


def check_no_grains(found):
    assert found["replay"] and found["choices"] == ["speed"]


def check_no_frames(found):
    assert not found["replay"] and len(found["plots"]) == 3


def check_one_frame(found):
    assert found["replay"] and found["frame"] == 0 and found["plots"] == []


def check_empty_log(found):
    assert found["replay"] and found["plots"] == [] and "empty" in found["plotsNote"]


def check_hostile(found):
    assert found["hacked"] is None and found["elements"] == 0
    attack = "</script></title></pre><script>"
    assert found["heading"].startswith(attack) and "{{plan}}" in found["heading"]
    assert len(found["texts"]) == 2 and all(text.startswith(attack) for text in found["texts"])


def check_broken_numbers(found):
    assert found["replay"] and len(found["plots"]) == 2
    curve = found["plots"][0]["curves"][0]
    assert curve.count("M") == 2 and "NaN" not in curve, "a gap where the number is missing"
    assert "largest speed no number" in found["plotsNote"], found["plotsNote"]


def check_crowd(found):
    ratio = int(re.search(r"About one grain in (\d+) is shown", found["note"])[1])
    assert 14 <= ratio <= 18, found["note"]  # one in 16 of 160000: 10000 +- 100
    assert "One row in 3" in found["plotsNote"], found["plotsNote"]


checks = {"walls": check_plane, "periodic": check_plane, "space": check_space, "no-grains": check_no_grains,
          "no-frames": check_no_frames, "one-frame": check_one_frame, "empty-log": check_empty_log,
          "hostile": check_hostile, "broken-numbers": check_broken_numbers, "crowd": check_crowd}


def main():
    browser = shutil.which("chromium")
    if not browser:
        print("skipped: chromium is not installed")
        return 77
    for name, check in checks.items():
        page = pathlib.Path(sys.argv[1]) / "reports" / f"{name}.html"
        assert "default-src 'none'" in page.read_text()
        found = look(browser, page)
        try:
            assert found["ready"] and not found["problems"], found["problems"]
            check(found)
        except AssertionError:
            print(f"{name}: {json.dumps(found, indent=1)[:4000]}")
            raise
        print(f"{name}: {len(found['plots'])} plots, {found['colours']} colours, frame {found['frame']}")
    return 0


sys.exit(main())
