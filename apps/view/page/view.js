// The state of the page, and what happens to it.

const REST = 100;  // ms without a frame, after which the scene is at rest

class View {
  constructor() {
    this.camera = new Camera();
    this.renderer = makeRenderer(byId('scene'));
    this.overlay = new Overlay(byId('overlay'));
    this.scans = [];
    this.frame = 0;
    this.labellings = [0];  // one per pane
    this.selected = 0;      // cluster, from 1
    this.point = -1;        // clicked
    this.ends = [];         // of the measured line
    this.boxes = true;
    this.ids = this.measure = this.turning = this.playing = false;
    const prefers_light = matchMedia('(prefers-color-scheme: light)').matches;
    this.look = {mode: 'cluster', ground: true, noise: true, theme: prefers_light ? 'light' : 'dark'};
    this.size = 2.5;
    this.list = new ClusterList(this);
    document.documentElement.classList.toggle('light', prefers_light);
    this.renderer.onrestore = () => this.show(this.frame);
    new ResizeObserver(() => this.redraw()).observe(byId('stage'));
  }

  get scan() { return this.scans[this.frame]; }
  get labelling() { return this.labellingOf(0); }
  get height() { return byId('stage').clientHeight; }
  labellingOf(pane) { return this.scan.labellings[Math.min(this.labellings[pane], this.scan.labellings.length - 1)]; }

  add(scan) {
    this.scans.push(scan);
    if (this.scans.length === 1) {
      this.origin = scan.origin;
      this.show(0);
      this.reset();
    }
    byId('timeline').hidden = this.scans.length < 2;
    byId('frame').max = this.scans.length - 1;
    this.nameFrame();
  }

  nameFrame() {
    byId('frame').value = this.frame;
    byId('frame-name').textContent = `${this.frame + 1} of ${this.scans.length}: ${this.scan.name}`;
  }

  // Shows a scan of the timeline; beyond its ends, the one at the other end.
  show(frame) {
    if (!this.scans.length) return;
    this.frame = (frame + this.scans.length) % this.scans.length;
    this.selected = 0;
    this.point = -1;
    this.ends = [];
    const scan = this.scan;
    scan.labellings.forEach((labelling, k) => colorAfter(labelling, this.scans[this.frame - 1]?.labellings[k]));
    this.matrix = displayMatrix(scan, this.origin);
    this.renderer.setPositions(scan.positions);
    for (const option of byId('color').options)
      option.disabled = option.value in {intensity: 1, ring: 1} && !scan[option.value];
    if (byId('color').selectedOptions[0]?.disabled) this.setColor('cluster');
    byId('name').textContent = scan.name;
    this.nameFrame();
    byId('info').hidden = true;
    this.compare();
    this.recolor();
    this.list.fill();
    showCounts(scan, this.labelling);
  }

  // The next frame of a stream: what the user has chosen stays.
  // fits: a camera that the user has not moved is placed again
  replace(scan, {fills_list, fits}) {
    const had_points = this.scan?.points > 0;
    this.scans = [scan];
    this.point = -1;
    this.ends = [];
    if (!had_points) this.origin = scan.origin;
    this.matrix = displayMatrix(scan, this.origin);
    this.renderer.setPositions(scan.positions);
    byId('name').textContent = scan.name;
    if (!had_points && scan.points) {
      say('');
      this.reset();
    } else if (fits && this.isAsPlaced()) {
      this.reset();
    }
    if (this.selected) showSelection(scan, this.labelling, this.selected, -1);
    else if (!this.measure) byId('info').hidden = true;
    this.recolor();
    if (fills_list) this.list.update();
  }

  // Offers the labellings of a scan that has several, and marks where the two that are shown differ.
  compare() {
    const {labellings} = this.scan;
    byId('labellings').hidden = labellings.length < 2;
    this.difference = null;
    if (labellings.length < 2) this.labellings = [0];
    for (const [pane, id] of ['left', 'right'].entries()) {
      const options = labellings.map(({name}, index) => element('option', {value: index, textContent: name}));
      if (pane === 1) options.push(element('option', {value: -1, textContent: 'none'}));
      byId(id).replaceChildren(...options);
      byId(id).value = this.labellings[pane] ?? -1;
    }
    if (this.labellings.length < 2) return;
    this.difference = differencesOf(this.labellingOf(0), this.labellingOf(1));
    byId('differences').textContent = `${this.difference.count} points differ`;
  }

