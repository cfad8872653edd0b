// Draws the spheres and walls of a frame in space, as seen along parallel lines; dragging turns the view.
const sphereSize = 48; // pixels of the picture of a lit sphere

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const times = (s, a) => a.map((value) => s * value);
const sum = (a, b) => a.map((value, k) => value + b[k]);
const difference = (a, b) => a.map((value, k) => value - b[k]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(1 / Math.hypot(...a), a);

// Turns v by an angle about a unit vector (Rodrigues).
function turned(v, axis, angle) {
  const along = times(dot(axis, v) * (1 - Math.cos(angle)), axis);
  return sum(sum(times(Math.cos(angle), v), times(Math.sin(angle), cross(axis, v))), along);
}

// A sphere of this colour, lit as in src/output/depth_canvas.cpp.
function sphereImage(rgb) {
  const image = element("canvas", { width: sphereSize, height: sphereSize });
  const context = image.getContext("2d");
  const [middle, lampX, lampY] = [sphereSize / 2, 0.32 * sphereSize, 0.26 * sphereSize];
  const light = context.createRadialGradient(lampX, lampY, 0, middle, middle, middle);
  light.addColorStop(0, css(rgb, 255, 0.45));
  light.addColorStop(0.3, css(rgb));
  light.addColorStop(1, css(rgb, 0, 0.5));
  context.fillStyle = light;
  context.arc(middle, middle, middle - 0.5, 0, 2 * Math.PI);
  context.fill();
  return image;
}

class SpacePainter extends Painter {
  static turnPerPixel = 0.008; // rad

  constructor(canvas, data, frames) {
    super(canvas, data, frames);
    this.sides = difference(data.upper, data.lower);
    this.middle = sum(data.lower, times(0.5, this.sides));
    // Whatever the view, the domain fits.
    this.wide = this.high = Math.hypot(...this.sides) || 1;
    [this.right, this.up, this.towards, this.vertical] = data.camera;
    this.listen();
  }

  useTheme() {
    super.useTheme();
    this.spheres = this.colours.map(sphereImage);
  }

  listen() {
    const { canvas } = this;
    canvas.style.touchAction = "none";
    canvas.style.cursor = "grab";
    canvas.addEventListener("pointerdown", (event) => {
      this.last = [event.clientX, event.clientY];
      this.dragged = false;
    });
    window.addEventListener("pointerup", () => (this.last = null));
    window.addEventListener("pointermove", (event) => {
      if (!this.last) return;
      const [dx, dy] = [event.clientX - this.last[0], event.clientY - this.last[1]];
      if (!this.dragged && Math.hypot(dx, dy) < 3) return;
      this.dragged = true;
      this.last = [event.clientX, event.clientY];
      this.turn(dx * SpacePainter.turnPerPixel, dy * SpacePainter.turnPerPixel);
    });
  }

  // Like a globe on its stand: about the vertical, and to and fro but not over the poles.
  turn(sideways, down) {
    this.right = unit(turned(this.right, this.vertical, -sideways));
    this.towards = turned(this.towards, this.vertical, -sideways);
    const tilted = unit(turned(this.towards, this.right, -down));
    if (dot(cross(this.vertical, tilted), this.right) > 1e-3) this.towards = tilted;
    this.up = cross(this.towards, this.right);
    this.redraw();
  }

  redraw() {
    if (this.shown) this.draw(...this.shown);
  }

  // Place on the canvas, and height towards the viewer.
  project(p) {
    const from = difference(p, this.middle);
    const middle = Painter.pad + 0.5 * this.wide * this.scale;
    return [middle + dot(from, this.right) * this.scale, middle - dot(from, this.up) * this.scale, dot(from, this.towards)];
  }

  draw(frame, quantity) {
    this.shown = [frame, quantity];
    const { context, ink } = this;
    const side = this.wide * this.scale + 2 * Painter.pad;
    context.clearRect(0, 0, side, side);
    context.fillStyle = ink.ground;
    context.fillRect(0, 0, side, side);
    this.drawDomain();
    this.fillWalls(frame);
    this.strokeWalls(frame, 0.7);
    this.drawGrains(frame, quantity);
    this.strokeWalls(frame, 0.2);
  }

  drawDomain() {
    const corner = (n) => this.project(this.data.lower.map((low, k) => low + ((n >> k) & 1) * this.sides[k]));
    const { context } = this;
    context.beginPath();
    for (let n = 0; n < 8; n++)
      for (const axis of [1, 2, 4])
        if (!(n & axis)) for (const [at, [x, y]] of [corner(n), corner(n | axis)].entries()) at ? context.lineTo(x, y) : context.moveTo(x, y);
    context.lineWidth = 1;
    context.strokeStyle = this.ink.edge;
    context.stroke();
  }

  cornersOf({ numbers }, count) {
    return Array.from({ length: count }, (_, k) => this.project(numbers.slice(3 * k, 3 * k + 3)));
  }

  // The triangles of a wall as one figure, turned alike: what they cover together is filled once.
  fillWalls(frame) {
    const { context } = this;
    const figures = new Map();
    for (const wall of frame.walls) {
      if (wall.kind !== "triangle") continue;
      const index = wall.numbers[9];
      if (!figures.has(index)) figures.set(index, new Path2D());
      const figure = figures.get(index);
      const [a, b, c] = this.cornersOf(wall, 3);
      const left = (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]);
      const [second, third] = left ? [b, c] : [c, b];
      figure.moveTo(a[0], a[1]);
      figure.lineTo(second[0], second[1]);
      figure.lineTo(third[0], third[1]);
      figure.closePath();
    }
    context.globalAlpha = 0.25;
    context.fillStyle = this.ink["wall-fill"];
    for (const figure of figures.values()) context.fill(figure);
    context.globalAlpha = 1;
  }

  strokeWalls(frame, opacity) {
    const { context } = this;
    context.beginPath();
    for (const wall of frame.walls) {
      if (wall.kind !== "edge") continue;
      const [from, to] = this.cornersOf(wall, 2);
      context.moveTo(from[0], from[1]);
      context.lineTo(to[0], to[1]);
    }
    context.globalAlpha = opacity;
    context.lineWidth = 1.5;
    context.lineCap = "round";
    context.strokeStyle = this.ink.wall;
    context.stroke();
    context.globalAlpha = 1;
  }

  drawGrains(frame, quantity) {
    const { low, high } = this.scales[quantity];
    const { context } = this;
    const count = frame.x.length;
    const places = Array.from({ length: count }, (_, i) => {
      const share = [frame.x[i] / 65535, frame.y[i] / 65535, frame.z[i] / 65535];
      return this.project(this.data.lower.map((lower, k) => lower + share[k] * this.sides[k]));
    });
    const order = Uint32Array.from(places.keys()).sort((i, j) => places[i][2] - places[j][2]);
    // A sample fills the volume of all grains.
    const wider = Math.cbrt(sampleRatio(frame));
    for (const i of order) {
      const share = Math.min(1, Math.max(0, (valueOf(frame, quantity, i) - low) / (high - low)));
      const radius = Math.max(0.5, valueOf(frame, radiusQuantity, i) * this.scale * wider);
      const [x, y] = places[i];
      context.drawImage(this.spheres[Math.round(share * (colourBins - 1))], x - radius, y - radius, 2 * radius, 2 * radius);
    }
  }
}

const makePainter = (canvas, data, frames) => (data.dimension === 3 ? new SpacePainter(canvas, data, frames) : new Painter(canvas, data, frames));
