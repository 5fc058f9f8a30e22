// The inverse of apps/view/scan_encoder.cpp.

const GROUND = 0;
const NOISE = 1;  // cluster k, from 1, has class k + 1

async function inflate(compressed) {
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function bytesOfBase64(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

// Numbers stored as differences, seven bits a byte.
class DifferenceReader {
  constructor(bytes, at) {
    this.bytes = bytes;
    this.at = at;
  }

  fill(array, start = 0, stride = 1) {
    const bytes = this.bytes;
    let at = this.at;
    let value = 0;
    for (let i = start; i < array.length; i += stride) {
      let byte = bytes[at++];
      let code = byte & 127;
      for (let shift = 7; byte & 128; shift += 7) {
        byte = bytes[at++];
        code |= (byte & 127) << shift;
      }
      value += (code >>> 1) ^ -(code & 1);
      array[i] = value;
    }
    this.at = at;
    return array;
  }
}

// Clusters 1, 2, ... of a labelling: those of the header, and the rest measured on the points shown. Numbers may be
// missing: those have no points. A cluster's name is what is shown: its number, or the stream's id.
function clustersOf(scan, listed, classes, ids) {
  const clusters = listed.map(([size, x, y, z, length, width, height, yaw, range], index) => {
    const id = index + 1;
    return {id, name: ids?.[index] ?? id, size, center: [x, y, z], length, width, height, yaw, range};
  }).filter(cluster => cluster.size > 0);
  const measured = [];
  for (let i = 0; i < classes.length; ++i) {
    const id = classes[i] - 1;
    if (id <= listed.length) continue;
    const box = measured[id - listed.length - 1] ||=
      {id, size: 0, min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity], range: Infinity};
    ++box.size;
    const point = scan.pointAt(i);
    for (let axis = 0; axis < 3; ++axis) {
      box.min[axis] = Math.min(box.min[axis], point[axis]);
      box.max[axis] = Math.max(box.max[axis], point[axis]);
    }
    box.range = Math.min(box.range, Math.hypot(...point));
  }
  for (const {id, size, min, max, range} of measured.filter(Boolean)) {
    const center = min.map((low, axis) => (low + max[axis]) / 2);
    const [x, y, height] = max.map((high, axis) => high - min[axis]);
    clusters.push({id, name: id, size, range, center, height, length: Math.max(x, y), width: Math.min(x, y),
      yaw: y > x ? Math.PI / 2 : 0});
  }
  return clusters;
}

function clusterOf(labelling, id) {
  return labelling.clusters.find(cluster => cluster.id === id);
}

class Scan {
  constructor(bytes) {
    const header_size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
    Object.assign(this, JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + header_size))));
    const reader = new DifferenceReader(bytes, 4 + header_size);
    this.positions = new Float32Array(3 * this.points);  // whole steps from the origin
    for (let axis = 0; axis < 3; ++axis) reader.fill(this.positions, axis, 3);
    const listed = this.labellings;
    this.labellings = listed.map(labelling => {
      const classes = reader.fill(new Uint32Array(this.points));
      let ground = 0, noise = 0;
      for (const c of classes) {
        if (c === GROUND) ++ground;
        else if (c === NOISE) ++noise;
      }
      return {...labelling, listed: labelling.clusters.length, classes, ground, noise};
    });
    if (this.intensity) {
      this.levels = bytes.subarray(reader.at, reader.at + this.points);
      reader.at += this.points;
    }
    if (this.ring) this.rings = reader.fill(new Uint16Array(this.points));
    for (const labelling of this.labellings)
      labelling.clusters = clustersOf(this, labelling.clusters, labelling.classes, labelling.ids);
  }

  // Metres, in the scan's own coordinates.
  pointAt(i) {
    return [0, 1, 2].map(axis => this.origin[axis] + this.step * this.positions[3 * i + axis]);
  }
  rangeAt(i) {
    return Math.hypot(...this.pointAt(i));
  }
  intensityAt(i) {
    const [low, high] = this.intensity;
    return low + (high - low) * this.levels[i] / 255;
  }
}