  setLabellings(left, right) {
    this.labellings = right < 0 ? [left] : [left, right];
    this.show(this.frame);
  }

  // The cluster of a pane that is selected: in the right one, the partner of the left one's.
  selectedIn(pane) {
    if (pane === 0 || !this.selected) return this.selected;
    return (this.difference.partner_of_left.get(this.selected + 1) ?? 1) - 1;
  }

  recolor() {
    if (!this.scans.length) return;
    const {theme} = this.look;
    this.labellings.forEach((_, pane) => {
      const labelling = this.labellingOf(pane);
      const selected = this.selectedIn(pane);
      const differs = this.difference?.differs;
      this.renderer.setColors(pane, pointColors(this.scan, labelling, {...this.look, selected, differs}));
      this.renderer.setLines(pane, ...boxLines(this.scan, labelling, {shown: this.boxes, selected, theme}));
    });
    this.showScale();
    this.redraw();
  }

  showScale() {
    const {mode, theme} = this.look;
    const scale = byId('scale');
    scale.hidden = mode === 'cluster';
    if (scale.hidden) return;
    const {low, high} = this.scan[`values_${mode}`];
    const unit = mode === 'height' || mode === 'range' ? ' m' : '';
    const text = value => Number(value.toPrecision(3)) + unit;
    const [from, bar, to] = scale.children;
    from.textContent = `${mode} ${text(low)}`;
    to.textContent = text(high);
    const stops = scaleColors(theme).filter((_, level) => level % 16 === 0).map(color => `rgb(${color})`);
    bar.style.background = `linear-gradient(to right, ${stops})`;
  }

  redraw() {
    if (this.scheduled || !this.scans.length) return;
    this.scheduled = true;
    requestAnimationFrame(now => {
      this.scheduled = false;
      this.draw(now);
    });
  }

  draw(now) {
    const stage = byId('stage');
    const ratio = Math.min(2, devicePixelRatio || 1);
    const [width, height] = [Math.round(stage.clientWidth * ratio), Math.round(stage.clientHeight * ratio)];
    for (const canvas of [this.renderer.canvas, this.overlay.canvas]) {
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
    }
    if (!width || !height) return;
    if (this.turning) {
      this.camera.turn(0.4 * Math.min(0.1, (now - (this.turned_at ?? now)) / 1000), 0);
      this.turned_at = now;
      this.redraw();
    }
    const panes = this.labellings.length;
    this.clip = multiplied(this.camera.matrix(width / panes / height), this.matrix);
    const dark = this.look.theme === 'dark';
    const moves = performance.now() - (this.drawn_at ?? -Infinity) < REST;
    const background = rgb(dark ? '#0e1013' : '#fafaf8');
    this.renderer.draw(this.clip, panes, background, this.size * ratio, this.camera.distance, moves);
    this.drawn_at = performance.now();
    clearTimeout(this.rest);
    if (this.renderer.stride > 1) this.rest = setTimeout(() => this.redraw(), 1.5 * REST);  // all points
    this.drawOverlay(ratio, panes, dark ? ['#ffffff', '#000000'] : ['#000000', '#ffffff']);
    this.shown_at ??= performance.now();  // ms after the page was opened
  }

