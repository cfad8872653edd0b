// Draws the grains and walls of a frame on a canvas.
const radiusQuantity = 3; // as in scene::Colour
const colourBins = 64; // discs of one colour are drawn as one path

// The value that one grain in a hundred of a frame exceeds.
function usualHigh(frame, quantity) {
  const counts = new Uint32Array(256);
  for (const level of frame.levels[quantity]) counts[level]++;
  let level = 255;
  for (let above = counts[level]; level > 0 && above <= 0.01 * frame.x.length; above += counts[level]) level--;
  return frame.scales[quantity] * (level / 255) ** 2;
}

// Ends of the colour scale, the same for all frames. What few grains or the first moments have beyond the usual is cut
// off: it would leave all the rest dark.
function colourScale(frames, quantity) {
  let low = Infinity;
  let high = 0;
  for (const frame of frames)
    for (let i = 0; i < frame.x.length; i++) {
      const value = valueOf(frame, quantity, i);
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  if (high === 0) return { low: 0, high: 1, cut: false, empty: true };
  if (quantity === radiusQuantity) return low < 0.98 * high ? { low, high, cut: false } : { low: 0, high, cut: false, empty: true };
  const highs = frames.map((frame) => usualHigh(frame, quantity)).sort((a, b) => a - b);
  const usual = highs[Math.floor(0.75 * (highs.length - 1))];
  const cut = usual > 0 && usual < 0.8 * high;
  const end = cut ? usual : high;
  const step = roundStep(end, 10);
  return { low: 0, high: Math.ceil(end / step - 1e-6) * step, cut };
}

function coloursOf(digits, dark) {
  const rgb = Array.from({ length: 256 }, (_, n) => [0, 2, 4].map((k) => parseInt(digits.substr(6 * n + k, 2), 16)));
  // On a dark ground the darkest fifth of the map would not be seen.
  const first = dark ? 52 : 0;
  return Array.from({ length: colourBins }, (_, n) => rgb[Math.round(first + (n / (colourBins - 1)) * (255 - first))]);
}

const css = (rgb, towards = 0, share = 0) => `rgb(${rgb.map((c) => Math.round(c + (towards - c) * share)).join(" ")})`;

class Painter {
  static pad = 7; // pixels around the domain, for walls on its border

  constructor(canvas, data, frames) {
    this.canvas = canvas;
    this.data = data;
    this.frames = frames;
    this.context = canvas.getContext("2d");
    this.wide = data.upper[0] - data.lower[0] || 1;
    this.high = data.upper[1] - data.lower[1] || 1;
    this.scales = data.quantities.map((_, quantity) => colourScale(frames, quantity));
    this.useTheme();
  }

  useTheme() {
    const style = getComputedStyle(document.documentElement);
    this.dark = matchMedia("(prefers-color-scheme: dark)").matches;
    this.ink = Object.fromEntries(["ground", "edge", "wall", "wall-fill"].map((name) => [name, style.getPropertyValue(`--${name}`)]));
    this.colours = coloursOf(this.data.map, this.dark);
  }

  // The largest picture of the domain that fits into the room.
  resize(room) {
    const pad = 2 * Painter.pad;
    this.scale = Math.min((room.width - pad) / this.wide, (room.height - pad) / this.high);
    const width = Math.max(40, this.wide * this.scale + pad);
    const height = Math.max(40, this.high * this.scale + pad);
    const dots = Math.min(window.devicePixelRatio || 1, 2);
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${height}px`;
    this.canvas.width = Math.round(width * dots);
    this.canvas.height = Math.round(height * dots);
    this.context.setTransform(dots, 0, 0, dots, 0, 0);
    this.bottom = Painter.pad + this.high * this.scale;
  }

  px(x) {
    return Painter.pad + (x - this.data.lower[0]) * this.scale;
  }

  py(y) {
    return this.bottom - (y - this.data.lower[1]) * this.scale;
  }

  draw(frame, quantity) {
    const { context, ink } = this;
    const [wide, high] = [this.wide * this.scale, this.high * this.scale];
    context.clearRect(0, 0, wide + 2 * Painter.pad, high + 2 * Painter.pad);
    context.fillStyle = ink.ground;
    context.strokeStyle = ink.edge;
    context.lineWidth = 1;
    context.fillRect(Painter.pad, Painter.pad, wide, high);
    context.strokeRect(Painter.pad - 0.5, Painter.pad - 0.5, wide + 1, high + 1);
    context.save();
    context.beginPath();
    context.rect(Painter.pad, Painter.pad, wide, high);
    context.clip();
    this.drawGrains(frame, quantity);
    context.restore();
    for (const wall of frame.walls) this.drawWall(wall);
  }

  drawGrains(frame, quantity) {
    const bins = Array.from({ length: colourBins }, () => ({ discs: new Path2D(), rims: new Path2D(), ticks: new Path2D() }));
    const { low, high } = this.scales[quantity];
    const [wide, tall] = [this.wide * this.scale, this.high * this.scale];
    // A sample covers the area of all grains.
    const wider = Math.sqrt(sampleRatio(frame));
    for (let i = 0; i < frame.x.length; i++) {
      const unit = (valueOf(frame, quantity, i) - low) / (high - low);
      const bin = bins[Math.round(Math.min(1, Math.max(0, unit)) * (colourBins - 1))];
      const x = Painter.pad + (frame.x[i] / 65535) * wide;
      const y = this.bottom - (frame.y[i] / 65535) * tall;
      const radius = Math.max(0.4, valueOf(frame, radiusQuantity, i) * this.scale * wider);
      for (const [dx, dy] of this.images(x, y, radius)) addDisc(bin, x + dx, y + dy, radius, (frame.angle[i] / 128) * Math.PI);
    }
    bins.forEach((bin, n) => this.fillDiscs(bin, this.colours[n]));
  }

  // A grain that crosses a periodic face is drawn on both sides.
  images(x, y, radius) {
    const [wide, tall] = [this.wide * this.scale, this.high * this.scale];
    const shifts = (periodic, at, extent) => {
      const from = at - Painter.pad;
      if (periodic && from < radius) return [0, extent];
      return periodic && from > extent - radius ? [0, -extent] : [0];
    };
    const down = shifts(this.data.periodic[1], y, tall);
    return shifts(this.data.periodic[0], x, wide).flatMap((dx) => down.map((dy) => [dx, dy]));
  }

  fillDiscs({ discs, rims, ticks }, rgb) {
    const { context } = this;
    context.fillStyle = css(rgb);
    context.fill(discs);
    context.lineWidth = 1;
    context.strokeStyle = css(rgb, this.dark ? 255 : 0, 0.35);
    context.stroke(rims);
    const light = 0.3 * rgb[0] + 0.59 * rgb[1] + 0.11 * rgb[2] > 128;
    context.strokeStyle = light ? "rgb(0 0 0 / 0.65)" : "rgb(255 255 255 / 0.75)";
    context.lineWidth = 1.5;
    context.stroke(ticks);
  }

  drawWall({ kind, numbers }) {
    const { context, ink } = this;
    context.lineWidth = 2.5;
    context.lineCap = "round";
    context.strokeStyle = ink.wall;
    context.beginPath();
    if (kind === "segment") {
      context.moveTo(this.px(numbers[0]), this.py(numbers[1]));
      context.lineTo(this.px(numbers[2]), this.py(numbers[3]));
      context.stroke();
      return;
    }
    const [x, y, radius] = [this.px(numbers[0]), this.py(numbers[1]), numbers[2] * this.scale];
    if (kind === "arc") {
      context.arc(x, y, radius, -numbers[3], -numbers[4], true);
      context.stroke();
      return;
    }
    const bin = { discs: new Path2D(), rims: new Path2D(), ticks: new Path2D() };
    addDisc(bin, x, y, radius, numbers[3]);
    context.fillStyle = ink["wall-fill"];
    context.fill(bin.discs);
    context.lineWidth = 1;
    context.stroke(bin.rims);
    context.stroke(bin.ticks);
  }
}

function addDisc({ discs, rims, ticks }, x, y, radius, angle) {
  discs.moveTo(x + radius, y);
  discs.arc(x, y, radius, 0, 2 * Math.PI);
  if (radius < 3) return;
  rims.moveTo(x + radius - 0.5, y);
  rims.arc(x, y, radius - 0.5, 0, 2 * Math.PI);
  if (radius < 5) return;
  const [dx, dy] = [radius * Math.cos(angle), -radius * Math.sin(angle)];
  ticks.moveTo(x + 0.3 * dx, y + 0.3 * dy);
  ticks.lineTo(x + 0.8 * dx, y + 0.8 * dy);
}

// Grains of the run per grain of the frame; 1 unless the frame is a sample.
function sampleRatio(frame) {
  return frame.x.length > 0 && frame.grains > 1.5 * frame.x.length ? frame.grains / frame.x.length : 1;
}
