// Plots of the log over time. A group is one plot; a column that fits no group gets a plot of its own.
const plotGroups = [
  { title: "Energy", columns: /_energy$/ },
  { title: "Contacts", columns: /contacts$/ },
  { title: "Largest overlap", columns: /^largest_overlap$/ },
  { title: "Largest speed", columns: /^largest_speed$/ },
  { title: "Momentum", columns: /^momentum_/ },
  { title: "Grains", columns: /^(grains|removed)$/ },
];

const finite = (values) => values.filter((value) => value !== null);
const isConstant = (values) => finite(values).every((value) => value === finite(values)[0]);
const readableName = (name) => name.replaceAll("_", " ");

function groupColumns(columns) {
  const groups = new Map();
  for (const column of columns) {
    const group = plotGroups.find((candidate) => candidate.columns.test(column.name));
    const title = group ? group.title : readableName(column.name);
    if (!groups.has(title)) groups.set(title, []);
    groups.get(title).push(column);
  }
  const order = (title) => (plotGroups.findIndex((group) => group.title === title) + 100) % 100;
  return [...groups].sort((a, b) => order(a[0]) - order(b[0]));
}

const seriesNames = { contacts: "between grains", wall_contacts: "with walls", grains: "present" };

// Under the title "Energy", kinetic_energy is "kinetic".
function seriesLabel(title, name) {
  const shorter = readableName(name).split(" ").filter((word) => word !== title.toLowerCase());
  return seriesNames[name] ?? shorter.join(" ");
}

function nearestIndex(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return time - times[low] <= times[high] - time ? low : high;
}

class Plot {
  static height = 180;
  static margin = { left: 46, right: 10, top: 8, bottom: 22 };

  // pointed(index | null): the pointer is at a row of the log; chosen(time): it was clicked.
  constructor(title, times, columns, { pointed, chosen }) {
    this.times = times;
    this.series = columns.map((column, n) => ({
      values: column.values,
      label: columns.length > 1 ? seriesLabel(title, column.name) : "",
      colour: column.name === "total_energy" ? "var(--total)" : `var(--s${n % 5})`,
      shown: true,
    }));
    this.unit = columns[0].unit;
    this.unitLabel = element("span");
    this.svg = svgElement("svg", { height: Plot.height, role: "img", "aria-label": `${title} over time` });
    this.root = element("section", { class: "card plot" }, element("h2", {}, `${title} `, this.unitLabel));
    this.root.append(this.makeLegend(), this.svg);
    const timeAt = (event) => this.timeAt(event.clientX - this.svg.getBoundingClientRect().left);
    this.svg.addEventListener("pointermove", (event) => pointed(nearestIndex(times, timeAt(event))));
    this.svg.addEventListener("pointerleave", () => pointed(null));
    this.svg.addEventListener("click", (event) => chosen(timeAt(event)));
  }

  makeLegend() {
    const legend = element("div", { class: "legend" });
    for (const series of this.series) {
      series.readout = element("b");
      const button = element("button", { type: "button", "aria-pressed": "true" });
      if (this.series.length > 1) button.append(element("i", { style: `background:${series.colour}` }), series.label);
      button.append(series.readout);
      button.disabled = this.series.length === 1;
      button.addEventListener("click", () => {
        series.shown = !series.shown;
        button.setAttribute("aria-pressed", series.shown);
        this.draw();
      });
      legend.append(button);
    }
    return legend;
  }

  range() {
    let low = Infinity;
    let high = -Infinity;
    for (const series of this.series)
      if (series.shown)
        for (const value of finite(series.values)) {
          low = Math.min(low, value);
          high = Math.max(high, value);
        }
    if (low > high) return [0, 1];
    if (low > 0 && low < 0.7 * high) low = 0;
    if (high < 0 && high > 0.7 * low) high = 0;
    const room = high > low ? 0.04 * (high - low) : 0.1 * Math.abs(high) || 1;
    return [low === 0 ? 0 : low - room, high === 0 ? 0 : high + room];
  }

  timeAt(pixel) {
    const { left, right } = Plot.margin;
    const unit = (pixel - left) / (this.width - left - right);
    return this.times[0] + unit * (this.times.at(-1) - this.times[0]);
  }

  draw() {
    const { left, right, top, bottom } = Plot.margin;
    const [low, high] = this.range();
    const first = this.times[0];
    const span = this.times.at(-1) - first || 1;
    this.width = this.svg.clientWidth;
    this.px = (time) => left + ((time - first) / span) * (this.width - left - right);
    this.py = (value) => Plot.height - bottom - ((value - low) / (high - low)) * (Plot.height - top - bottom);
    this.scale = unitFor(this.unit, Math.max(Math.abs(low), Math.abs(high)));
    this.unitLabel.textContent = this.scale.name ? `(${this.scale.name})` : "";
    this.svg.replaceChildren(...this.axes(low, high, span), ...this.curves());
    this.replayLine = this.addLine("var(--accent)");
    this.pointerLine = this.addLine("var(--quiet)");
    this.dots = this.series.map((series) => this.svg.appendChild(this.dot(series)));
  }

