// Draws each figure of the page from the JSON beside it. Nothing here touches the network.
(() => {
  "use strict";

  const root = document.documentElement;
  const PRINTED_WIDTH = 670; // A4 less its margins, in CSS pixels
  const drawn = [];

  // Colours are the style sheet's, so that the canvas follows light, dark and paper.
  let colours = {};
  function readColours() {
    const style = getComputedStyle(root);
    const value = (name) => style.getPropertyValue(name).trim();
    colours = {
      paper: value("--paper"), ink: value("--ink"), muted: value("--muted"), grid: value("--faint"), rule: value("--rule"),
      band: value("--band"), edge: value("--band-edge"), reference: value("--reference"),
      curves: Array.from({ length: 8 }, (_, i) => value(`--c${i}`)),
      font: `12px ${value("--text")}`,
    };
  }

  function element(name, attributes, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  const signed = (text) => text.replaceAll("-", "\u2212");

  // The decimals that write every multiple of `step` in full.
  function decimalsOf(step) {
    let decimals = Math.max(0, -Math.floor(Math.log10(step)));
    while (decimals < 15 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) decimals += 1;
    return decimals;
  }

  // One form for a whole axis or legend: plain where it is short, else with a power of ten.
  function formatter(largest, step) {
    if (!(largest > 0) || !(step > 0)) return (value) => signed(String(value));
    if (largest >= 1e-3 && largest < 1e6) {
      const decimals = decimalsOf(step);
      return (value) => signed(value.toFixed(decimals));
    }
    const power = Math.floor(Math.log10(largest) + 1e-9);
    const decimals = Math.min(15, decimalsOf(step / 10 ** power));
    return (value) => (value === 0 ? "0" : signed(`${(value / 10 ** power).toFixed(decimals)}e${power}`));
  }

  function linearTicks(u, splits, axis, space, step) {
    const largest = Math.max(...splits.map((value) => Math.abs(value ?? 0)));
    const format = formatter(largest, step);
    return splits.map((value) => (value == null ? "" : format(value)));
  }

  function logTicks(u, splits) {
    return splits.map((value) => {
      if (value == null) return "";
      const plain = value >= 1e-3 && value < 1e5;
      return signed(plain ? String(Number(value.toPrecision(6))) : value.toExponential().replace("e+", "e"));
    });
  }

  // Marks of a logarithmic axis: the digits of each decade, or within one decade equal steps.
  function logSplits(u, axis, low, high) {
    const splits = [];
    if (high / low < 10) {
      const rough = (high - low) / 4;
      const power = 10 ** Math.floor(Math.log10(rough));
      const step = [5, 2, 1].find((factor) => factor * power <= rough) * power;
      for (let i = Math.ceil(low / step); i * step <= high; i++) splits.push(Number((i * step).toPrecision(12)));
      return splits;
    }
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++) {
      for (let digit = 1; digit < 10; digit++) splits.push(Number(`${digit}e${power}`));
    }
    return splits.filter((value) => value >= low && value <= high);
  }

  // Which of them are named: as many as there is room for.
  function logNames(u, splits, axis, space) {
    const { min, max } = u.scales[u.axes[axis].scale];
    if (max / min < 10) return splits;
    const length = (axis === 0 ? u.bbox.width : u.bbox.height) / uPlot.pxRatio;
    const decade = length / Math.log10(max / min);
    const digits = decade > 3.5 * space ? "125" : "1";
    const every = Math.ceil(space / decade);
    return splits.map((value) => {
      const [digit, power] = value.toExponential().split("e");
      return digits.includes(digit) && Number(power) % every === 0 ? value : null;
    });
  }

  function readout(u, scale, value) {
    if (value == null) return "\u2013";
    const { min, max, distr } = u.scales[scale];
    if (distr === 3) return signed(Number(value.toPrecision(4)).toString());
    const step = 10 ** Math.floor(Math.log10((max - min) / 2000 || 1));
    return formatter(Math.max(Math.abs(min), Math.abs(max)), step)(value);
  }

  // Curves with abscissas of their own on one merged abscissa. `undefined` is "no sample of this curve here",
  // `null` is a gap; next to a gap there is nothing to connect to.
  function merge(groups) {
    if (groups.length === 1) return [groups[0].x, ...groups[0].y];
    const next = groups.map(() => 0);
    const x = [];
    const rows = groups.map(() => []);
    for (;;) {
      let least = Infinity;
      groups.forEach((group, g) => { if (next[g] < group.x.length) least = Math.min(least, group.x[next[g]]); });
      if (least === Infinity) break;
      x.push(least);
      groups.forEach((group, g) => rows[g].push(group.x[next[g]] === least ? next[g]++ : undefined));
    }
    const columns = groups.flatMap((group, g) => group.y.map((y) => rows[g].map((row) => (row === undefined ? undefined : y[row]))));
    for (const column of columns) {
      for (let i = 1; i < column.length; i++) if (column[i] === undefined && column[i - 1] === null) column[i] = null;
      for (let i = column.length - 1; i > 0; i--) if (column[i - 1] === undefined && column[i] === null) column[i - 1] = null;
    }
    return [x, ...columns];
  }

  function curve(data, entry) {
    const column = { label: entry.name, scale: "y", pxAlign: 0, width: 1.5, points: { size: 5, width: 1 } };
    if (entry.style === "band") {
      return Object.assign(column, { width: 1, stroke: () => colours.edge, points: { show: false } });
    }
    column.stroke = () => colours.curves[entry.colour];
    column.points.stroke = column.stroke;
    column.points.fill = column.stroke;
    if (entry.style === "dashed") column.dash = [7, 5];
    if (entry.style === "steps") column.paths = uPlot.paths.stepped({ align: 1 });
    if (entry.style === "points") {
      column.paths = () => null;
      column.points = Object.assign(column.points, { show: true, size: 4 });
    }
    return column;
  }

  function drawReferences(u, references) {
    const { ctx, bbox } = u;
    const ratio = uPlot.pxRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.strokeStyle = ctx.fillStyle = colours.reference;
    ctx.lineWidth = ratio;
    ctx.font = colours.font.replace("12px", `${11 * ratio}px`);
    ctx.textAlign = "right";
    for (const { name, value } of references) {
      const y = u.valToPos(value, "y", true);
      if (!Number.isFinite(y)) continue;
      ctx.setLineDash([5 * ratio, 4 * ratio]);
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      const above = y - bbox.top > 16 * ratio;
      ctx.textBaseline = above ? "bottom" : "top";
      // A halo keeps the name legible on top of curves.
      const place = [bbox.left + bbox.width - 4 * ratio, y + (above ? -2 : 2) * ratio];
      ctx.setLineDash([]);
      ctx.save();
      Object.assign(ctx, { strokeStyle: colours.paper, lineWidth: 4 * ratio, lineJoin: "round" });
      ctx.strokeText(name, ...place);
      ctx.restore();
      ctx.fillText(name, ...place);
    }
    ctx.restore();
  }

  function abscissaRange(data) {
    return (u, low, high) => {
      if (low < high) return [low, high];
      return data.log_x ? [low / 2, low * 2] : [low - 0.5, low + 0.5];
    };
  }

  // The ordinate's range: the curves in view, and at full width the reference lines too.
  function ordinateRange(data, plot) {
    return (u, low, high) => {
      if (!plot.zoomed) {
        for (const { value } of data.references) {
          if (data.log_y && value <= 0) continue;
          low = low == null ? value : Math.min(low, value);
          high = high == null ? value : Math.max(high, value);
        }
      }
      if (low == null || high == null) return data.log_y ? [1, 10] : [0, 1];
      return data.log_y ? uPlot.rangeLog(low, high, 10, false) : uPlot.rangeNum(low, high, 0.08, true);
    };
  }

  const marks = (log) => (log ? { splits: logSplits, filter: logNames, values: logTicks } : { values: linearTicks });

  function axisWidth(u, values, axis, cycle) {
    const known = u.axes[axis];
    if (cycle > 1) return known._size;
    const longest = (values ?? []).reduce((a, b) => (b.length > a.length ? b : a), "");
    u.ctx.save();
    u.ctx.font = known.font[0];
    const width = u.ctx.measureText(longest).width / uPlot.pxRatio;
    u.ctx.restore();
    // Mostly the least width, so that the abscissae of plots below each other line up.
    return Math.ceil(Math.max(u.width < 480 ? 40 : 56, width + 14));
  }

  function zoom(plot, low, high) {
    for (const other of drawn) {
      if (other.link !== plot.link) continue;
      const x = other.u.data[0];
      other.zoomed = low !== null;
      other.reset.hidden = !other.zoomed;
      other.u.setScale("x", other.zoomed ? { min: low, max: high } : { min: x[0], max: x[x.length - 1] });
    }
  }

  function legend(data, plot) {
    const place = element("div", { class: "legend" });
    const label = /^(.*?)\s*\[(.*)\]$/.exec(data.x_label);
    plot.at = element("output", {});
    plot.atName = label ? [`${label[1]} `, ` ${label[2]}`] : [`${data.x_label} `, ""];
    const isBand = (entry) => Number(entry.style === "band");
    [...plot.entries].sort((a, b) => isBand(a) - isBand(b)).forEach((entry) => {
      const mark = element("i", { class: entry.style });
      if (entry.style !== "band") mark.style.setProperty("--c", `var(--c${entry.colour})`);
      const value = element("output", {});
      const button = element("button", { type: "button", "aria-pressed": "true", title: "Show or hide" }, mark, entry.name, value);
      entry.write = (text) => { value.textContent = text; };
      button.addEventListener("click", () => {
        entry.shown = !entry.shown;
        button.setAttribute("aria-pressed", String(entry.shown));
        entry.columns.forEach((column) => plot.u.setSeries(column, { show: entry.shown }));
      });
      place.append(button);
    });
    place.append(element("span", { class: "at" }, plot.at));
    return place;
  }

  function writeValues(plot) {
    const { u } = plot;
    const at = u.cursor.idx;
    const away = at == null || u.cursor.left < 0;
    plot.at.textContent = away ? "" : plot.atName.join(readout(u, "x", u.data[0][at]));
    for (const entry of plot.entries) {
      const values = entry.columns.map((column) => readout(u, "y", u.data[column][u.cursor.idxs[column] ?? at]));
      entry.write(away || !entry.shown ? "" : values.join(" \u2026 "));
    }
  }

  const height = (width) => (width < 480 ? 210 : width < 700 ? 240 : 280);

  function draw(figure, link) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const plot = { link, zoomed: false, entries: [], figure };
    const columns = data.groups.flatMap((group) => group.entries);
    const series = [{ label: data.x_label }];
    const bands = [];
    for (const entry of columns) {
      const first = series.length;
      series.push(curve(data, entry));
      entry.shown = true;
      entry.columns = [first];
      if (entry.style === "band") {
        series.push(curve(data, entry));
        entry.columns = [first, first + 1];
        bands.push({ series: [first + 1, first], fill: () => colours.band });
      }
      plot.entries.push(entry);
    }
    const isBand = series.map((_, i) => plot.entries.some((entry) => entry.style === "band" && entry.columns.includes(i)));

    plot.reset = element("button", { type: "button", class: "reset", hidden: "" }, "Reset zoom");
    plot.reset.addEventListener("click", () => zoom(plot, null, null));
    figure.querySelector(".head").append(plot.reset);
    const place = element("div", { class: "canvas", role: "img", "aria-label": figure.dataset.label });
    figure.querySelector(".head").after(legend(data, plot), element("div", { class: "unit" }, data.y_label), place);

    const axis = (own) => ({
      stroke: () => colours.muted, font: colours.font, labelFont: colours.font,
      grid: { stroke: () => colours.grid, width: 1 }, ticks: { stroke: () => colours.rule, width: 1, size: 5 }, ...own,
    });
    const width = Math.max(200, place.clientWidth);
    const dot = (u, i) => {
      if (isBand[i]) return undefined;
      const made = element("div", {});
      Object.assign(made.style, { width: "7px", height: "7px", marginLeft: "-3.5px", marginTop: "-3.5px" });
      return made;
    };
    plot.u = new uPlot({
      width, height: height(width), series, bands, pxAlign: 1,
      legend: { show: false },
      padding: [10, 20, 0, 0],
      scales: {
        x: { time: false, distr: data.log_x ? 3 : 1, range: abscissaRange(data) },
        y: { distr: data.log_y ? 3 : 1, range: ordinateRange(data, plot) },
      },
      axes: [
        axis({ label: data.x_label, labelSize: 18, labelGap: 2, size: 28, gap: 4, space: 64, ...marks(data.log_x) }),
        axis({ size: axisWidth, gap: 4, space: 34, ...marks(data.log_y) }),
      ],
      cursor: {
        y: false,
        points: { show: dot },
        drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => zoom(plot, null, null) },
        sync: { key: link, setSeries: false, scales: ["x", null], filters: { pub: (type) => type === "mousemove" || type === "mouseleave" } },
      },
      hooks: {
        draw: [(u) => drawReferences(u, data.references)],
        setCursor: [() => { if (plot.u) writeValues(plot); }],
        setSelect: [(u) => {
          const { left, width: chosen } = u.select;
          if (chosen > 2) zoom(plot, u.posToVal(left, "x"), u.posToVal(left + chosen, "x"));
          u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        }],
      },
    }, merge(data.groups), place);
    plot.place = place;
    drawn.push(plot);
  }

  function fit(width) {
    for (const { u, place } of drawn) {
      const wide = Math.max(200, width ?? place.clientWidth);
      if (wide !== u.width) u.setSize({ width: wide, height: height(wide) });
    }
  }

  function recolour() {
    readColours();
    for (const { u } of drawn) u.redraw(false, false);
  }

  function start() {
    readColours();
    for (const section of document.querySelectorAll("section")) {
      for (const figure of section.querySelectorAll("figure.plot")) {
        // Only plots of one abscissa share a cursor.
        if (figure.querySelector("script")) draw(figure, `${section.id} ${figure.dataset.abscissa}`);
      }
    }
    root.classList.add("drawn");
    fit();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour);
    new ResizeObserver(() => { if (!root.classList.contains("on-paper")) fit(); }).observe(document.body);
    addEventListener("beforeprint", () => { root.classList.add("on-paper"); recolour(); fit(PRINTED_WIDTH); });
    addEventListener("afterprint", () => { root.classList.remove("on-paper"); recolour(); fit(); });
  }

  start();
})();
