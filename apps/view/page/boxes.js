// Edges of clusters' boxes.

const EDGES = [[0, 1], [1, 3], [3, 2], [2, 0], [4, 5], [5, 7], [7, 6], [6, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

// The corners of a box in the scan's coordinates, metres.
function cornersOf({center, length, width, height, yaw}) {
  const [sine, cosine] = [Math.sin(yaw), Math.cos(yaw)];
  const corners = [];
  for (const z of [-height / 2, height / 2]) {
    for (const y of [-width / 2, width / 2]) {
      for (const x of [-length / 2, length / 2])
        corners.push([center[0] + cosine * x - sine * y, center[1] + sine * x + cosine * y, center[2] + z]);
    }
  }
  return corners;
}

// Lines for Renderer.setLines: the boxes of all clusters, the selected one's in a colour of its own.
function boxLines(scan, labelling, {shown, selected, theme}) {
  const positions = [];
  const colors = [];
  const mark = packed(rgb(theme === 'dark' ? '#ffffff' : '#000000'));
  const palette = PALETTES[theme].map(rgb);
  labelling.clusters.forEach((cluster, index) => {
    const is_selected = cluster.id === selected;
    if (cluster.swept) return;
    if (!shown && !is_selected) return;
    const color = is_selected ? mark : packed(palette[labelling.colors[index]]);
    const corners = cornersOf(cluster);
    for (const edge of EDGES) {
      for (const end of edge) {
        positions.push(...corners[end].map((value, axis) => (value - scan.origin[axis]) / scan.step));
        colors.push(color);
      }
    }
  });
  return [positions, colors];
}
