function connect(view) {
  listenToPointers(byId('overlay'), view);
  listenToKeys(view);
  for (const button of document.querySelectorAll('[data-toggle]'))
    button.addEventListener('click', () => view.toggle(button.dataset.toggle));
  const actions = {
    top: () => view.top(), reset: () => view.reset(), help: () => view.help(),
    theme: () => view.setTheme(view.look.theme === 'dark' ? 'light' : 'dark'),
  };
  for (const button of document.querySelectorAll('[data-action]'))
    button.addEventListener('click', actions[button.dataset.action]);
  byId('color').addEventListener('change', event => view.setColor(event.target.value));
  byId('size').addEventListener('input', event => {
    view.size = Number(event.target.value);
    view.redraw();
  });
  byId('frame').addEventListener('input', event => view.show(Number(event.target.value)));
  byId('play').addEventListener('click', () => view.play(!view.playing));
  byId('back').addEventListener('click', () => view.show(view.frame - 1));
  byId('next').addEventListener('click', () => view.show(view.frame + 1));
  for (const id of ['left', 'right'])
    byId(id).addEventListener(
        'change', () => view.setLabellings(Number(byId('left').value), Number(byId('right').value)));
  byId('fold').addEventListener('click', () => {
    const folded = byId('panel').classList.toggle('folded');
    byId('fold').setAttribute('aria-expanded', !folded);
    byId('fold').textContent = folded ? '▴' : '▾';
  });
}

function say(text) {
  byId('message').textContent = text;
  byId('message').hidden = !text;
}

async function load() {
  const title = byId('title') ? JSON.parse(byId('title').textContent) : 'Lisco';
  document.title = title;
  const view = new View();
  connect(view);
  say('Loading…');
  for (const script of document.querySelectorAll('script.scan')) {
    view.add(new Scan(await inflate(bytesOfBase64(script.textContent))));
    script.remove();
    say('');
  }
  if (byId('live')) {
    view.live = new Live(view, JSON.parse(byId('live').textContent));
    say('Waiting for columns…');
    return view;
  }
  if (view.scans.some(scan => scan.labellings.length > 1)) view.setLabellings(0, 1);
  if (!view.scans.length) say('This page holds no scan.');
  return view;
}

// For scripts and the browser's console: await lisco.ready, lisco.view.select(3, true), ...
const loading = load();
window.lisco = {ready: loading};
loading.then(view => window.lisco.view = view, error => say(error.message));
