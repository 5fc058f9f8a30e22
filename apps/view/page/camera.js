// A camera that turns about a target. Display coordinates: x ahead, y to the left, z up, metres, from its origin.

const FIELD_OF_VIEW = 50 * Math.PI / 180;  // vertical

class Camera {
  constructor() {
    this.set({target: [0, 0, 0], distance: 30, yaw: Math.PI, pitch: 0.6, reach: 100});
  }

  set(values) {
    Object.assign(this, values);
    this.pitch = Math.max(-1.5, Math.min(Math.PI / 2, this.pitch));
    this.distance = Math.max(0.2, Math.min(1e5, this.distance));
  }

  // Unit vectors to the right, up and back on the screen.
  axes() {
    const [sin_yaw, cos_yaw] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    const [sin_pitch, cos_pitch] = [Math.sin(this.pitch), Math.cos(this.pitch)];
    return {
      right: [-sin_yaw, cos_yaw, 0],
      up: [-sin_pitch * cos_yaw, -sin_pitch * sin_yaw, cos_pitch],
      back: [cos_pitch * cos_yaw, cos_pitch * sin_yaw, sin_pitch],
    };
  }

  // Equal if nothing has moved.
  place() {
    return JSON.stringify([this.target, this.distance, this.yaw, this.pitch]);
  }

  turn(yaw, pitch) {
    this.set({yaw: this.yaw + yaw, pitch: this.pitch + pitch});
  }

  // By pixels on a screen of this height.
  pan(x, y, height) {
    const {right, up} = this.axes();
    const metres = 2 * this.distance * Math.tan(FIELD_OF_VIEW / 2) / height;
    this.target = this.target.map((value, axis) => value + metres * (y * up[axis] - x * right[axis]));
  }

  zoom(factor) {
    this.set({distance: this.distance * factor});
  }

  // Display coordinates to clip coordinates, column by column.
  matrix(aspect) {
    const {right, up, back} = this.axes();
    const f = 1 / Math.tan(FIELD_OF_VIEW / 2);
    const near = Math.max(0.02, this.distance * 0.02);
    const far = this.distance + 2 * this.reach;
    const [a, b] = [-(far + near) / (far - near), -2 * far * near / (far - near)];
    const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    const matrix = new Float64Array(16);
    for (let axis = 0; axis < 3; ++axis) {
      matrix[4 * axis] = f / aspect * right[axis];
      matrix[4 * axis + 1] = f * up[axis];
      matrix[4 * axis + 2] = a * back[axis];
      matrix[4 * axis + 3] = -back[axis];
    }
    const depth = -dot(back, this.target) - this.distance;
    matrix[12] = -f / aspect * dot(right, this.target);
    matrix[13] = -f * dot(up, this.target);
    matrix[14] = a * depth + b;
    matrix[15] = -depth;
    return matrix;
  }

  // Moves to a target and distance in 0.6 s, or at once if the user prefers less motion.
  fly(target, distance, redraw) {
    const from = {target: this.target, distance: this.distance};
    const start = performance.now();
    const time = matchMedia('(prefers-reduced-motion: reduce)').matches ? 0 : 600;
    const flight = this.flight = {};
    return new Promise(resolve => {
      const step = now => {
        if (this.flight !== flight) return resolve();
        const part = time ? Math.min(1, Math.max(0, (now - start) / time)) : 1;
        const eased = part * part * (3 - 2 * part);
        this.set({
          target: from.target.map((value, axis) => value + eased * (target[axis] - value)),
          distance: from.distance * (distance / from.distance) ** eased,
        });
        redraw();
        part < 1 ? requestAnimationFrame(step) : resolve();
      };
      step(start);
    });
  }
}

// Column-major 4 x 4 matrices.
function multiplied(a, b) {
  const result = new Float64Array(16);
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row)
      for (let k = 0; k < 4; ++k) result[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return result;
}

// From a scan's steps to display coordinates. origin: the page's, in the scan's coordinates.
function displayMatrix(scan, origin) {
  const axes = scan.camera ? [[0, -1, 0], [0, 0, -1], [1, 0, 0]] : [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const offset = scan.origin.map((value, axis) => value - origin[axis]);
  const matrix = new Float64Array(16);
  for (let row = 0; row < 3; ++row) {
    for (let axis = 0; axis < 3; ++axis) {
      matrix[4 * axis + row] = scan.step * axes[axis][row];
      matrix[12 + row] += offset[axis] * axes[axis][row];
    }
  }
  matrix[15] = 1;
  return matrix;
}
