// Mouse, touch and keyboard.

const CLICK_DISTANCE = 6;  // CSS pixels a pointer may move between press and release of a click

function listenToPointers(canvas, view) {
  const pointers = new Map();
  let moved = 0;
  let last_tap = {time: -Infinity, x: 0, y: 0};
  const place = event => ({x: event.offsetX, y: event.offsetY});
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, distance: Math.hypot(a.x - b.x, a.y - b.y)};
  };
  canvas.addEventListener('pointerdown', event => {
    canvas.setPointerCapture(event.pointerId);
    if (!pointers.size) moved = 0;
    pointers.set(event.pointerId, place(event));
    view.camera.flight = null;
  });
  canvas.addEventListener('pointermove', event => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const spread_before = pointers.size === 2 ? spread() : null;
    const now = place(event);
    pointers.set(event.pointerId, now);
    const [x, y] = [now.x - before.x, now.y - before.y];
    moved += Math.hypot(x, y);
    if (moved < CLICK_DISTANCE) return;
    if (spread_before) {
      const spread_now = spread();
      view.camera.pan(spread_now.x - spread_before.x, spread_now.y - spread_before.y, canvas.clientHeight);
      if (spread_now.distance > 0) view.camera.zoom(spread_before.distance / spread_now.distance);
      moved = Infinity;
    } else if (pointers.size === 1) {
      const pans = event.shiftKey || event.ctrlKey || (event.buttons & 6);
      if (pans) view.camera.pan(x, y, canvas.clientHeight);
      else view.camera.turn(-x * 0.006, y * 0.006);
    }
    view.redraw();
  });
  const release = event => {
    if (!pointers.delete(event.pointerId) || event.type === 'pointercancel') return;
    if (moved >= CLICK_DISTANCE || event.button > 0) return;
    const {x, y} = place(event);
    const is_double = event.timeStamp - last_tap.time < 350 && Math.hypot(x - last_tap.x, y - last_tap.y) < 20;
    last_tap = {time: event.timeStamp, x, y};
    const reach = event.pointerType === 'touch' ? 22 : 9;
    if (is_double && !view.measure) view.flyToPointAt(x, y, reach);
    else view.click(x, y, reach);
  };
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('contextmenu', event => event.preventDefault());
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    view.camera.flight = null;
    view.camera.zoom(Math.exp(Math.max(-100, Math.min(100, event.deltaY * lines)) * 0.0015));
    view.redraw();
  }, {passive: false});
}

const KEYS = [
  ['drag, arrows', 'turn'],
  ['right drag, two fingers, shift arrows', 'move'],
  ['wheel, pinch, + −', 'zoom'],
  ['click, double click', 'select, fly there'],
  ['space , .', 'play, previous, next scan'],
  ['g n b i', 'ground, noise, boxes, ids'],
  ['c', 'next colour'],
  ['m', 'measure between two points'],
  ['f', 'fly to the selected cluster'],
  ['t r o', 'top view, reset, turn'],
  ['l', 'dark or light'],
  ['Esc', 'clear'],
];

function listenToKeys(view) {
  const step = 0.06;
  const camera = view.camera;
  const moves = {
    ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
  };
  const actions = {
    '+': () => camera.zoom(0.9), '=': () => camera.zoom(0.9), '-': () => camera.zoom(1 / 0.9),
    ' ': () => view.play(!view.playing), ',': () => view.show(view.frame - 1), '.': () => view.show(view.frame + 1),
    g: () => view.toggle('ground'), n: () => view.toggle('noise'), b: () => view.toggle('boxes'),
    i: () => view.toggle('ids'), m: () => view.toggle('measure'), o: () => view.toggle('turning'),
    c: () => view.nextColor(), f: () => view.flyTo(view.selected), t: () => view.top(), r: () => view.reset(),
    l: () => view.setTheme(view.look.theme === 'dark' ? 'light' : 'dark'), '?': () => view.help(),
    Escape: () => view.clear(),
  };
  addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const field = event.target.closest?.('input, select');
    const is_for_field = field && (field.type !== 'range' || /^(Arrow|Home|End|Page)/.test(event.key));
    if (is_for_field || (event.key === ' ' && event.target.closest?.('button'))) return;
    const move = moves[event.key];
    if (move) {
      if (event.target.closest?.('#list')) return;
      if (event.shiftKey) camera.pan(-40 * move[0], 40 * move[1], view.height);
      else camera.turn(step * move[0], step * move[1]);
    } else {
      const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!action) return;
      action();
    }
    camera.flight = event.key === 'f' || event.key === 'F' ? camera.flight : null;
    event.preventDefault();
    view.redraw();
  });
}
