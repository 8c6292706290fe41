// Functions that create and find elements of the page.

/** Sets attributes; functions named `on…` become listeners; null and false are skipped. */
squama.attributes = (element, attributes) => {
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== null && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  return element;
};

/** Creates an element with attributes and children. */
squama.element = (name, attributes = {}, ...children) => {
  const element = squama.attributes(document.createElement(name), attributes);
  element.append(...children);
  return element;
};

/** Creates an SVG element. */
squama.svg = (name, attributes = {}, ...children) => {
  const element = squama.attributes(document.createElementNS("http://www.w3.org/2000/svg", name), attributes);
  element.append(...children);
  return element;
};

/** Returns the element with an id. */
squama.at = (id) => document.getElementById(id);

/** Returns the decompressed content of an element with seven bits of data per character. */
squama.unpacked = (id, format = "deflate-raw") => {
  const text = squama.at(id).textContent, packed = new Uint8Array(Math.floor((text.length * 7) / 8));
  for (let held = 0, count = 0, at = 0, k = 0; at < packed.length; k++) {
    [held, count] = [((held << 7) | (text.charCodeAt(k) & 127)) & 0x7fff, count + 7];
    if (count >= 8) packed[at++] = held >> (count -= 8);
  }
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream(format)));
};

/** Creates a dropdown with options `[value, text]`. */
squama.dropdown = (attributes, options, chosen) => squama.element("select", attributes,
  ...options.map(([value, text]) => squama.element("option", { value, selected: value === chosen }, text)));

/** Returns the attributes of an element that reacts to clicks and keys. */
squama.pressed = (act) => ({
  tabindex: 0,
  onclick: act,
  onkeydown: (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    act();
  },
});

/** Returns the attributes of an element that selects a design. */
squama.chooser = (row) => squama.pressed(() => squama.choose(row));

/** Returns the warning sign of a design with a fold; empty for other designs. */
squama.warning = (row) => (squama.folded(row)
  ? [squama.element("span", { class: "warning", title: "The surface of the substrate folds: the critical force is not valid.", role: "img", "aria-label": "folded" }, "⚠")]
  : []);

/** Creates a command with a copy button. */
squama.command = (text) => {
  const button = squama.element("button", { type: "button", "aria-label": `Copy: ${text}` }, "Copy");
  button.addEventListener("click", async () => {
    try { await navigator.clipboard.writeText(text); button.textContent = "Copied"; }
    catch { getSelection().selectAllChildren(button.previousElementSibling); }
  });
  return squama.element("div", { class: "copy" }, squama.element("code", {}, text), button);
};
