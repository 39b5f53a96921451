// The path as segments to draw: cuts as they are, rapids in dashes, so that not their colour alone tells them.

/** How many dashes go across the path, and how many there may be in all. */
const ACROSS = 100, MOST = 40000;

/**
 * The segments of the pieces that are drawn, in their order; the first piece of a row is always among them.
 * @param {Float32Array} tips ends of pieces: piece i goes from point i to the next
 * @param {ArrayLike<number>} rows row of each piece
 * @param {number} pieces
 * @param {(piece: number) => boolean} isDrawn
 * @param {(piece: number) => boolean} isRapid
 * @returns {{segments: Int32Array, points: Float32Array}} piece and both ends of each segment
 */
export function pathSegments(tips, rows, pieces, isDrawn, isRapid) {
  const dash = dashLength(tips, pieces, isDrawn, isRapid);
  /** @type {number[]} */
  const shares = []; // piece, from and to, as shares of it
  let along = 0;
  for (let i = 0; i < pieces; i++) {
    if (!isDrawn(i)) continue;
    const length = dash > 0 && isRapid(i) ? lengthOf(tips, i) : 0;
    if (length < 2 * dash || dash === 0) {
      const isFirst = i === 0 || rows[i] !== rows[i - 1] || !isDrawn(i - 1);
      if (length === 0 || isFirst || Math.floor(along / dash) % 2 === 0) shares.push(i, 0, 1);
      along = isFirst ? length : along + length;
      continue;
    }
    const many = 2 * Math.round(length / dash / 2) + 1; // odd: both ends are drawn
    for (let k = 0; k < many; k += 2) shares.push(i, k / many, (k + 1) / many);
    along = 0;
  }
  const count = shares.length / 3;
  const segments = new Int32Array(count), points = new Float32Array(6 * count);
  for (let n = 0; n < count; n++) {
    const piece = segments[n] = shares[3 * n];
    for (let k = 0; k < 6; k++) {
      const share = shares[3 * n + (k < 3 ? 1 : 2)], c = 3 * piece + (k % 3);
      points[6 * n + k] = share === 0 ? tips[c] : share === 1 ? tips[c + 3] : tips[c] + share * (tips[c + 3] - tips[c]);
    }
  }
  return { segments, points };
}

/**
 * How long a dash is, mm; 0 where there are no rapids.
 * @param {Float32Array} tips
 * @param {number} pieces
 * @param {(piece: number) => boolean} isDrawn
 * @param {(piece: number) => boolean} isRapid
 */
function dashLength(tips, pieces, isDrawn, isRapid) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  let rapids = 0;
  for (let i = 0; i < pieces; i++) {
    if (!isDrawn(i)) continue;
    for (let c = 0; c < 3; c++) {
      const value = tips[3 * i + 3 + c];
      if (value < low[c]) low[c] = value;
      if (value > high[c]) high[c] = value;
    }
    if (isRapid(i)) rapids += lengthOf(tips, i);
  }
  return rapids > 0 ? Math.max(Math.hypot(...low.map((value, c) => high[c] - value)) / ACROSS, rapids / 2 / MOST) : 0;
}

/**
 * @param {Float32Array} tips
 * @param {number} i
 */
function lengthOf(tips, i) {
  return Math.hypot(tips[3 * i + 3] - tips[3 * i], tips[3 * i + 4] - tips[3 * i + 1], tips[3 * i + 5] - tips[3 * i + 2]);
}
