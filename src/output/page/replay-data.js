// Reads the frames that src/output/replay_pack.cpp has packed.
function bytesOfBase64(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let at = 0; at < bytes.length; at++) bytes[at] = characters.charCodeAt(at);
  return bytes;
}

async function inflate(bytes) {
  if (typeof DecompressionStream === "undefined") throw new Error("the replay needs a browser of 2023 or later");
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

const wallKinds = ["segment", "arc", "disc", "triangle", "edge"];

class FrameReader {
  constructor(buffer, dimension) {
    this.dimension = dimension;
    this.view = new DataView(buffer);
    this.at = 0;
    this.before = { walls: [], planes: [] };
  }

  number(kind, size) {
    const value = this.view[`get${kind}`](this.at, true);
    this.at += size;
    return value;
  }

  numbers(count) {
    return Array.from({ length: count }, () => this.number("Float32", 4));
  }

  walls() {
    const count = this.number("Uint32", 4);
    if (count === 0xffffffff) return this.before.walls;
    return Array.from({ length: count }, () => {
      const [kind, ...numbers] = this.numbers(this.dimension === 3 ? 11 : 6);
      return { kind: wallKinds[kind], numbers };
    });
  }

  // Adds the differences to the plane of the frame before.
  plane(count, before, Values) {
    const values = new Values(count);
    for (let byte = 0; byte < Values.BYTES_PER_ELEMENT; byte++)
      for (let i = 0; i < count; i++) values[i] |= this.view.getUint8(this.at++) << (8 * byte);
    if (before) for (let i = 0; i < Math.min(count, before.length); i++) values[i] += before[i];
    return values;
  }

  frame() {
    const frame = { time: this.number("Float64", 8), grains: this.number("Uint32", 4) };
    const count = this.number("Uint32", 4);
    frame.scales = this.numbers(4);
    frame.walls = this.walls();
    const third = this.dimension === 3 ? "z" : "angle";
    const kinds = [Uint16Array, Uint16Array, third === "z" ? Uint16Array : Uint8Array, Uint8Array, Uint8Array, Uint8Array, Uint8Array];
    frame.planes = kinds.map((Values, n) => this.plane(count, this.before.planes[n], Values));
    [frame.x, frame.y, frame[third], ...frame.levels] = frame.planes;
    this.before = frame;
    return frame;
  }
}

async function readFrames(base64, count, dimension) {
  if (count === 0) return [];
  const reader = new FrameReader(await inflate(bytesOfBase64(base64)), dimension);
  return Array.from({ length: count }, () => reader.frame());
}

const valueOf = (frame, quantity, i) => frame.scales[quantity] * (frame.levels[quantity][i] / 255) ** 2;
