// The panel: counts, the list of clusters, what is selected.

const byId = id => document.getElementById(id);
const metres = value => `${value.toFixed(2)} m`;
const ROWS = 200;  // added to the list at a time

function element(name, properties, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

class ClusterList {
  constructor(view) {
    this.view = view;
    this.key = 'id';
    this.descends = false;
    for (const button of document.querySelectorAll('[data-sort]')) {
      button.addEventListener('click', () => {
        const same = button.dataset.sort === this.key;
        this.descends = same ? !this.descends : button.dataset.sort !== 'id';
        this.key = button.dataset.sort;
        this.fill();
      });
    }
    const list = byId('list');
    list.addEventListener('scroll', () => {
      if (list.scrollTop + list.clientHeight > list.scrollHeight - 300) this.addRows();
    });
    const rows = byId('rows');
    const idOf = event => Number(event.target.closest('tr')?.dataset.id);
    rows.addEventListener('click', event => view.select(idOf(event), true));
    rows.addEventListener('keydown', event => {
      const row = event.target.closest('tr');
      const next = {ArrowDown: row.nextSibling, ArrowUp: row.previousSibling}[event.key];
      if (next) {
        row.tabIndex = -1;
        next.tabIndex = 0;
        next.focus();
      } else if (event.key === 'Enter') {
        view.select(idOf(event), true);
      } else {
        return;
      }
      event.preventDefault();
    });
  }

  // All clusters of another scan, from the top.
  fill() {
    this.sort();
    byId('rows').replaceChildren();
    byId('list').scrollTop = 0;
    this.addRows();
  }

  // The clusters of a stream's next frame in the rows that are there: a click or the focus stays on its row.
  update() {
    this.sort();
    const rows = [...byId('rows').children];
    rows.forEach((row, index) => index < this.sorted.length ? this.write(row, this.sorted[index]) : row.remove());
    if (rows.length < ROWS) this.addRows();
  }

  sort() {
    const sign = this.descends ? -1 : 1;
    const listed = this.view.labelling.clusters.filter(({open}) => !open);
    this.sorted = listed.sort((a, b) => sign * (a[this.key] - b[this.key]) || a.id - b.id);
    for (const button of document.querySelectorAll('[data-sort]')) {
      const direction = this.descends ? 'descending' : 'ascending';
      button.parentNode.setAttribute('aria-sort', button.dataset.sort === this.key ? direction : 'none');
    }
  }

  addRows() {
    const rows = byId('rows');
    for (const cluster of this.sorted.slice(rows.children.length, rows.children.length + ROWS)) {
      const row = element('tr', {tabIndex: rows.children.length ? -1 : 0},
        element('td', {}, element('span', {className: 'swatch'}), ''),
        ...[0, 1, 2, 3].map(() => element('td', {}, '')));
      this.write(row, cluster);
      rows.append(row);
    }
  }

  write(row, cluster) {
    const {colors, clusters} = this.view.labelling;
    const [first, ...others] = row.children;
    first.firstChild.style.background = PALETTES[this.view.look.theme][colors[clusters.indexOf(cluster)]];
    first.lastChild.data = String(cluster.name);
    [cluster.size, ...['range', 'length', 'height'].map(key => cluster[key].toFixed(2))]
      .forEach((text, column) => others[column].firstChild.data = text);
    row.dataset.id = cluster.id;
    row.setAttribute('aria-selected', cluster.id === this.view.selected);
  }

  mark(selected) {
    for (const row of byId('rows').children) {
      const is_selected = Number(row.dataset.id) === selected;
      row.setAttribute('aria-selected', is_selected);
      if (is_selected) row.scrollIntoView({block: 'nearest'});
    }
  }
}

function showDefinitions(place, title, pairs) {
  place.replaceChildren(
    element('h2', {textContent: title}),
    element('dl', {}, ...pairs.flatMap(([term, text]) =>
      [element('dt', {textContent: term}), element('dd', {textContent: text})])));
  place.hidden = false;
}

// What is known of a cluster and of the point that was clicked, if any.
function showSelection(scan, labelling, selected, point) {
  const pairs = [];
  let title = point < 0 ? '' : labelling.classes[point] === GROUND ? 'Ground' : 'Noise: in no cluster';
  const cluster = clusterOf(labelling, selected);
  if (cluster) {
    title = `Cluster ${cluster.name}`;
    const turned = cluster.yaw ? `, turned by ${(cluster.yaw * 180 / Math.PI).toFixed(0)}°` : '';
    pairs.push(['Points', String(cluster.size)], ['Range', `${metres(cluster.range)} (nearest point)`],
      ['Box', `${[cluster.length, cluster.width, cluster.height].map(v => v.toFixed(2)).join(' × ')} m${turned}`],
      ['Centre', `${cluster.center.map(v => v.toFixed(2)).join(', ')} m`]);
  }
  if (point >= 0) {
    pairs.push(['Point', `${scan.pointAt(point).map(v => v.toFixed(3)).join(', ')} m`],
      ['its range', metres(scan.rangeAt(point))]);
    if (scan.intensity) pairs.push(['its intensity', Number(scan.intensityAt(point).toPrecision(3)).toString()]);
    if (scan.ring) pairs.push(['its ring', String(scan.rings[point])]);
  }
  if (title) showDefinitions(byId('info'), title, pairs);
  else byId('info').hidden = true;
}

// The distance between two points, and on which side of the tolerance it is: each position is rounded by at most
// scan.error, so that a distance near the tolerance may be on either.
function verdictOf(scan, tolerance, [a, b]) {
  const [p, q] = [scan.pointAt(a), scan.pointAt(b)];
  const distance = Math.hypot(...p.map((value, axis) => value - q[axis]));
  const text = `${distance.toFixed(3)} m`;
  if (!tolerance) return {distance, text, verdict: ''};
  const doubt = 2 * scan.error;
  let verdict = `below the tolerance of ${tolerance} m: neighbours`;
  if (distance > tolerance - doubt) verdict = `not below the tolerance of ${tolerance} m: no neighbours`;
  if (Math.abs(distance - tolerance) <= doubt)
    verdict = `within ${(1000 * doubt).toFixed(1)} mm of the tolerance of ${tolerance} m: too close to tell here`;
  return {distance, text, verdict};
}

function showMeasure(scan, labelling, ends) {
  if (ends.length < 2) {
    showDefinitions(byId('info'), 'Measure', [['Click', ends.length ? 'the second point' : 'two points']]);
    return;
  }
  const {text, verdict} = verdictOf(scan, labelling.tolerance, ends);
  showDefinitions(byId('info'), text, verdict ? [['It is', verdict]] : []);
}

function showCounts(scan, labelling) {
  const clustered = scan.points - labelling.ground - labelling.noise;
  const count = labelling.clusters.length;
  const parts = [`${count} ${count === 1 ? 'cluster' : 'clusters'} of ${clustered} points`, `${labelling.noise} noise`];
  if (labelling.ground) parts.push(`${labelling.ground} ground`);
  if (labelling.tolerance) parts.push(`tolerance ${labelling.tolerance} m`);
  byId('counts').textContent = parts.join(' · ');
  const far = scan.too_far ? `; ${scan.too_far} points beyond 16 km are not shown` : '';
  byId('error').textContent = `Positions within ${(1000 * scan.error).toFixed(1)} mm${far}`;
}
