// The replay: which frame is shown, and its controls.
class Replay {
  static usualSeconds = 8; // the whole run at speed 1

  constructor(data, frames, moved) {
    this.data = data;
    this.frames = frames;
    this.moved = moved; // told the time of the frame shown
    this.times = frames.map((frame) => frame.time);
    this.start = this.times[0];
    this.span = this.times.at(-1) - this.start;
    this.quantity = data.colour;
    this.speed = 1;
    this.now = this.start;
    this.playing = false;
    byId("replay").hidden = false;
    this.painter = makePainter(byId("view"), data, frames);
    this.makeControls();
    this.fit();
    this.showScale();
    this.tellThinning();
  }

  makeControls() {
    this.fillSelects();
    if (this.frames.length < 2) for (const bar of document.querySelectorAll("#replay .bar")) bar.hidden = true;
    byId("frame").max = this.frames.length - 1;
    byId("frame").addEventListener("input", () => this.seek(this.times[byId("frame").value]));
    byId("play").addEventListener("click", () => this.play(!this.playing));
    byId("view").addEventListener("click", () => {
      if (!this.painter.dragged) this.play(!this.playing);
    });
    byId("view").addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("resize", () => this.fit());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.painter.useTheme();
      this.showScale();
      this.draw();
    });
  }

  fillSelects() {
    this.data.quantities.forEach((quantity, n) => {
      if (this.painter.scales[n].empty && n !== this.quantity) return;
      byId("colour").append(element("option", { value: n }, quantity.name));
    });
    byId("colour").value = this.quantity;
    byId("colour").addEventListener("change", () => {
      this.quantity = Number(byId("colour").value);
      this.showScale();
      this.draw();
    });
    for (const [speed, name] of [[0.25, "¼ ×"], [0.5, "½ ×"], [1, "1 ×"], [2, "2 ×"], [4, "4 ×"]])
      byId("speed").append(element("option", { value: speed }, name));
    byId("speed").value = 1;
    byId("speed").addEventListener("change", () => {
      this.speed = Number(byId("speed").value);
      this.showPace();
    });
    this.showPace();
  }

  showPace() {
    const pace = (this.speed * this.span) / Replay.usualSeconds; // simulated seconds per second
    byId("pace").textContent = pace < 1 ? `${readable(1 / pace, 2)} times slower than real time` : `${readable(pace, 2)} times faster than real time`;
    if (pace > 0.98 && pace < 1.02) byId("pace").textContent = "as fast as real time";
  }

  showScale() {
    const { low, high, cut } = this.painter.scales[this.quantity];
    const quantity = this.data.quantities[this.quantity];
    const unit = unitFor(quantity.unit, high);
    byId("scale-low").textContent = readable(low * unit.factor, 2);
    byId("scale-name").textContent = `${quantity.name} (${unit.name})`;
    byId("scale-high").textContent = `${cut ? "≥ " : ""}${readable(high * unit.factor, 3)}`;
    const context = byId("gradient").getContext("2d");
    this.painter.colours.forEach((rgb, n) => {
      context.fillStyle = css(rgb);
      context.fillRect((256 / colourBins) * n, 0, 256 / colourBins, 1);
    });
  }

  tellThinning() {
    const notes = [];
    const ratio = Math.max(...this.frames.map(sampleRatio));
    if (ratio > 1) notes.push(`About one grain in ${Math.round(ratio)} is shown, drawn ${readable(ratio ** (1 / this.data.dimension), 2)} times as wide.`);
    if (this.data.replayStride > 1) notes.push(`One frame in ${this.data.replayStride} of replay.bin is shown.`);
    if (this.data.dimension === 3) notes.push("Drag to turn the view.");
    byId("replay-note").textContent = notes.join(" ");
  }

  // A tall domain stands beside the plots, a flat one above them.
  fit() {
    const flat = this.painter.wide > 2 * this.painter.high;
    byId("main").style.flexDirection = flat ? "column" : "";
    byId("main").style.alignItems = flat ? "stretch" : "";
    byId("replay").style.position = flat ? "static" : "";
    const stacked = flat || window.innerWidth <= 900;
    const whole = byId("main").clientWidth - 34;
    const room = { width: stacked ? whole : 0.5 * whole, height: Math.min(760, Math.max(320, window.innerHeight - 235)) };
    this.painter.resize(room);
    const width = Math.max(this.painter.canvas.clientWidth, Math.min(330, room.width));
    byId("replay").style.width = stacked ? "" : `${width + 34}px`;
    this.draw();
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === " ") this.play(!this.playing);
    else if (step) this.seek(this.times[Math.min(this.frames.length - 1, Math.max(0, this.index + step))]);
    else return;
    event.preventDefault();
  }

  play(on) {
    this.playing = on && this.frames.length > 1;
    byId("play-icon").setAttribute("d", this.playing ? "M3 2h4v12H3zM9 2h4v12H9z" : "M4 2l10 6-10 6z");
    if (!this.playing) return;
    if (this.now >= this.start + this.span) this.now = this.start;
    this.last = performance.now();
    requestAnimationFrame((clock) => this.tick(clock));
  }

  tick(clock) {
    if (!this.playing) return;
    const seconds = Math.min(0.1, Math.max(0, (clock - this.last) / 1000));
    this.last = clock;
    this.now += (seconds * this.speed * this.span) / Replay.usualSeconds;
    // The end stays for a moment before it starts again.
    if (this.now > this.start + 1.08 * this.span) this.now = this.start;
    if (nearestIndex(this.times, this.now) !== this.index) this.draw();
    requestAnimationFrame((next) => this.tick(next));
  }

  seek(time) {
    this.play(false);
    this.now = Math.min(this.start + this.span, Math.max(this.start, time));
    this.draw();
  }

  draw() {
    this.index = nearestIndex(this.times, this.now);
    const frame = this.frames[this.index];
    this.painter.draw(frame, this.quantity);
    this.painter.canvas.dataset.frame = this.index;
    byId("frame").value = this.index;
    byId("time").textContent = `${frame.time.toPrecision(4)} s`;
    this.moved(frame.time);
  }
}
