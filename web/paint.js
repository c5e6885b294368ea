// Maps values to colours, and draws pictures of numbers with WebGL 2: nearest pixels when magnified, means of values
// when minified.

/// The smallest of 1, 2 and 5 times a power of ten that is not below `value`.
function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((n) => n * power >= value) * power;
}

/// The values at the ends of the colour map, before the stops.
function range(images) {
  const high = Math.max(...images.map(({ extent }) => extent[1] ?? -Infinity));
  const low = Math.min(...images.map(({ extent }) => extent[0] ?? Infinity));
  if (images[0].kind) {
    const top = high > 0 ? rounded(high) : 1;
    return [images[0].kind === "signed" ? -top : 0, top];
  }
  if (Number.isFinite(high) && high > low) return [low, high];
  return [Number.isFinite(low) ? Math.min(0, low) : 0, Math.max(1, high)];
}

/// The automatic look of pictures that are shown alike: {look, ev} or {look, map, low, high}.
export function lookOf(images) {
  const [{ channels, kind }] = images;
  if (channels.length === 1) {
    const [low, high] = range(images);
    return { look: "false", map: kind === "signed" ? "diverging" : "sequential", low, high };
  }
  if (channels.join("") === "XYZ") return { look: "direction" };
  // As image.png is exposed: the 95th percentile of luminance becomes 0.8 of white. In stops, to a tenth.
  const [, bright] = images[0].extent;
  return { look: "colour", ev: bright > 0 ? Math.round(10 * Math.log2(0.8 / bright)) / 10 : 0 };
}

/// A look with the user's exposure: the painter's parameters, and the `low` and `high` end of false colours. `ev` null:
/// the look's own. One stop up shows values half as large equally bright.
export function exposed(look, { ev, stops }) {
  if (look.look === "colour") return { ...look, gain: 2 ** (ev ?? look.ev), offset: 0 };
  if (look.look === "direction") return { ...look, gain: 0.5, offset: 0.5 };
  const span = (look.high - look.low) * 2 ** -stops;
  const low = look.map === "diverging" ? -span / 2 : look.low;
  return { ...look, low, high: low + span, gain: 1 / span, offset: -low / span };
}

export const steps = 256;  // of a colour map

/// Lightness, chroma and hue (OKLCH) for a value in [0, 1]: equal steps look like equal steps of lightness.
const colourMaps = {
  /// Dark violet over red to pale yellow: for values from 0, or from a minimum, up.
  sequential: (t) => [0.14 + 0.82 * t, 0.04 + 0.13 * Math.sin(Math.PI * t), 285 + 175 * t],
  /// Blue below, orange above, dark in the middle: for values of both signs.
  diverging: (t) => {
    const size = Math.abs(2 * t - 1);
    return [0.16 + 0.74 * size, 0.15 * Math.sin(0.5 * Math.PI * Math.min(1, 1.6 * size))
      * (1.15 - 0.45 * size), t < 0.5 ? 250 : 55];
  },
};

const made = {};

/// The map called `name`: `bytes`, RGBA, sRGB, and the same as a `picture`, of `steps` colours.
export function colourMap(name) {
  if (made[name]) return made[name];
  const context = new OffscreenCanvas(steps, 1).getContext("2d", { willReadFrequently: true });
  for (let i = 0; i < steps; i += 1) {
    context.fillStyle = `oklch(${colourMaps[name](i / (steps - 1)).join(" ")})`;
    context.fillRect(i, 0, 1, 1);
  }
  const bytes = context.getImageData(0, 0, steps, 1).data;
  const data = Float32Array.from(bytes, (value) => value / 255).filter((_, i) => i % 4 < 3);
  made[name] = { bytes, picture: { width: steps, height: 1, channels: ["R", "G", "B"], data } };
  return made[name];
}

const vertexSource = `#version 300 es
void main() {  // one triangle over everything
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;

const fragmentSource = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D picture;
uniform sampler2D colours;
uniform vec2 corner;     // the picture's point in the canvas's upper left corner
uniform float pace;      // pixels of the picture in one of the canvas
uniform float height;    // of the canvas
uniform int look;        // 0 colour, 1 direction, 2 false colour
uniform float gain, offset;
out vec4 colour;
const vec3 invalid = vec3(1.0, 0.0, 1.0);
const int most = 8;      // pixels averaged along a side
vec3 srgb(vec3 v) {
  v = clamp(v, 0.0, 1.0);
  return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
}

void main() {
  ivec2 size = textureSize(picture, 0);
  vec2 at = corner + pace * vec2(gl_FragCoord.x, height - gl_FragCoord.y);
  if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(size)))) {
    colour = vec4(0.0);
    return;
  }
  int n = clamp(int(ceil(pace)), 1, most);
  vec3 sum = vec3(0.0);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      vec2 shift = pace > 1.0 ? pace * ((vec2(i, j) + 0.5) / float(n) - 0.5) : vec2(0.0);
      sum += texelFetch(picture, clamp(ivec2(floor(at + shift)), ivec2(0), size - 1), 0).rgb;
    }
  }
  vec3 v = sum / float(n * n);
  if (look == 2) v = v.rrr;
  if (any(isnan(v)) || any(isinf(v))) {
    colour = vec4(invalid, 1.0);
    return;
  }
  v = v * gain + offset;
  if (look == 0) v = srgb(v);
  if (look == 2) v = texelFetch(colours, ivec2(clamp(v.r, 0.0, 1.0) * ${steps - 1}.0 + 0.5, 0), 0).rgb;
  colour = vec4(v, 1.0);
}`;

