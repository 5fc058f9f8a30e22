// What is written over the scene: the clusters' ids, and the measured line.

class Overlay {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d', {willReadFrequently: true});
  }

  clear(ratio) {
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  // Ids of clusters, the largest first, each where it covers no other.
  // places: [{text, x, y}], CSS pixels
  ids(places, color, halo) {
    const context = this.context;
    const taken = new Set();
    context.font = '600 12px system-ui, "DejaVu Sans", sans-serif';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.lineWidth = 3;
    context.strokeStyle = halo;
    context.fillStyle = color;
    for (const {text, x, y} of places) {
      const cell = `${Math.round(x / 30)},${Math.round(y / 16)}`;
      if (taken.has(cell)) continue;
      taken.add(cell);
      context.strokeText(text, x, y);
      context.fillText(text, x, y);
    }
  }

  // ends: [[x, y], ...], one or two points, CSS pixels
  measure(ends, text, color, halo) {
    const context = this.context;
    for (const [width, style] of [[5, halo], [2, color]]) {
      context.lineWidth = width;
      context.strokeStyle = style;
      context.beginPath();
      ends.forEach(([x, y], index) => index ? context.lineTo(x, y) : context.moveTo(x, y));
      context.stroke();
      for (const [x, y] of ends) {
        context.beginPath();
        context.arc(x, y, 5, 0, 2 * Math.PI);
        context.stroke();
      }
    }
    if (ends.length < 2) return;
    this.ids([{text, x: (ends[0][0] + ends[1][0]) / 2, y: (ends[0][1] + ends[1][1]) / 2 - 12}], color, halo);
  }

  title(text, x, color, halo) {
    this.context.font = '600 14px system-ui, "DejaVu Sans", sans-serif';
    this.context.textAlign = 'center';
    this.context.textBaseline = 'top';
    this.context.lineWidth = 3;
    this.context.strokeStyle = halo;
    this.context.fillStyle = color;
    this.context.strokeText(text, x, 14);
    this.context.fillText(text, x, 14);
  }

  line(x, height, color) {
    this.context.fillStyle = color;
    this.context.fillRect(x - 0.5, 0, 1, height);
  }
}
