// Colours that most kinds of colour blindness keep apart: Okabe and Ito's, extended; viridis for numbers.

const PALETTES = {
  dark: ['#e69e00', '#57b5e8', '#00b880', '#f0e342', '#337af2', '#e6541a', '#e673bf', '#9ee04d', '#a875ff', '#ffbfa6',
    '#4de6e6', '#eb2e61'],
  light: ['#b87400', '#1f86c0', '#00835c', '#8f8200', '#1c4fc4', '#c23f0b', '#b8458c', '#4f8a10', '#6f3fd0', '#a0563a',
    '#008a94', '#b01040'],
};
const PLAIN = {dark: {ground: '#4d4a44', noise: '#8a8a8a'}, light: {ground: '#c9c3b6', noise: '#7d7d7d'}};
const VIRIDIS = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];

function rgb(hex) {
  return [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16));
}

// 0xAABBGGRR, opaque: the order of bytes in a colour buffer.
function packed([red, green, blue]) {
  return (0xff000000 | blue << 16 | green << 8 | red) >>> 0;
}

// 256 colours from low to high. The darkest fifth is left out on a dark background, the brightest on a light one.
function scaleColors(theme) {
  return Array.from({length: 256}, (_, level) => {
    const part = theme === 'dark' ? 0.2 + 0.8 * level / 255 : 0.85 * level / 255;
    const at = part * (VIRIDIS.length - 1);
    const below = Math.min(Math.floor(at), VIRIDIS.length - 2);
    const [low, high] = [rgb(VIRIDIS[below]), rgb(VIRIDIS[below + 1])];
    return low.map((value, k) => Math.round(value + (high[k] - value) * (at - below)));
  });
}

// A colour's number per cluster: each cluster, the largest first, takes the colour whose nearest cluster so far is the
// farthest away. Clusters after the first thousand take turns.
// known: gives a cluster's number if it is settled
function clusterColors(clusters, colors, known = () => undefined) {
  const placed = [];
  return clusters.map((cluster, index) => {
    const settled = known(cluster);
    if (settled !== undefined) return settled;
    if (index >= 1000) return index % colors;
    const nearest = new Array(colors).fill(Infinity);
    const radius = Math.hypot(cluster.length, cluster.width) / 2;
    for (const other of placed) {
      const gap = Math.max(0, Math.hypot(other.x - cluster.center[0], other.y - cluster.center[1],
        other.z - cluster.center[2]) - radius - other.radius);
      nearest[other.color] = Math.min(nearest[other.color], gap);
    }
    const color = nearest.indexOf(Math.max(...nearest));
    placed.push({x: cluster.center[0], y: cluster.center[1], z: cluster.center[2], radius, color});
    return color;
  });
}

// The cluster of the last frame, if any, that each cluster was: by its id if the stream gives ids, otherwise the
// nearest one in a metre or half its length.
function partnersOf(clusters, known, has_ids) {
  const partners = new Map();
  const by_id = new Map(has_ids ? known.filter(({open}) => !open).map(other => [other.name, other]) : []);
  for (const cluster of clusters) {
    if (!cluster.open && by_id.has(cluster.name)) {
      partners.set(cluster, by_id.get(cluster.name));
      continue;
    }
    let best = Math.max(1, cluster.length / 2) ** 2;
    for (const other of known) {
      const square = (other.center[0] - cluster.center[0]) ** 2 + (other.center[1] - cluster.center[1]) ** 2;
      if (square >= best) continue;
      best = square;
      partners.set(cluster, other);
    }
  }
  return partners;
}

// Colours a labelling's clusters as those of the frame before, as far as they are the same. Returns their partners.
function colorAfter(labelling, before) {
  const {clusters} = labelling;
  const partners = partnersOf(clusters, before?.colors ? before.clusters : [], labelling.ids);
  labelling.colors ||= clusterColors(clusters, PALETTES.dark.length, cluster => partners.get(cluster)?.color);
  clusters.forEach((cluster, index) => cluster.color = labelling.colors[index]);
  return partners;
}

// The value of each point in a mode other than 'cluster', and the range that holds 96 % of them.
function valuesOf(scan, mode) {
  const values = new Float32Array(scan.points);
  for (let i = 0; i < scan.points; ++i) {
    if (mode === 'height') values[i] = scan.camera ? -scan.pointAt(i)[1] : scan.pointAt(i)[2];
    else if (mode === 'range') values[i] = scan.rangeAt(i);
    else values[i] = mode === 'ring' ? scan.rings[i] : scan.intensityAt(i);
  }
  const stride = Math.max(1, Math.floor(scan.points / 5000));
  const sample = Float32Array.from({length: Math.ceil(scan.points / stride)}, (_, k) => values[k * stride]).sort();
  const at = part => sample.length ? sample[Math.round(part * (sample.length - 1))] : 0;
  const [low, high] = mode === 'ring' ? [at(0), at(1)] : [at(0.02), at(0.98)];
  return {values, low, high: high > low ? high : low + 1};
}

// Colours of the points in one pane. Alpha 0 hides a point; below 255, a highlighted point is larger.
// look: {mode, theme, ground, noise, selected (cluster number or 0), differs (Uint8Array or null)}
function pointColors(scan, labelling, look) {
  const colors = new Uint32Array(scan.points);
  const classes = labelling.classes;
  const palette = PALETTES[look.theme].map(rgb);
  const plain = {ground: packed(rgb(PLAIN[look.theme].ground)), noise: packed(rgb(PLAIN[look.theme].noise))};
  const faded = value => look.theme === 'dark' ? value * 0.3 : 255 - (255 - value) * 0.3;
  const dimmed = color => color.map(value => Math.round(faded(value)));
  const of_class = [plain.ground, plain.noise];
  labelling.clusters.forEach((cluster, index) => {
    const color = palette[labelling.colors[index]];
    of_class[cluster.id + 1] = packed(look.selected && look.selected !== cluster.id ? dimmed(color) : color);
  });
  const scale = look.mode === 'cluster' ? null : scaleColors(look.theme);
  const bright = scale?.map(packed);
  const dim = scale?.map(color => packed(dimmed(color)));
  const measured = scale ? scan[`values_${look.mode}`] ||= valuesOf(scan, look.mode) : null;
  const picked = look.selected + 1;
  for (let i = 0; i < colors.length; ++i) {
    const c = classes[i];
    if ((c === GROUND && !look.ground) || (c === NOISE && !look.noise)) continue;
    let color = of_class[c];
    if (scale) {
      const part = (measured.values[i] - measured.low) / (measured.high - measured.low);
      color = (look.selected && c !== picked ? dim : bright)[Math.max(0, Math.min(255, Math.round(255 * part)))];
    }
    const is_marked = (look.selected && c === picked) || look.differs?.[i];
    colors[i] = is_marked ? (color & 0x00ffffff | 0x80000000) >>> 0 : color;
  }
  return colors;
}
