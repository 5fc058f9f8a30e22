// Where two labellings of a scan differ.

// Pairs each cluster with the one of the other labelling that shares most of its points, the largest overlaps first. A
// point differs if its clusters are no such pair, or if it is in a cluster in one labelling only.
function differencesOf(left, right) {
  const overlaps = new Map();
  let size = 1;  // more than the largest class: clusters without points shown have none
  for (const b of right.classes) size = Math.max(size, b + 1);
  for (let i = 0; i < left.classes.length; ++i) {
    const [a, b] = [left.classes[i], right.classes[i]];
    if (a <= NOISE || b <= NOISE) continue;
    const pair = a * size + b;
    overlaps.set(pair, (overlaps.get(pair) || 0) + 1);
  }
  const partner_of_left = new Map();
  const partner_of_right = new Map();
  for (const [pair] of [...overlaps].sort(([p, m], [q, n]) => n - m || p - q)) {
    const [a, b] = [Math.floor(pair / size), pair % size];
    if (partner_of_left.has(a) || partner_of_right.has(b)) continue;
    partner_of_left.set(a, b);
    partner_of_right.set(b, a);
  }
  const differs = new Uint8Array(left.classes.length);
  let count = 0;
  for (let i = 0; i < differs.length; ++i) {
    const [a, b] = [left.classes[i], right.classes[i]];
    const is_same = a <= NOISE || b <= NOISE ? Math.max(a, NOISE) === Math.max(b, NOISE) : partner_of_left.get(a) === b;
    if (is_same) continue;
    differs[i] = 1;
    ++count;
  }
  return {differs, count, partner_of_left, partner_of_right};
}
