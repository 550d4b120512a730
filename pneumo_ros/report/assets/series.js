// Long series of a page: unpacked from differences, and thinned to the resolution of a screen.
"use strict";
const Series = (() => {
  async function inflate(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  // Undoes `series._deflated`: byte planes, folded signs, differences of first or second order; gives whole numbers.
  async function unpack(packed, count) {
    const bytes = await inflate(packed.data);
    const values = new Float64Array(count);
    let value = 0;
    let slope = 0;
    for (let i = 0; i < count; i++) {
      const folded =
        bytes[i] + 256 * bytes[count + i] + 65536 * bytes[2 * count + i] + 16777216 * bytes[3 * count + i];
      const difference = folded % 2 ? -(folded + 1) / 2 : folded / 2;
      slope = packed.order === 2 ? slope + difference : difference;
      value += slope;
      values[i] = value;
    }
    return values;
  }

  async function decode(series) {
    const y = (await unpack(series.y, series.count)).map((v) => v * series.scale);
    const at = series.x ? await unpack(series.x, series.count) : y.map((_, i) => i);
    for (const [from, to] of series.gaps) y.fill(NaN, from, to);
    return { x: at.map((v) => series.start + v * series.step), y };
  }

  // First index of a sorted array whose value is at least `value`.
  function place(x, value) {
    let low = 0;
    let high = x.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (x[middle] < value) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // At most two points for each of `room` buckets within the range: the smallest and the largest, in their order.
  function thin(curve, range, room) {
    const from = range ? Math.max(place(curve.x, range[0]) - 1, 0) : 0;
    const to = range ? Math.min(place(curve.x, range[1]) + 1, curve.x.length) : curve.x.length;
    const size = Math.ceil((to - from) / room);
    const x = [];
    const y = [];
    const keep = (i) => {
      x.push(curve.x[i]);
      y.push(Number.isNaN(curve.y[i]) ? null : curve.y[i]);
    };
    if (size <= 2) {
      for (let i = from; i < to; i++) keep(i);
      return { x, y };
    }
    for (let begin = from; begin < to; begin += size) {
      let low = -1;
      let high = -1;
      const end = Math.min(begin + size, to);
      for (let i = begin; i < end; i++) {
        if (Number.isNaN(curve.y[i])) continue;
        if (low < 0 || curve.y[i] < curve.y[low]) low = i;
        if (high < 0 || curve.y[i] > curve.y[high]) high = i;
      }
      if (low < 0) keep(begin);
      else if (low === high) keep(low);
      else [Math.min(low, high), Math.max(low, high)].forEach(keep);
    }
    return { x, y };
  }

  return { decode, thin };
})();
