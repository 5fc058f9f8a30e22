// Draws points and lines by WebGL 2, in one pane or two side by side.

const POINT_SHADER = `#version 300 es
uniform mat4 matrix;
uniform float size, near_distance;
in vec3 position;
in vec4 color;
flat out vec3 tint;
void main() {
  gl_Position = color.a > 0.0 ? matrix * vec4(position, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = size * clamp(near_distance / gl_Position.w, 0.7, 2.0) * (color.a < 1.0 ? 1.7 : 1.0);
  tint = color.rgb;
}`;
const LINE_SHADER = `#version 300 es
uniform mat4 matrix;
in vec3 position;
in vec4 color;
flat out vec3 tint;
void main() {
  gl_Position = matrix * vec4(position, 1.0);
  tint = color.rgb;
}`;
const FRAGMENT_SHADER = `#version 300 es
precision mediump float;
flat in vec3 tint;
out vec4 result;
void main() { result = vec4(tint, 1.0); }`;

class Renderer {
  constructor(canvas) {
    this.canvas = canvas;
    this.drawn = 0;   // frames
    this.stride = 1;  // see Painter
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.start();
      this.onrestore?.();
    });
    this.start();
  }

  start() {
    const gl = this.gl = this.canvas.getContext('webgl2', {antialias: false, alpha: false});
    if (!gl) throw new Error('This browser has no WebGL 2, which draws the scan.');
    this.point_program = this.program(POINT_SHADER);
    this.line_program = this.program(LINE_SHADER);
    this.positions = gl.createBuffer();
    this.panes = [0, 1].map(() => ({points: this.vertices(), lines: this.vertices(), line_count: 0}));
    this.point_count = 0;
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.SCISSOR_TEST);
  }

  program(vertex_source) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex_source], [gl.FRAGMENT_SHADER, FRAGMENT_SHADER]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'position');
    gl.bindAttribLocation(program, 1, 'color');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const place = name => gl.getUniformLocation(program, name);
    return {program, matrix: place('matrix'), size: place('size'), near_distance: place('near_distance')};
  }

  vertices() {
    const gl = this.gl;
    return {array: gl.createVertexArray(), positions: gl.createBuffer(), colors: gl.createBuffer()};
  }

  fill({array, colors}, position_buffer, color_data) {
    const gl = this.gl;
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, position_buffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, colors);
    gl.bufferData(gl.ARRAY_BUFFER, color_data, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
  }

  setPositions(positions) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.positions);
    gl.bufferData(gl.ARRAY_BUFFER, positions, gl.STATIC_DRAW);
    this.point_count = positions.length / 3;
  }

  setColors(pane, colors) {
    this.fill(this.panes[pane].points, this.positions, colors);
  }

  // Pairs of points, in the same coordinates as the points.
  setLines(pane, positions, colors) {
    const gl = this.gl;
    const {lines} = this.panes[pane];
    gl.bindBuffer(gl.ARRAY_BUFFER, lines.positions);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(positions), gl.DYNAMIC_DRAW);
    this.fill(lines, lines.positions, new Uint32Array(colors));
    this.panes[pane].line_count = positions.length / 3;
  }

  // background: [red, green, blue], 0 to 255. size: pixels. near_distance: where points have that size, metres.
  draw(matrix, panes, background, size, near_distance) {
    const gl = this.gl;
    const width = this.canvas.width / panes;
    for (let pane = 0; pane < panes; ++pane) {
      const {points, lines, line_count} = this.panes[pane];
      const left = Math.round(pane * width);
      gl.viewport(left, 0, Math.round(width), this.canvas.height);
      gl.scissor(left, 0, Math.round(width), this.canvas.height);
      gl.clearColor(...background.map(value => value / 255), 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const use = ({program, matrix: place}) => {
        gl.useProgram(program);
        gl.uniformMatrix4fv(place, false, new Float32Array(matrix));
      };
      if (this.point_count) {
        use(this.point_program);
        gl.uniform1f(this.point_program.size, size);
        gl.uniform1f(this.point_program.near_distance, near_distance);
        gl.bindVertexArray(points.array);
        gl.drawArrays(gl.POINTS, 0, this.point_count);
      }
      if (line_count) {
        use(this.line_program);
        gl.bindVertexArray(lines.array);
        gl.drawArrays(gl.LINES, 0, line_count);
      }
    }
    ++this.drawn;
  }
}
