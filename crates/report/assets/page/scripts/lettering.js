"use strict";
// Labels with symbols on a canvas: `$` begins and ends italics; `_x`, `^x`, `_{xy}`, `^{xy}` stand below and above the line.

squama.lettering = (() => {
  const FONT = 'system-ui, "Liberation Sans", Arial, sans-serif';

  /** Runs of characters of one style. */
  const runs = (source) => {
    const found = [];
    let italic = false, level = 0, braced = false;
    const put = (text) => {
      const last = found.at(-1), style = italic && level === 0;
      if (last && last.italic === style && last.level === level) last.text += text;
      else found.push({ text, italic: style, level });
    };
    for (const c of source) {
      if (c === "$") italic = !italic;
      else if (!braced && (c === "_" || c === "^")) level = c === "_" ? -1 : 1;
      else if (level !== 0 && c === "{") braced = true;
      else if (braced && c === "}") [braced, level] = [false, 0];
      else {
        put(c);
        if (!braced) level = 0;
      }
    }
    return found;
  };

  const font = ({ italic, level }, size, bold) => `${italic ? "italic " : ""}${bold ? "bold " : ""}${level === 0 ? size : 0.75 * size}px ${FONT}`;

  const measured = (context, source, size, bold) => runs(source).map((run) => {
    context.font = font(run, size, bold);
    return { ...run, width: context.measureText(run.text).width };
  });

  /** Width of a label, px. */
  const width = (context, source, size, bold) => measured(context, source, size, bold).reduce((sum, run) => sum + run.width, 0);

  /**
   * Writes a label at a spot: `align` 0 begins there, 0.5 is centred, 1 ends there; `turn` in degrees;
   * `halo` sets it off from what is below.
   */
  const write = (context, source, [x, y], { size = 12, align = 0, turn = 0, bold = false, color, halo = null }) => {
    const parts = measured(context, source, size, bold);
    context.save();
    context.translate(x, y);
    context.rotate((turn * Math.PI) / 180);
    [context.fillStyle, context.strokeStyle, context.lineWidth, context.lineJoin] = [color, halo, 5, "round"];
    context.textBaseline = "alphabetic";
    let left = -align * parts.reduce((sum, run) => sum + run.width, 0);
    for (const run of parts) {
      context.font = font(run, size, bold);
      const level = { "-1": 0.25, 0: 0, 1: -0.38 }[run.level] * size;
      if (halo) context.strokeText(run.text, left, level);
      context.fillText(run.text, left, level);
      left += run.width;
    }
    context.restore();
  };

  return { width, write };
})();
