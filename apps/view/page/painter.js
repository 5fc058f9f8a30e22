// Draws what Renderer draws, without WebGL: about ten times faster than WebGL where that is software itself.

const MARGIN = 20;               // pixels beyond an edge, from which a point may still reach across it
const SLOW_FRAME = 22;           // ms; 30 frames a second leave 33, of which the browser takes some
const FAST_FRAME = 8;            // ms; below a half of SLOW_FRAME, so that the number of points settles
const ALWAYS_DRAWN = 20000;      // points

class Painter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d', {alpha: false, willReadFrequently: true});
    this.drawn = 0;  // frames
    this.stride = 1;         // every how many points were drawn
    this.moving_stride = 1;  // the same while the scene moves
    this.frame_time = 0;     // of frames in motion, ms, smoothed
    this.positions = new Float32Array(0);
    this.panes = [0, 1].map(() => ({colors: new Int32Array(0), lines: [], line_colors: []}));
  }

  setPositions(positions) {
    this.positions = positions;
  }

  setColors(pane, colors) {
    this.panes[pane].colors = new Int32Array(colors.buffer);
  }

  setLines(pane, positions, colors) {
    this.panes[pane].lines = positions;
    this.panes[pane].line_colors = colors;
  }

  // moves: fewer points are drawn if all would take too long
  draw(matrix, panes, background, size, near_distance, moves) {
    const start = performance.now();
    this.stride = moves ? this.moving_stride : 1;
    const {width, height} = this.canvas;
    if (this.image?.width !== width || this.image.height !== height) {
      this.image = this.context.createImageData(width, height);
      this.pixels = new Int32Array(this.image.data.buffer);
      this.depths = new Float32Array(width * height);
    }
    this.pixels.fill(packed(background));
    this.depths.fill(Infinity);
    for (let pane = 0; pane < panes; ++pane) {
      const left = Math.round(pane * width / panes);
      const right = Math.round((pane + 1) * width / panes);
      // Pixels times w, in place of clip coordinates.
      const screen = new Float64Array(matrix);
      for (let column = 0; column < 16; column += 4) {
        screen[column] = (right - left) / 2 * matrix[column] + (left + right) / 2 * matrix[column + 3];
        screen[column + 1] = -height / 2 * matrix[column + 1] + height / 2 * matrix[column + 3];
      }
      this.drawPoints(screen, left, right, this.panes[pane].colors, size, near_distance);
      this.drawLines(screen, left, right, this.panes[pane]);
    }
    this.context.putImageData(this.image, 0, 0);
    ++this.drawn;
    if (moves) this.adapt(performance.now() - start);
  }

  adapt(milliseconds) {
    this.frame_time += 0.3 * (milliseconds - this.frame_time);
    const points = this.positions.length / 3 / this.moving_stride;
    const slower = this.frame_time > SLOW_FRAME && points > 2 * ALWAYS_DRAWN;
    if (!slower && !(this.frame_time < FAST_FRAME && this.moving_stride > 1)) return;
    this.moving_stride *= slower ? 2 : 0.5;
    this.frame_time *= slower ? 0.5 : 2;
  }

  drawPoints(m, left, right, colors, size, near_distance) {
    const {positions, pixels, depths, stride} = this;
    const {width, height} = this.canvas;
    const [m0, m1, m3, m4, m5, m7, m8, m9, m11, m12, m13, m15] =
      [0, 1, 3, 4, 5, 7, 8, 9, 11, 12, 13, 15].map(at => m[at]);
    const nearest = 0.02 * near_distance;
    const [low_x, high_x, high_y] = [left - MARGIN, right + MARGIN, height + MARGIN];
    for (let i = 0; i < colors.length; i += stride) {
      const color = colors[i];
      const alpha = color >>> 24;
      if (alpha === 0) continue;
      const at = 3 * i;
      const x = positions[at], y = positions[at + 1], z = positions[at + 2];
      const w = m3 * x + m7 * y + m11 * z + m15;
      if (w < nearest) continue;
      const inverse = 1 / w;
      const screen_x = (m0 * x + m4 * y + m8 * z + m12) * inverse;
      const screen_y = (m1 * x + m5 * y + m9 * z + m13) * inverse;
      if (!(screen_x > low_x && screen_x < high_x && screen_y > -MARGIN && screen_y < high_y)) continue;
      let wanted = near_distance * inverse;
      wanted = size * (wanted < 0.7 ? 0.7 : wanted > 2 ? 2 : wanted);
      if (alpha < 255) wanted *= 1.7;
      const side = wanted < 1 ? 1 : wanted + 0.5 | 0;
      // Rounded down: truncated where all is positive.
      const shift = 2 * MARGIN + 0.5 - side / 2;
      const from_x = (screen_x + shift | 0) - 2 * MARGIN, from_y = (screen_y + shift | 0) - 2 * MARGIN;
      const opaque = color | 0xff000000;
      const first_x = from_x < left ? left : from_x, last_x = from_x + side > right ? right : from_x + side;
      const first_y = from_y < 0 ? 0 : from_y, last_y = from_y + side > height ? height : from_y + side;
      for (let row = first_y * width, end_row = last_y * width; row < end_row; row += width) {
        for (let pixel = row + first_x, end = row + last_x; pixel < end; ++pixel) {
          if (w >= depths[pixel]) continue;
          depths[pixel] = w;
          pixels[pixel] = opaque;
        }
      }
    }
  }

  drawLines(m, left, right, {lines, line_colors}) {
    const {pixels, depths} = this;
    const {width, height} = this.canvas;
    const nearest = 1e-3;
    const ends = [[0, 0, 0], [0, 0, 0]];
    for (let line = 0; line < lines.length; line += 6) {
      ends.forEach((end, k) => {
        const [x, y, z] = [lines[line + 3 * k], lines[line + 3 * k + 1], lines[line + 3 * k + 2]];
        for (const [row, place] of [[0, 0], [1, 1], [3, 2]])
          end[place] = m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row];
      });
      let [a, b] = ends;
      if (a[2] < b[2]) [a, b] = [b, a];
      if (a[2] < nearest) continue;
      if (b[2] < nearest) {  // cut where the line comes near the camera
        const part = (a[2] - nearest) / (a[2] - b[2]);
        b = a.map((value, k) => value + part * (b[k] - value));
      }
      const [from_x, from_y, to_x, to_y] = [a[0] / a[2], a[1] / a[2], b[0] / b[2], b[1] / b[2]];
      const steps = Math.ceil(Math.max(Math.abs(to_x - from_x), Math.abs(to_y - from_y), 1));
      // The part of the line that is on the screen.
      let [first, last] = [0, 1];
      for (const [from, to, low, high] of [[from_x, to_x, left, right], [from_y, to_y, 0, height]]) {
        const [p, q] = [(low - from) / (to - from), (high - from) / (to - from)];
        if (to === from && (from < low || from >= high)) last = -1;
        else if (to !== from) [first, last] = [Math.max(first, Math.min(p, q)), Math.min(last, Math.max(p, q))];
      }
      for (let step = Math.ceil(first * steps); step <= last * steps; ++step) {
        const part = step / steps;
        const [x, y] = [Math.floor(from_x + part * (to_x - from_x)), Math.floor(from_y + part * (to_y - from_y))];
        if (x < left || x >= right || y < 0 || y >= height) continue;
        const w = 1 / (1 / a[2] + part * (1 / b[2] - 1 / a[2]));
        const pixel = y * width + x;
        if (w > depths[pixel]) continue;
        depths[pixel] = w;
        pixels[pixel] = line_colors[line / 3];
      }
    }
  }
}

// Whether WebGL 2 is drawn by a graphics processor.
function hasFastWebGl() {
  const gl = document.createElement('canvas').getContext('webgl2', {failIfMajorPerformanceCaveat: true});
  if (!gl) return false;
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

// #webgl and #painter in the page's address override the choice.
function makeRenderer(canvas) {
  const uses_webgl = location.hash === '#webgl' || (location.hash !== '#painter' && hasFastWebGl());
  return uses_webgl ? new Renderer(canvas) : new Painter(canvas);
}
