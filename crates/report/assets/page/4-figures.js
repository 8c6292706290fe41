"use strict";
// The figures of the sweep.

(() => {
  const html = {
    coverage: "coverage <i>λ</i>",
    force: "critical force <i>F</i><sub>c</sub>*",
    penetration: "penetration <i>u</i><sub>max</sub>/<i>t</i>",
    resistance: "resistance <i>t</i>/<i>u</i><sub>max</sub>",
    compliance: "compliance <i>C</i><sub>f</sub>*",
    gap: "gap <i>d</i>/<i>t</i>",
    length: "aspect ratio <i>L</i>/<i>t</i>",
  };
  const dimensionless = (name) => `${name}, dimensionless`;
  const axisName = (k, letter) => `${letter}axis${k === 0 ? "" : k + 1}`;
  const axisRef = (k, letter) => `${letter}${k === 0 ? "" : k + 1}`;
  const hover = (rows, name, values) => rows.map((row, i) => `${squama.title(row)}<br>${name} ${squama.short(values[i])}`);

  /**
   * Panels in a grid, of a height and with gaps in px, as many in a row as there is room for.
   * `domain(k)` is the part of the chart that a panel takes.
   */
  const grid = (count, width, { least, height, gaps, margin }) => {
    const columns = Math.max(1, Math.min(count, Math.floor(width / least)));
    const rows = Math.ceil(count / columns);
    const across = Math.max(1, width - margin.l - margin.r);
    const down = rows * height + (rows - 1) * gaps[1];
    const wide = (across - (columns - 1) * gaps[0]) / columns;
    const domain = (k) => {
      const left = (k % columns) * (wide + gaps[0]), top = Math.floor(k / columns) * (height + gaps[1]);
      const part = (from, to, whole) => [Math.max(0, from / whole), Math.min(1, to / whole)];
      return { x: part(left, left + wide, across), y: part(down - top - height, down - top, down) };
    };
    return { columns, rows, domain, layout: { height: down + margin.t + margin.b, margin } };
  };

  /** The names of the axes that panels share: below and to the left of all. */
  const sharedNames = (x, y) => {
    const name = { showarrow: false, xref: "paper", yref: "paper", font: { size: 13 } };
    return [
      { ...name, text: x, x: 0.5, y: 0, xanchor: "center", yanchor: "top", yshift: -26 },
      { ...name, text: y, x: 0, y: 0.5, xanchor: "center", yanchor: "middle", xshift: -52, textangle: -90 },
    ];
  };

  const caption = (text, domain) => ({ text, showarrow: false, xref: "paper", yref: "paper", x: (domain.x[0] + domain.x[1]) / 2, y: domain.y[1], xanchor: "center", yanchor: "bottom", font: { size: 12 } });

  /** One value against the longer of the two lengths, a panel for each value of the other. */
  const multiples = (id, column, name, title, description, filled) => {
    const rows = squama.rowsWith(column, "gap_over_t", "length_over_t", "slant_deg");
    if (rows.length === 0) return;
    const byLength = squama.values("length_over_t").length >= squama.values("gap_over_t").length;
    const [along, across] = byLength ? ["length_over_t", "gap_over_t"] : ["gap_over_t", "length_over_t"];
    const [alongName, acrossName] = byLength ? [html.length, "<i>d</i>/<i>t</i>"] : [html.gap, "<i>L</i>/<i>t</i>"];
    let panels = squama.values(across);
    if (panels.length > 15) panels = Array.from({ length: 15 }, (_, k) => panels[Math.floor((k * (panels.length - 1)) / 14)]);
    const shown = rows.filter((row) => panels.includes(squama.cell(row, across)));
    const panel = (row) => panels.indexOf(squama.cell(row, across));
    const [axisX, axisY] = [along, column].map((key) => squama.scales.columns[key]);
    const make = (width) => {
      const place = grid(panels.length, width, { least: 165, height: 165, gaps: [10, 30], margin: { l: 70, r: 12, t: 26, b: 54 } });
      const layout = { ...place.layout, annotations: sharedNames(dimensionless(alongName), dimensionless(name)) };
      const traces = [];
      panels.forEach((value, k) => {
        const domain = place.domain(k);
        const first = k % place.columns === 0;
        const last = k + place.columns >= panels.length;
        layout[axisName(k, "x")] = { domain: domain.x, anchor: axisRef(k, "y"), ...axisX, showticklabels: last };
        layout[axisName(k, "y")] = { domain: domain.y, anchor: axisRef(k, "x"), ...axisY, showticklabels: first };
        layout.annotations.push(caption(`${acrossName} = ${value}`, domain));
        for (const slant of squama.slants) {
          const own = shown.filter((row) => panel(row) === k && squama.cell(row, "slant_deg") === slant.degrees)
            .sort((a, b) => squama.cell(a, along) - squama.cell(b, along));
          const x = own.map((row) => squama.cell(row, along));
          const y = own.map((row) => squama.cell(row, column));
          const once = new Set(x).size === x.length;
          traces.push({ x, y, customdata: own, mode: once ? "lines+markers" : "markers", line: { color: slant.color, width: 1.2 }, marker: squama.markers(own, 6, filled), text: hover(own, column.replace("_", " "), y), hoverinfo: "text", xaxis: axisRef(k, "x"), yaxis: axisRef(k, "y") });
        }
      });
      return { traces, layout };
    };
    const rings = (row) => {
      const k = row === null || !shown.includes(row) ? -1 : panel(row);
      return panels.map((_, i) => ({ ...squama.ring({ xaxis: axisRef(i, "x"), yaxis: axisRef(i, "y") }), x: i === k ? [squama.cell(row, along)] : [], y: i === k ? [squama.cell(row, column)] : [] }));
    };
    squama.addChart({ id, title, description, rows: shown, make, rings });
  };

  /** Panels of one value against another. `front` tells which rows stand out. */
  const scatter = (id, pairs, title, description, rows, front) => {
    if (rows.length === 0) return;
    const make = (width) => {
      const place = grid(pairs.length, width, { least: 290, height: pairs.length > 2 ? 240 : 290, gaps: [72, 64], margin: { l: 70, r: 12, t: 12, b: 54 } });
      const layout = { ...place.layout };
      const traces = [];
      pairs.forEach(([a, b], k) => {
        const domain = place.domain(k);
        const axis = (quantity) => ({ ...quantity.scale, title: { text: dimensionless(quantity.name), standoff: 6, font: { size: 13 } } });
        layout[axisName(k, "x")] = { ...axis(a), domain: domain.x, anchor: axisRef(k, "y") };
        layout[axisName(k, "y")] = { ...axis(b), domain: domain.y, anchor: axisRef(k, "x") };
        const part = (own, marker) => traces.push({ x: own.map(a.value), y: own.map(b.value), customdata: own, mode: "markers", marker, text: own.map(squama.title), hoverinfo: "text", xaxis: axisRef(k, "x"), yaxis: axisRef(k, "y") });
        if (front) part(rows.filter((row) => !front.has(row)), { size: 4, color: squama.themeColors().faint, opacity: 0.45 });
        const own = front ? rows.filter((row) => front.has(row)) : rows;
        part(own, squama.markers(own));
      });
      return { traces, layout };
    };
    const rings = (row) => pairs.map(([a, b], k) => {
      const has = rows.includes(row);
      return { ...squama.ring({ xaxis: axisRef(k, "x"), yaxis: axisRef(k, "y") }), x: has ? [a.value(row)] : [], y: has ? [b.value(row)] : [] };
    });
    squama.addChart({ id, title, description, rows, make, rings });
  };

  const coverageMaps = () => {
    const rows = squama.rowsWith("coverage", "gap_over_t", "length_over_t", "slant_deg");
    if (rows.length === 0) return;
    const slants = squama.slants.map((slant) => slant.degrees);
    const [lengths, gaps] = [squama.values("length_over_t"), squama.values("gap_over_t")];
    const across = (row) => lengths.indexOf(squama.cell(row, "length_over_t"));
    const up = (row) => gaps.indexOf(squama.cell(row, "gap_over_t"));
    // Every cell has a place of its own; labels as many as there is room for.
    const places = (values, room) => {
      const every = Math.ceil(values.length / room);
      const shown = values.map((_, i) => i).filter((i) => i % every === 0);
      return { tickmode: "array", tickvals: shown, ticktext: shown.map((i) => String(values[i])), range: [-0.6, values.length - 0.4], showgrid: false, zeroline: false, ticks: "", minor: { ticks: "" } };
    };
    const make = (width) => {
      const place = grid(slants.length, width, { least: 240, height: 190, gaps: [14, 34], margin: { l: 70, r: 84, t: 26, b: 54 } });
      const layout = { ...place.layout, annotations: sharedNames(dimensionless(html.length), dimensionless(html.gap)) };
      const size = Math.max(5, 0.82 * Math.min((width - 150) / place.columns / lengths.length, 180 / gaps.length));
      const traces = slants.map((slant, k) => {
        const domain = place.domain(k);
        const own = rows.filter((row) => squama.cell(row, "slant_deg") === slant);
        const last = k + place.columns >= slants.length;
        layout[axisName(k, "x")] = { domain: domain.x, anchor: axisRef(k, "y"), ...places(lengths, 7), showticklabels: last };
        layout[axisName(k, "y")] = { domain: domain.y, anchor: axisRef(k, "x"), ...places(gaps, 10), showticklabels: k % place.columns === 0 };
        layout.annotations.push(caption(`<i>α</i> = ${slant}°`, domain));
        const values = own.map((row) => squama.cell(row, "coverage"));
        return {
          x: own.map(across), y: own.map(up), customdata: own,
          mode: "markers", text: hover(own, "coverage", values), hoverinfo: "text", xaxis: axisRef(k, "x"), yaxis: axisRef(k, "y"),
          marker: { symbol: "square", size, color: values, opacity: values.map((value) => (value > 0 ? 1 : 0.12)), cmin: 0, cmax: 1, colorscale: "Cividis", line: { width: 0.5, color: squama.themeColors().faint }, showscale: k === 0, colorbar: { title: { text: "<i>λ</i>" }, thickness: 14, x: 1.01 } },
        };
      });
      return { traces, layout };
    };
    const rings = (row) => slants.map((slant, k) => {
      const here = row !== null && squama.cell(row, "slant_deg") === slant;
      return { ...squama.ring({ xaxis: axisRef(k, "x"), yaxis: axisRef(k, "y") }), x: here ? [across(row)] : [], y: here ? [up(row)] : [] };
    });
    squama.addChart({ id: "coverage", title: "Coverage", description: "Coverage by gap, aspect ratio and slant; faint: none.", rows, make, rings });
  };

  multiples("critical-force", "critical_force", html.force, "Critical force", "Critical force against the aspect ratio, for each gap and slant.");
  const column = (name, label) => ({ name: label, scale: squama.scales.columns[name], value: (row) => squama.cell(row, name) });
  const force = column("critical_force", html.force);
  scatter("stiffness", [
    [force, column("max_stiffness", "largest stiffness <i>K</i><sub>max</sub>*")],
    [force, column("secant_stiffness", "secant stiffness <i>K</i><sub>sec</sub>*")],
  ], "Stiffness against critical force", "Puncture stiffness, the largest and that of the secant, against the critical force.", squama.rowsWith("critical_force", "max_stiffness", "secant_stiffness"));
  multiples("penetration", "penetration", html.penetration, "Penetration", "Penetration at the critical tilt against the aspect ratio, for each gap and slant.");
  multiples("compliance", "compliance", html.compliance, "Flexural compliance", "Flexural compliance against the aspect ratio, for each gap and slant; open marks: no contact in bending. Without contact the slant does not matter, so that its marks coincide.",
    (row) => squama.cell(row, "flexure_contact") !== "false" && squama.cell(row, "flexure_contact") !== "no" && squama.cell(row, "flexure_contact") !== 0);
  coverageMaps();
  const quantities = [html.coverage, html.force, html.resistance, html.compliance]
    .map((name, k) => ({ name, scale: squama.scales.criteria[k], value: (row) => squama.criteriaOf(row)[k] }));
  const pairs = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]].map(([i, j]) => [quantities[i], quantities[j]]);
  scatter("pareto", pairs, "Pareto front", `${squama.front.size} designs that no other beats in all four criteria, in colour; grey: the others.`, squama.ranked, squama.front);
})();