  drawOverlay(ratio, panes, [color, halo]) {
    this.overlay.clear(ratio);
    const {clientWidth: width, clientHeight: height} = byId('stage');
    for (let pane = 0; pane < panes; ++pane) {
      if (panes > 1) this.overlay.title(this.labellingOf(pane).name, (pane + 0.5) * width / panes, color, halo);
      if (this.ids) {
        const named = this.labellingOf(pane).clusters.filter(({open, swept}) => !open && !swept);
        const places = named.map(({name, center, height: tall}) => {
          const above = [center[0], center[1], center[2] + (this.scan.camera ? 0 : tall / 2)];
          const place = this.screenOf(above.map((v, axis) => (v - this.scan.origin[axis]) / this.scan.step), pane);
          return place && {text: String(name), x: place[0], y: place[1] - 8};
        });
        this.overlay.ids(places.filter(place => place && this.paneAt(place.x) === pane), color, halo);
      }
      const ends = this.ends.map(i => this.screenOf(this.scan.positions.subarray(3 * i, 3 * i + 3), pane));
      if (!ends.length || ends.includes(null)) continue;
      const text = ends.length === 2 ? verdictOf(this.scan, 0, this.ends).text : '';
      this.overlay.measure(ends, text, color, halo);
    }
    if (panes > 1) this.overlay.line(width / 2, height, color);
  }

  paneAt(x) {
    return Math.min(this.labellings.length - 1, Math.floor(x / byId('stage').clientWidth * this.labellings.length));
  }

  // Where a position (steps from the scan's origin) is on the stage, CSS pixels; null if it is behind the camera.
  screenOf([x, y, z], pane = 0) {
    const m = this.clip;
    if (!m) return null;  // nothing is drawn yet
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    if (w <= 0) return null;
    const {clientWidth, clientHeight} = byId('stage');
    const width = clientWidth / this.labellings.length;
    return [
      width * (pane + 0.5 + 0.5 * (m[0] * x + m[4] * y + m[8] * z + m[12]) / w),
      clientHeight * (0.5 - 0.5 * (m[1] * x + m[5] * y + m[9] * z + m[13]) / w),
    ];
  }

  // The point at a place on the stage: of those that cover it, the nearest to the camera; if there are none, the one
  // that is drawn nearest, within `reach` pixels. -1: none.
  pointNear(x, y, reach) {
    const pane = this.paneAt(x);
    const {scan, clip: m, look} = this;
    if (!m) return -1;
    const {classes} = this.labellingOf(pane);
    const {clientWidth, clientHeight} = byId('stage');
    const width = clientWidth / this.labellings.length;
    const [clip_x, clip_y] = [2 * (x - pane * width) / width - 1, 1 - 2 * y / clientHeight];
    let best = -1;
    let best_cost = Infinity;
    for (let i = 0, at = 0; i < scan.points; ++i, at += 3) {
      if ((classes[i] === GROUND && !look.ground) || (classes[i] === NOISE && !look.noise)) continue;
      const [px, py, pz] = [scan.positions[at], scan.positions[at + 1], scan.positions[at + 2]];
      const w = m[3] * px + m[7] * py + m[11] * pz + m[15];
      if (w <= 0) continue;
      const dx = ((m[0] * px + m[4] * py + m[8] * pz + m[12]) / w - clip_x) * width / 2;
      const dy = ((m[1] * px + m[5] * py + m[9] * pz + m[13]) / w - clip_y) * clientHeight / 2;
      const half = this.size * Math.max(0.7, Math.min(2, this.camera.distance / w)) / 2;
      const covers = Math.max(Math.abs(dx), Math.abs(dy)) <= half;
      const distance = Math.hypot(dx, dy);
      if (!covers && distance > reach) continue;
      const cost = covers ? -1 / w : distance;
      if (cost < best_cost) [best, best_cost] = [i, cost];
    }
    return best;
  }

  click(x, y, reach) {
    const point = this.pointNear(x, y, reach);
    if (this.measure) {
      if (point >= 0) this.ends = this.ends.length === 2 ? [point] : [...this.ends, point];
      showMeasure(this.scan, this.labelling, this.ends);
      this.redraw();
      return;
    }
    this.point = point;
    let selected = point < 0 ? 0 : Math.max(0, this.labellingOf(this.paneAt(x)).classes[point] - NOISE);
    if (selected && this.paneAt(x) === 1) selected = (this.difference.partner_of_right.get(selected + 1) ?? 1) - 1;
    this.select(selected, false, point);
  }