const looks = { colour: 0, direction: 1, false: 2 };
const keptTextures = 8;

/// A texture read only with texelFetch, for which floats need no extension.
function upload(gl, { width, height, channels, data }) {
  const largest = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  if (Math.max(width, height) > largest) throw new Error(`This browser draws at most ${largest} pixels a side.`);
  const [name, format] = channels.length === 1 ? ["R", gl.RED] : ["RGB", gl.RGB];
  const [bits, type, values] = data instanceof Float32Array ? [32, gl.FLOAT, data]
    : [16, gl.HALF_FLOAT, new Uint16Array(data.buffer)];
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl[`${name}${bits}F`], width, height, 0, format, type, values);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return texture;
}

/// The result of `make()`; null if the context is lost before or meanwhile, when its errors are ignored.
function unlessLost(gl, make) {
  try {
    const made = gl.isContextLost() ? null : make();
    return gl.isContextLost() ? null : made;
  } catch (error) {
    if (gl.isContextLost()) return null;
    throw error;
  }
}

/// The resources of one context; created again when the context was lost.
function resources(gl) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertexSource], [gl.FRAGMENT_SHADER, fragmentSource]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const uniform = Object.fromEntries(["picture", "colours", "corner", "pace", "height", "look", "gain", "offset"]
    .map((name) => [name, gl.getUniformLocation(program, name)]));
  gl.useProgram(program);
  gl.uniform1i(uniform.picture, 0);
  gl.uniform1i(uniform.colours, 1);
  return { uniform, textures: new Map() };
}

/// A painter on `canvas`; null without WebGL 2. `draw(parts, {x, y, pace})` (see the shader) paints [{image, look,
/// gain, offset, map, from, to}], `from` and `to` in [0, 1] of the width. The context may be lost at any moment: `draw`
/// then does nothing and returns false, and `onrestored` is called later.
export function painter(canvas, onrestored) {
  const gl = canvas.getContext("webgl2", { antialias: false, depth: false, premultipliedAlpha: true });
  if (!gl) return null;
  let held = unlessLost(gl, () => resources(gl));
  // Without this the browser would not restore the context.
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => {
    held = unlessLost(gl, () => resources(gl));
    if (held) onrestored();
  });

  /// Evicts the least recently used one if there are too many.
  function texture(image) {
    const { textures } = held;
    const found = textures.get(image) ?? upload(gl, image);
    textures.delete(image);
    textures.set(image, found);
    if (textures.size > keptTextures) {
      const [[oldest, old]] = textures;
      gl.deleteTexture(old);
      textures.delete(oldest);
    }
    return found;
  }

  function drawAll(parts, { x, y, pace }) {
    const { uniform } = held;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    gl.uniform2f(uniform.corner, x, y);
    gl.uniform1f(uniform.pace, pace);
    gl.uniform1f(uniform.height, canvas.height);
    for (const { image, look, gain, offset, map = "sequential", from, to } of parts) {
      [image, colourMap(map).picture].map(texture).forEach((one, unit) => {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(gl.TEXTURE_2D, one);
      });
      gl.uniform1i(uniform.look, looks[look]);
      gl.uniform1f(uniform.gain, gain * image.scale);
      gl.uniform1f(uniform.offset, offset);
      const left = Math.round(from * canvas.width);
      gl.scissor(left, 0, Math.max(0, Math.round(to * canvas.width) - left), canvas.height);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
    return true;
  }

  return {
    draw: (parts, place) => held !== null && unlessLost(gl, () => drawAll(parts, place)) !== null,
    release: () => gl.getExtension("WEBGL_lose_context")?.loseContext(),
  };
}

/// A function that draws `pictures`, [{image, canvas, wide}], alike: each `wide` CSS pixels wide, of which one has
/// `ratio` of the screen's. One per frame, read back in the next, because many at once, or waiting for one, would block
/// the page. The next call cancels the previous one; a lost context is created again.
export function stripPainter(signal) {
  const hidden = new OffscreenCanvas(1, 1);
  let paint = null;
  let last = [];
  signal.addEventListener("abort", () => paint?.release());

  async function draw(...given) {
    last = given;
    const [pictures, look, ratio] = given;
    paint ??= painter(hidden, () => draw(...last));
    for (const { image, canvas, wide } of pictures) {
      const [width, height] = [wide, wide * image.height / image.width].map((n) => Math.round(n * ratio) || 1);
      Object.assign(hidden, { width, height });
      if (!paint.draw([{ ...look, image, from: 0, to: 1 }], { x: 0, y: 0, pace: image.width / width })) return;
      await new Promise(requestAnimationFrame);
      if (last !== given || signal.aborted) return;
      Object.assign(canvas, { width, height });
      canvas.style.width = `${wide}px`;
      canvas.getContext("bitmaprenderer").transferFromImageBitmap(hidden.transferToImageBitmap());
    }
  }
  return draw;
}
