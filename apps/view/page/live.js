// A stream's frames, which lisco_stream sends by WebSocket, in place of scans in the page.

const PLOTS = [
  {name: 'Latency', unit: 'ms', of: ([latency]) => latency, text: value => value.toFixed(2)},
  {name: 'Rate', unit: 'columns/s', of: ([, rate]) => rate, text: value => value.toFixed(0)},
  {name: 'Lost', unit: 'packets', of: ([, , lost]) => lost, text: value => value.toFixed(0)},
];

class Live {
  constructor(view, path) {
    this.view = view;
    this.address = `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}${path}`;
    this.frames_lost = 0;  // sent by the stream, not shown here
    this.frames_shown = 0;
    this.paused = false;
    this.last = null;      // labelling of the last frame
    byId('stream').hidden = false;
    byId('list').before(byId('stream'));
    byId('pause').addEventListener('click', () => this.pause());
    this.plots = PLOTS.map(plot => {
      const canvas = element('canvas', {width: 592, height: 64});
      const value = element('b');
      byId('plots').append(element('figure', {}, element('figcaption', {}, `${plot.name} `, value), canvas));
      return {...plot, value, context: canvas.getContext('2d')};
    });
    this.connect();
  }

  connect() {
    this.say('Connecting…');
    const socket = new WebSocket(this.address);
    socket.binaryType = 'arraybuffer';
    socket.onmessage = ({data}) => {
      this.newest = data;
      this.schedule();
    };
    socket.onclose = () => {
      this.closed = true;
      if (this.newest) return;  // the last frame is still to be shown
      this.end();
    };
    this.closed = false;
  }

  end() {
    if (this.status?.state === 'ended') return this.say('Ended');
    this.say('Connection lost');
    setTimeout(() => this.connect(), 1000);
  }

  say(text) {
    byId('state').textContent = text;
  }

  pause() {
    this.paused = !this.paused;
    byId('pause').textContent = this.paused ? 'Go on' : 'Pause';
    this.schedule();
  }

  // A frame that comes while another one is drawn replaces those before it. While the user measures, the scene stays.
  schedule() {
    if (this.scheduled || !this.newest || this.paused || this.view.measure) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      const data = this.newest;
      this.newest = null;
      this.show(data);
      if (this.closed) this.end();
    });
  }

  show(data) {
    const size = new DataView(data).getUint32(0, true);
    const status = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, size)));
    const scan = new Scan(new Uint8Array(data, 4 + size));
    if (this.status) this.frames_lost += Math.max(0, status.frame - this.status.frame - 1);
    ++this.frames_shown;
    const labelling = scan.labellings[0];
    const ids = String(labelling.ids);
    const fills_list = status.result !== this.status?.result || ids !== this.ids;
    const fits = status.whole && !this.was_whole;  // the first columns are a sector at one side of the sensor
    this.was_whole ||= status.whole;
    this.ids = ids;
    this.status = status;
    const visible = new Uint32Array(labelling.clusters.length + 2);
    for (const c of labelling.classes) ++visible[c];
    for (const cluster of labelling.clusters) {
      cluster.open = cluster.id > labelling.listed;
      cluster.swept = visible[cluster.id + 1] < cluster.size / 2;  // the sensor has passed it since
    }
    this.follow(labelling);
    this.view.replace(scan, {fills_list, fits});
    this.showStatus(labelling);
  }

  // A cluster of the last frame keeps its colour and stays selected.
  follow(labelling) {
    const {view} = this;
    const before = colorAfter(labelling, this.last);
    const selected = view.selected;
    if (selected) view.selected = labelling.clusters.find(cluster => before.get(cluster)?.id === selected)?.id ?? 0;
    this.last = labelling;
  }

  showStatus(labelling) {
    const {status} = this;
    const in_clusters = labelling.clusters.reduce((sum, {open, size}) => sum + (open ? 0 : size), 0);
    const open = labelling.clusters.length - labelling.listed;
    byId('counts').textContent = `${status.result ? `${status.result}: ` : ''}${labelling.listed} clusters of ` +
      `${in_clusters} points · ${open} open subclusters · tolerance ${labelling.tolerance} m`;
    byId('totals').textContent = [`${status.rotations} ${status.unit}`, `${status.columns} columns`,
      `${status.returns} returns`, `${status.clusters} clusters`, `${status.lost} packets lost`,
      `${this.frames_lost} frames lost`].join(' · ');
    const [p50, p99, max] = status.latency_ms;
    byId('pause').hidden = status.state === 'ended';
    this.say(status.state === 'ended' ? 'Ended' : this.paused ? 'Paused' : 'Live');
    for (const {unit, of, text, value, context} of this.plots) {
      const values = status.samples.map(of);
      const last = unit === 'ms' ? `p50 ${p50.toFixed(2)}, p99 ${p99.toFixed(2)}, most ${max.toFixed(2)} ms`
        : `${text(values.length ? values[values.length - 1] : 0)} ${unit}`;
      value.textContent = last;
      this.plot(context, values);
    }
  }

  // Up to a minute, the latest sample at the right; 0 at the bottom.
  plot(context, values) {
    const {width, height} = context.canvas;
    const most = Math.max(1e-9, ...values);
    context.clearRect(0, 0, width, height);
    context.strokeStyle = this.view.look.theme === 'dark' ? '#57b5e8' : '#1f86c0';
    context.lineWidth = 3;
    context.beginPath();
    values.forEach((value, k) => {
      const x = width - 2 - (values.length - 1 - k) * (width - 4) / Math.max(39, values.length - 1);
      const y = height - 3 - value / most * (height - 6);
      k ? context.lineTo(x, y) : context.moveTo(x, y);
    });
    context.stroke();
  }
}
