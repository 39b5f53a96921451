/* The plots of a report: unpacks the columns of the page, draws them with uPlot, and follows the mouse.
 *
 * A table is {time, <column>: array ...}, one entry a point. There may be three sorts of it: the coarse one, which is
 * unpacked first so that something is seen; the full one; and levels between, which are rows of the full one.
 * Whatever stretch is looked at, `tableFor` picks the table that shows it with few enough points.
 */
"use strict";
// Plots of the program, and of a recording: the ids of their elements begin with `own`.
for (const own of ["", "recorded-"]) (() => {
  const holder = document.getElementById(`${own}report`);
  if (!holder) return;
  const report = JSON.parse(holder.textContent);
  const byId = (id) => document.getElementById(own + id);
  const NAMES = ["seconds", ...report.values, ...report.lines];
  const WHOLE = [0, report.total || 1];
  const HEIGHT = 118, AXIS = 26;

  let coarse = null, full = null; // tables
  let levels = []; // {buckets, table}, from coarse to fine
  let table = null; // the table in view
  let view = WHOLE; // time from, to
  let fit = false; // heights follow the motion, not the limits
  let held = null; // a point that was clicked: {table, at}
  let colours = {};
  const plots = []; // {u, spec, outputs}

  // ------------------------------------------------------------------------------------------------------------------
  // Columns

  async function unpackTable(group) {
    const made = {};
    for (const name of NAMES) {
      const words = await unpack(`${own}${group}-${name}`);
      made[name] = report.lines.includes(name) ? words : new Float32Array(words.buffer);
    }
    made.time = new Float64Array(made.seconds.length);
    for (let i = 0, time = 0; i < made.time.length; i++) made.time[i] = time += made.seconds[i];
    return made;
  }

  function rowsOf(whole, rows) {
    const made = {};
    for (const [name, column] of Object.entries(whole)) {
      const chosen = new column.constructor(rows.length);
      for (let i = 0; i < rows.length; i++) chosen[i] = column[rows[i]];
      made[name] = chosen;
    }
    return made;
  }

  /* The first index whose time is not before t; the length if there is none. */
  function firstAt(time, t) {
    let low = 0, high = time.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (time[middle] < t) low = middle + 1; else high = middle;
    }
    return low;
  }

  function tableFor(from, to) {
    if (full && firstAt(full.time, to) - firstAt(full.time, from) <= report.direct) return full;
    const share = (to - from) / WHOLE[1];
    const enough = levels.find((level) => level.buckets * share >= report.inView);
    return (enough || levels[levels.length - 1] || { table: full }).table;
  }

  // ------------------------------------------------------------------------------------------------------------------
  // Texts

  /* What uPlot leaves open: null where a value is not known. */
  const withGaps = (column) => (column.some(Number.isNaN) ? Array.from(column, (value) => (Number.isNaN(value) ? null : value)) : column);

  const number = (value, unit) => {
    if (Number.isNaN(value)) return "not known:";
    const decimals = unit.endsWith("/min") ? (Math.abs(value) < 100 ? 1 : 0) : 3;
    return value.toFixed(decimals).replace(/^-(?=0(\.0*)?$)/, "").replace("-", "\u2212");
  };

  function clock(seconds, decimals) {
    if (!report.timed) return String(Math.round(seconds));
    const tick = 10 ** decimals;
    const ticks = Math.round(seconds * tick);
    const rest = ((ticks / tick) % 60).toFixed(decimals).padStart(decimals ? decimals + 3 : 2, "0");
    const minutes = Math.floor(ticks / tick / 60);
    const tail = `${String(minutes % 60).padStart(2, "0")}:${rest}`;
    return minutes < 60 ? tail.replace(/^0/, "") : `${Math.floor(minutes / 60)}:${tail}`;
  }

  function element(kind, className, text) {
    const made = document.createElement(kind);
    if (className) made.className = className;
    if (text !== undefined) made.textContent = text;
    return made;
  }

  /* Values of a point in the legends and in the bar; none without one. */
  function tell(point) {
    const shown = point || held;
    for (const { spec, outputs } of plots) {
      spec.lines.forEach((line, k) => {
        outputs[k].textContent = shown ? `${number(shown.table[line.column][shown.at], spec.unit)} ${spec.unit}` : "";
      });
    }
    const place = byId("point");
    place.replaceChildren();
    if (!shown) {
      place.append(element("span", "hint", report.words.point_at));
      return;
    }
    const { table: t, at } = shown;
    const say = (name, value) => {
      const item = element("span", "", `${name} `);
      item.append(element("b", "", value));
      place.append(item);
    };
    if (!point) place.append(element("span", "held", report.words.held));
    say(report.timed ? report.words.time : report.words.motion, clock(t.time[at], 3));
    if (at === 0 && report.first) return void place.append(element("span", "hint", report.first));
    if (t.number[at] >= 0) say(report.words.block, `N${t.number[at]}`);
    if (t.block[at] > 0) say(report.words.nc_line, String(t.block[at]));
    if (t.file && t.file[at]) say(report.words.in_file, report.files[t.file[at]]);
    if (t.cl[at] > 0) say(report.words.cl_line, String(t.cl[at]));
  }

  // ------------------------------------------------------------------------------------------------------------------
  // Plots

  function readColours() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["paper", "ink", "soft", "grid", "rule", "limit", "hold", "mark", "line-1", "line-2"]) {
      colours[name] = style.getPropertyValue(`--${name}`).trim();
    }
  }

  /* Lowest and highest value of the vertical scale: what is seen, and the limits unless heights follow the motion. */
  function heights(spec, low, high) {
    const values = low == null ? [] : [low, high];
    if (!fit) for (const line of spec.lines) values.push(...line.limits);
    if (spec.step) values.push(0);
    if (!values.length) return [0, 1];
    const least = Math.min(...values), most = Math.max(...values);
    const pad = (most - least) * 0.07 || Math.abs(most) * 0.1 || 1;
    return [spec.step ? 0 : least - pad, most + pad];
  }

  function drawn(u, spec) {
    const { ctx, bbox } = u;
    const ratio = devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.font = `${11 * ratio}px system-ui, sans-serif`;
    const upright = (time, colour, dash) => {
      const x = Math.round(u.valToPos(time, "x", true)) + 0.5;
      ctx.strokeStyle = colour;
      ctx.lineWidth = ratio;
      ctx.setLineDash(dash.map((part) => part * ratio));
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      return x;
    };
    spec.lines.forEach((line) => {
      for (const limit of line.limits) {
        const y = Math.round(u.valToPos(limit, "y", true)) + 0.5;
        ctx.strokeStyle = ctx.fillStyle = colours.limit;
        ctx.lineWidth = ratio;
        ctx.setLineDash((line.loose ? [2, 4] : [6, 4]).map((part) => part * ratio));
        ctx.beginPath();
        ctx.moveTo(bbox.left, y);
        ctx.lineTo(bbox.left + bbox.width, y);
        ctx.stroke();
        if (spec.lines.length > 1) {
          const right = bbox.left + bbox.width - 4 * ratio, wide = ctx.measureText(line.limitName).width;
          ctx.fillStyle = colours.paper;
          ctx.fillRect(right - wide - 3 * ratio, y + 2 * ratio, wide + 6 * ratio, 14 * ratio);
          ctx.fillStyle = colours.limit;
          ctx.textAlign = "right";
          ctx.fillText(line.limitName, right, y + 12 * ratio);
        }
      }
    });
    const ends = [];
    for (const [time, tool] of report.marks) {
      if (time < view[0] || time > view[1]) continue;
      const x = upright(time, colours.mark, [2, 3]);
      ctx.textAlign = x > bbox.left + bbox.width - (report.markWord ? 40 : 130) * ratio ? "right" : "left";
      if (u !== plots[0].u) continue;
      // One above the other where they would overlap.
      const text = `${report.markWord}${tool}`, wide = ctx.measureText(text).width + 6 * ratio;
      const left = ctx.textAlign === "left" ? x : x - wide;
      const free = ends.findIndex((end) => end <= left), line = free < 0 ? ends.length : free;
      ends[line] = left + wide;
      const y = bbox.top + bbox.height - (5 + 12 * line) * ratio;
      ctx.fillStyle = colours.paper;
      ctx.fillRect(left + 2 * ratio, y - 9 * ratio, wide - 4 * ratio, 11 * ratio);
      ctx.fillStyle = colours.soft;
      ctx.fillText(text, x + (ctx.textAlign === "left" ? 3 : -3) * ratio, y);
    }
    if (held) upright(held.table.time[held.at], colours.hold, []);
    ctx.restore();
  }

  function options(spec, last, width) {
    const stroke = (k) => () => colours[`line-${k + 1}`];
    const paths = spec.step ? uPlot.paths.stepped({ align: -1 }) : uPlot.paths.linear();
    const font = "11px system-ui, sans-serif";
    const axis = { stroke: () => colours.soft, font, ticks: { show: false }, grid: { stroke: () => colours.grid, width: 1 } };
    return {
      width,
      height: HEIGHT + (last ? AXIS : 0),
      padding: [8, 26, last ? 0 : 8, 0],
      legend: { show: false },
      scales: { x: { time: false, auto: false }, y: { range: (u, low, high) => heights(spec, low, high) } },
      axes: [
        {
          ...axis,
          size: last ? AXIS : 0,
          space: 80,
          incrs: [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800]
            .concat([3600, 7200, 14400, 36000, 72000, 144000, 360000, 1e6, 1e7, 1e8]),
          values: (u, splits, k, space, step) =>
            splits.map((value) => (last ? clock(value, step >= 1 ? 0 : Math.ceil(-Math.log10(step) - 1e-9)) : "")),
        },
        { ...axis, size: 62, space: 26, values: (u, splits) => splits.map((value) => String(+value.toFixed(6)).replace("-", "\u2212")) },
      ],
      series: [
        {},
        ...spec.lines.map((line, k) => ({
          label: line.name,
          stroke: stroke(k),
          width: 1.25,
          dash: line.column === "programmed" ? [5, 4] : undefined,
          paths,
          spanGaps: true,
          points: { size: 4, space: 14, fill: stroke(k) },
        })),
      ],
      cursor: {
        y: false,
        points: { size: 7 },
        // The block that runs at a moment is the one that ends next.
        dataIdx: (u, k, nearest, time) => Math.min(firstAt(u.data[0], time), u.data[0].length - 1),
        drag: { x: true, y: false, setScale: false },
        sync: { key: `${own}report`, filters: { pub: (type) => type !== "mousedown" && type !== "mouseup" && type !== "dblclick" } },
        bind: { dblclick: () => () => { show(...WHOLE); return null; } },
      },
      hooks: {
        draw: [(u) => drawn(u, spec)],
        setCursor: [(u) => { if (u.over.matches(":hover") && under(u)) tell(under(u)); }],
        setSelect: [(u) => {
          const { left, width: wide } = u.select;
          if (wide >= 4) show(u.posToVal(left, "x"), u.posToVal(left + wide, "x"));
        }],
      },
    };
  }

  function legend(spec, box) {
    box.append(element("h3", "", `${spec.title} (${spec.unit})`));
    return spec.lines.map((line, k) => {
      const row = element("p", `line-${k + 1}`);
      const output = element("output");
      row.append(element("span", "swatch"), element("span", "", line.name), output);
      box.append(row);
      return output;
    });
  }

  function build() {
    readColours();
    const strips = byId("strips");
    report.plots.forEach((spec, k) => {
      const box = element("div", "strip"), side = element("div", "legend"), canvas = element("div", "canvas");
      box.append(side, canvas);
      strips.append(box);
      const outputs = legend(spec, side);
      for (const line of spec.lines) {
        const values = line.limits.map((value) => String(+value.toFixed(3)).replace("-", "\u2212")).join(" \u2026 ");
        const text = line.loose ? `${report.words.travel} ${+(line.limits[1] - line.limits[0]).toFixed(3)}` : `${line.limitName} ${values}`;
        if (values) side.append(element("p", "limits", text));
      }
      if (spec.note) side.append(element("p", "hint", spec.note));
      const empty = [new Float64Array(0), ...spec.lines.map(() => new Float32Array(0))];
      const u = new uPlot(options(spec, k === report.plots.length - 1, canvas.clientWidth), empty, canvas);
      plots.push({ u, spec, outputs });
      follow(u);
    });
  }

  /* The point under the cursor of a plot, if it has one. */
  function under(u) {
    const at = u.cursor.idxs && u.cursor.idxs[1];
    return u.stretch && u.cursor.left >= 0 && at != null ? { table: u.stretch.table, at: u.stretch.from + at } : null;
  }

  function follow(u) {
    let pressed = -1;
    u.over.addEventListener("mousedown", (event) => { pressed = event.clientX; });
    u.over.addEventListener("click", (event) => {
      const point = under(u);
      if (Math.abs(event.clientX - pressed) < 4 && point) hold(point);
    });
    u.over.addEventListener("mouseleave", () => tell(null));
  }

  function hold(point) {
    held = point;
    tell(null);
    for (const { u } of plots) u.redraw(false, false);
  }

  /* Show a stretch of time in all plots. */
  function show(from, to) {
    const least = Math.max(WHOLE[1] * 1e-9, 1e-3);
    const width = Math.min(Math.max(to - from, least), WHOLE[1]);
    const begin = Math.min(Math.max((from + to - width) / 2, 0), WHOLE[1] - width);
    view = [begin, begin + width];
    table = tableFor(...view);
    if (!table) return;
    const first = Math.max(firstAt(table.time, view[0]) - 1, 0);
    const end = Math.min(firstAt(table.time, view[1]) + 2, table.time.length);
    for (const { u, spec } of plots) {
      u.stretch = { table, from: first };
      u.batch(() => {
        u.setData([table.time, ...spec.lines.map((line) => table[line.column])].map((c) => withGaps(c.subarray(first, end))), false);
        u.setScale("x", { min: view[0], max: view[1] });
        u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
      });
    }
  }

  /* Show the point of an NC line of a file, the one of this CL line if there are several; without a file: of the program itself. */
  function goTo(line, cl, file) {
    if (!full) return;
    const number = file ? report.files.indexOf(file) : 0;
    let at = -1;
    for (let i = 1; i < full.block.length; i++) {
      if (full.block[i] !== line || (full.file ? full.file[i] : 0) !== number) continue;
      if (at < 0 || full.cl[i] === cl) at = i;
      if (full.cl[i] === cl) break;
    }
    byId("plots").scrollIntoView();
    if (at < 0) return void (byId("status").textContent = report.words.moves_nothing.replace("#", line));
    const near = [full.time[Math.max(at - 25, 0)], full.time[Math.min(at + 25, full.time.length - 1)]];
    show(...near);
    hold({ table: full, at });
  }

  function act(what) {
    const width = view[1] - view[0], middle = held ? held.table.time[held.at] : (view[0] + view[1]) / 2;
    const centre = middle >= view[0] && middle <= view[1] ? middle : (view[0] + view[1]) / 2;
    if (what === "whole") show(...WHOLE);
    if (what === "in") show(centre - width / 4, centre + width / 4);
    if (what === "out") show(view[0] - width / 2, view[1] + width / 2);
    if (what === "left") show(view[0] - width / 2, view[1] - width / 2);
    if (what === "right") show(view[0] + width / 2, view[1] + width / 2);
  }

  function listen() {
    document.addEventListener("click", (event) => {
      const { act: what, line, cl, file } = event.target.dataset || {};
      if (what && byId("plots").contains(event.target)) act(what);
      if (line && !own) goTo(Number(line), Number(cl), file);
    });
    document.addEventListener("keydown", (event) => { if (event.key === "Escape") hold(null); });
    byId("fit").addEventListener("change", (event) => { fit = event.target.checked; show(...view); });
    new ResizeObserver(() => {
      for (const { u } of plots) u.setSize({ width: u.root.parentNode.clientWidth, height: u.height });
    }).observe(byId("strips"));
    const recolour = () => { readColours(); for (const { u } of plots) u.redraw(false, true); };
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour);
    addEventListener("beforeprint", () => { document.documentElement.dataset.print = ""; recolour(); });
    addEventListener("afterprint", () => { delete document.documentElement.dataset.print; recolour(); });
  }

  // ------------------------------------------------------------------------------------------------------------------
  // What comes first

  const parsed = new Promise((done) => {
    if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", done);
    else done();
  });

  async function start() {
    build();
    listen();
    if (report.levels.length) {
      coarse = await unpackTable("coarse");
      levels = [{ buckets: report.levels[0], table: coarse }];
      show(...WHOLE);
      performance.mark(`${own}coarse plots`);
    }
    await parsed;
    full = await unpackTable("full");
    for (const buckets of report.levels.slice(1)) {
      levels.push({ buckets, table: rowsOf(full, await unpack(`${own}level-${buckets}`)) });
    }
    show(...view);
    performance.mark(`${own}full plots`);
    tell(null);
  }

  start().catch((error) => {
    const old = typeof DecompressionStream === "undefined";
    byId("point").replaceChildren();
    byId("status").textContent = old
      ? report.words.old_browser
      : `${report.words.not_drawn} ${error}`;
  });
})();