  axes(low, high, span) {
    const { left, right, bottom } = Plot.margin;
    const { factor } = this.scale;
    const parts = [];
    for (const tick of ticks(low * factor, high * factor, 5)) {
      const y = this.py(tick.value / factor);
      parts.push(svgElement("line", { x1: left, x2: this.width - right, y1: y, y2: y, stroke: "var(--grid)" }));
      parts.push(svgElement("text", { x: left - 6, y: y + 4, "text-anchor": "end" }, tick.label));
    }
    const time = unitFor("s", Math.max(Math.abs(this.times[0]), Math.abs(this.times[0] + span)));
    const start = this.times[0] * time.factor;
    const labels = ticks(start, start + span * time.factor, Math.max(2, Math.floor(this.width / 60)));
    labels.forEach((tick, n) => {
      const x = this.px(tick.value / time.factor);
      const last = n === labels.length - 1;
      const text = last ? `${tick.label} ${time.name}` : tick.label;
      const nearEdge = this.width - x < 30;
      const place = { x: nearEdge ? this.width - 2 : x, y: Plot.height - 5, "text-anchor": nearEdge ? "end" : "middle" };
      parts.push(svgElement("line", { x1: x, x2: x, y1: Plot.height - bottom, y2: Plot.height - bottom + 4, stroke: "var(--edge)" }));
      parts.push(svgElement("text", place, text));
    });
    return parts;
  }

  curves() {
    return this.series
      .filter((series) => series.shown)
      .map((series) => {
        let path = "";
        let pen = "M";
        series.values.forEach((value, row) => {
          if (value !== null) path += `${pen}${this.px(this.times[row]).toFixed(1)} ${this.py(value).toFixed(1)}`;
          // A number alone between gaps, too, leaves a dot: its round ends.
          if (value !== null && pen === "M") path += "h0";
          pen = value === null ? "M" : "L";
        });
        return svgElement("path", {
          d: path,
          fill: "none",
          stroke: series.colour,
          "stroke-width": 1.8,
          "stroke-linejoin": "round",
          "stroke-linecap": "round",
        });
      });
  }

  addLine(colour) {
    const line = svgElement("line", { y1: Plot.margin.top, y2: Plot.height - Plot.margin.bottom, stroke: colour, visibility: "hidden" });
    return this.svg.appendChild(line);
  }

  dot(series) {
    return svgElement("circle", { r: 3.5, fill: series.colour, visibility: "hidden" });
  }

  moveLine(line, time) {
    const x = this.px(time);
    line.setAttribute("x1", x);
    line.setAttribute("x2", x);
    line.setAttribute("visibility", "visible");
  }

  showReplayTime(time) {
    this.moveLine(this.replayLine, time);
  }

  point(row) {
    if (row === null) this.pointerLine.setAttribute("visibility", "hidden");
    else this.moveLine(this.pointerLine, this.times[row]);
    this.series.forEach((series, n) => {
      const value = row === null ? null : series.values[row];
      const visible = row !== null && series.shown && value !== null;
      this.dots[n].setAttribute("visibility", visible ? "visible" : "hidden");
      if (visible) {
        this.dots[n].setAttribute("cx", this.px(this.times[row]));
        this.dots[n].setAttribute("cy", this.py(value));
      }
      series.readout.textContent = row === null ? "" : readable(value === null ? null : value * this.scale.factor);
    });
    if (this.series.length === 1 && row !== null) this.series[0].readout.textContent += ` at ${readable(this.times[row])} s`;
  }
}

// Makes all plots of the log; returns how they learn of a new layout and of the time that the replay shows.
function makePlots(data, chosen) {
  const time = data.log.find((column) => column.name === "time");
  const note = [];
  if (!time || time.values.length === 0) {
    byId("plots-note").textContent = "The log of this run is empty: nothing to plot.";
    return { draw() {}, showReplayTime() {} };
  }
  const others = data.log.filter((column) => column !== time && column.name !== "step");
  const constant = others.filter((column) => isConstant(column.values));
  const changing = others.filter((column) => !constant.includes(column));
  const plots = [];
  const pointed = (row) => plots.forEach((plot) => plot.point(row));
  for (const [title, columns] of groupColumns(changing)) plots.push(new Plot(title, time.values, columns, { pointed, chosen }));
  byId("plots").replaceChildren(...plots.map((plot) => plot.root));
  let replayTime = null;
  const showReplayTime = (now) => {
    replayTime = now;
    if (now !== null) plots.forEach((plot) => plot.showReplayTime(now));
  };
  const draw = () => {
    plots.forEach((plot) => plot.draw());
    showReplayTime(replayTime);
  };
  draw();
  new ResizeObserver(draw).observe(byId("plots"));
  if (constant.length > 0) {
    const words = constant.map((column) => {
      const unit = unitNames[column.unit] ?? column.unit;
      return `${readableName(column.name)} ${readable(finite(column.values)[0] ?? null)} ${unit}`.trim();
    });
    note.push(`Constant: ${words.join(", ")}.`);
  }
  note.push("A click on a name hides its curve; a click on a plot takes the replay there.");
  if (data.logStride > 1) note.push(`One row in ${data.logStride} of log.csv is shown.`);
  byId("plots-note").textContent = note.join(" ");
  return { draw, showReplayTime };
}