  // cluster: from 1; 0: none
  select(cluster, flies, point = -1) {
    this.selected = cluster;
    this.point = point;
    showSelection(this.scan, this.labelling, cluster, point);
    this.list.mark(cluster);
    this.recolor();
    return flies ? this.flyTo(cluster) : Promise.resolve();
  }

  displayOf(position) {
    const m = this.matrix;
    const steps = position.map((value, axis) => (value - this.scan.origin[axis]) / this.scan.step);
    return [0, 1, 2].map(row => m[row] * steps[0] + m[4 + row] * steps[1] + m[8 + row] * steps[2] + m[12 + row]);
  }

  flyTo(cluster) {
    const found = clusterOf(this.labelling, cluster);
    if (!found) return Promise.resolve();
    const radius = Math.hypot(found.length, found.width, found.height) / 2;
    return this.camera.fly(this.displayOf(found.center), Math.max(3, 4 * radius), () => this.redraw());
  }

  flyToPointAt(x, y, reach) {
    const point = this.pointNear(x, y, reach);
    if (point >= 0)
      this.camera.fly(this.displayOf(this.scan.pointAt(point)), this.camera.distance / 2, () => this.redraw());
  }

  // Shows most of the scan from behind and above.
  reset() {
    const {scan, camera} = this;
    const stride = Math.max(1, Math.floor(scan.points / 5000));
    const distances = [];
    for (let i = 0; i < scan.points; i += stride)
      distances.push(scan.step * Math.hypot(...scan.positions.subarray(3 * i, 3 * i + 3)));
    distances.sort((a, b) => a - b);
    const at = part => distances[Math.floor(part * (distances.length - 1))] || 1;
    camera.flight = null;
    camera.set({target: this.displayOf(scan.origin), distance: 1.8 * at(0.8), reach: 1.1 * at(1) + 10,
      yaw: Math.PI, pitch: scan.camera ? 0.15 : 0.6});
    this.placed = camera.place();
    this.redraw();
  }

  // Whether the camera is where reset() has put it.
  isAsPlaced() { return this.placed === this.camera.place(); }

  top() {
    this.camera.set({yaw: Math.PI, pitch: Math.PI / 2});
    this.redraw();
  }

  toggle(name) {
    const owner = name in this.look ? this.look : this;
    owner[name] = !owner[name];
    document.querySelector(`[data-toggle=${name}]`).setAttribute('aria-pressed', owner[name]);
    if (name === 'turning') this.turned_at = undefined;
    if (name === 'measure') {
      this.live?.schedule();
      this.ends = [];
      this.overlay.canvas.classList.toggle('measuring', this.measure);
      if (this.measure) showMeasure(this.scan, this.labelling, []);
      else byId('info').hidden = true;
    }
    this.recolor();
  }

  setColor(mode) {
    byId('color').value = this.look.mode = mode;
    this.recolor();
  }
  nextColor() {
    const modes = [...byId('color').options].filter(option => !option.disabled).map(option => option.value);
    this.setColor(modes[(modes.indexOf(this.look.mode) + 1) % modes.length]);
  }

  setTheme(theme) {
    this.look.theme = theme;
    document.documentElement.classList.toggle('light', theme === 'light');
    this.recolor();
    this.list.fill();
  }

  play(plays) {
    if (this.live) {
      this.live.pause();
      return;
    }
    clearInterval(this.playing);
    this.playing = plays && this.scans.length > 1 ? setInterval(() => this.show(this.frame + 1), 100) : false;
    byId('play').textContent = this.playing ? '❚❚' : '▶';
    byId('play').setAttribute('aria-label', this.playing ? 'Pause' : 'Play');
  }

  help() {
    const help = byId('help');
    if (help.hidden) showDefinitions(help, 'Keys', KEYS);
    else help.hidden = true;
  }

  clear() {
    byId('help').hidden = true;
    if (this.measure) this.toggle('measure');
    this.select(0, false);
  }
}
