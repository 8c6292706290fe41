"use strict";
// The chosen design: parameters, values, drawing, commands.

(() => {
  const svgElement = (name, attributes, ...children) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  };

  /** The row at rest, to scale, with the line that measures its coverage. */
  const drawing = (row) => {
    const base = squama.cell(row, "base") ?? squama.shared.find(({ key }) => key === "base")?.value ?? "L";
    const length = squama.cell(row, "length_over_t"), gap = squama.cell(row, "gap_over_t");
    const a = base === "2L" ? length : length / 2;
    const shift = Math.tan((squama.cell(row, "slant_deg") * Math.PI) / 180);
    const pitch = 2 * a + gap;
    const span = Math.max(4.5, shift + 2.5 * pitch);
    const scale = 340 / span;
    const count = Math.min(200, Math.ceil(span / pitch) + 1);
    const left = Math.ceil(shift / pitch) + 1;
    const height = scale * 1.35 + 26;
    const at = (x, y) => `${(scale * (x + 0.15)).toFixed(2)},${(scale * (1.25 - y)).toFixed(2)}`;
    const svg = svgElement("svg", { viewBox: `0 0 350 ${height.toFixed(1)}`, role: "img", "aria-label": `row of scales of design ${squama.title(row)}, at rest` });
    svg.append(svgElement("rect", { x: 0, y: (scale * 1.25).toFixed(2), width: 350, height: (height - scale * 1.25).toFixed(2), fill: "var(--soil)" }));
    for (let i = -left; i < count; i++) {
      const x = a + i * pitch;
      svg.append(svgElement("polygon", {
        points: [at(x - a, 0), at(x + a, 0), at(x + a + shift, 1), at(x - a + shift, 1)].join(" "),
        fill: i === 0 ? "var(--punctured)" : "var(--scale)", stroke: "var(--edge)", "stroke-width": 1,
      }));
    }
    if (shift > 1e-9) {
      const x = 2 * a + shift;
      const line = (low, high, width, dash) => svgElement("line", {
        x1: (scale * (x + 0.15)).toFixed(2), x2: (scale * (x + 0.15)).toFixed(2), y1: (scale * (1.25 - low)).toFixed(2), y2: (scale * (1.25 - high)).toFixed(2),
        stroke: "var(--cover)", "stroke-width": width, "stroke-dasharray": dash,
      });
      svg.append(line(0, 1, 1.3, "4 3"));
      for (let k = 1; k <= shift / pitch + 1; k++) {
        const low = Math.max(0, (shift - k * pitch) / shift), high = Math.min(1, (shift - k * pitch + 2 * a) / shift);
        if (high - low > 1e-9) svg.append(line(low, high, 4, "none"));
      }
    }
    return svg;
  };

  const fact = (name, value, unit = "-", meaning = "") => [
    squama.element("dt", { title: meaning }, squama.label(name)),
    squama.element("dd", {}, ...squama.withUnit(name, value, unit)),
  ];

  const command = (text) => {
    const button = squama.element("button", { type: "button", "aria-label": `Copy: ${text}` }, "Copy");
    button.addEventListener("click", async () => {
      try { await navigator.clipboard.writeText(text); button.textContent = "Copied"; }
      catch { getSelection().selectAllChildren(button.previousElementSibling); }
    });
    return squama.element("div", { class: "copy" }, squama.element("code", {}, text), button);
  };

  /** Shows a drawing as large as the window; Escape or a click closes it. */
  const enlarge = (svg) => {
    const large = document.getElementById("large");
    large.querySelector("div").innerHTML = svg;
    large.showModal();
  };
  document.getElementById("large").addEventListener("click", (event) => event.currentTarget.close());

  // In a narrow window the design stands at the lower edge, folded up until one is chosen.
  const aside = document.getElementById("detail"), fold = document.getElementById("fold");
  squama.setFolded = (folded) => {
    aside.classList.toggle("folded", folded);
    fold.setAttribute("aria-expanded", String(!folded));
    fold.textContent = folded ? "Show" : "Hide";
  };
  fold.addEventListener("click", () => squama.setFolded(!aside.classList.contains("folded")));

  const show = (row) => {
    squama.setFolded(false);
    const number = squama.number(row);
    document.getElementById("detail-title").textContent = `Design ${number}`;
    const box = document.getElementById("drawing");
    box.replaceChildren(drawing(row), squama.element("p", { class: "note" }, "At rest; the thick parts of the dashed line are covered."));
    const solved = squama.drawings.find((other) => other.design === number);
    if (solved) {
      const button = squama.element("button", { type: "button", class: "solved", "aria-label": `Enlarge the drawing of design ${number}`, onclick: () => enlarge(solved.svg) });
      button.innerHTML = solved.svg;
      box.append(button, squama.element("p", { class: "note" }, "At rest and at the critical tilt; a click enlarges it."));
    }
    const axes = squama.columns.filter(({ name }) => squama.axes.includes(name));
    document.getElementById("detail-parameters").replaceChildren(...axes.flatMap(({ name, unit, meaning }) => fact(name, squama.cell(row, name), unit, meaning)));
    const values = squama.columns.filter(({ name }) => name !== "design" && !squama.axes.includes(name));
    document.getElementById("detail-values").replaceChildren(...values.flatMap(({ name, unit, meaning }) => fact(name, squama.cell(row, name), unit, meaning)));
    document.getElementById("detail-range").hidden = !(squama.cell(row, "membrane_strain_max") > 0.2);
    const definition = `${squama.folder}/run.toml`;
    document.getElementById("detail-commands").replaceChildren(
      squama.element("h3", {}, "Run it again"),
      command(`squama design ${definition} --design ${number}`),
      squama.element("h3", {}, "Draw it"),
      command(`squama draw ${definition} --design ${number}`),
      command(`squama draw ${definition} --design ${number} --flexure`),
      command(`squama plot curves ${definition} --design ${number}`));
    document.getElementById("announce").textContent = `Design ${squama.title(row)}`;
  };
  squama.onChoose.push(show);
  const all = squama.rows.map((_, row) => row);
  document.getElementById("previous").addEventListener("click", () => squama.step(-1, all));
  document.getElementById("next").addEventListener("click", () => squama.step(1, all));
})();
